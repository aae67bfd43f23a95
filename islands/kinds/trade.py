"""What island kinds give to channels and take from them: what a channel between strangers is refused by."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from islands.kinds.protocol import Kind
from islands.migration.channel import ChannelKind
from islands.spec import IslandSpec

Needs = Sequence[ChannelKind]


def gives(kind: Kind, channel: ChannelKind) -> str:
    """Give the name of what a kind gives to channels of this kind, such as ``mesh``; empty for nothing.

    ``gives`` is an optional attribute of a kind, ``{"surroundings": "mesh"}``. Migrants need none: every kind gives
    its genotypes, and its species is the name of what travels.
    """
    given: Mapping[str, str] = getattr(kind, "gives", {})
    return given.get(channel, "")


def takes(kind: Kind, channel: ChannelKind) -> tuple[str, ...]:
    """Give the names of what a kind takes from channels of this kind; empty for nothing."""
    taken: Mapping[str, tuple[str, ...]] = getattr(kind, "takes", {})
    return tuple(taken.get(channel, ()))


def needs(kind: Kind, spec: IslandSpec) -> tuple[ChannelKind, ...]:
    """Give the kinds of channels that an island cannot do without.

    ``needs`` is an optional attribute of a kind, ``("partners",)``, or a method that gives them for an island.
    """
    found: Needs | Callable[[IslandSpec], Needs] = getattr(kind, "needs", ())
    return tuple(found(spec) if callable(found) else found)
