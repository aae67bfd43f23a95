"""What island kinds give to channels and take from them: what a channel between strangers is refused by.

Each is an optional attribute of a kind, or a method that gives it for an island (:class:`~islands.spec.IslandSpec`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Final, TypeVar, cast

from genome.errors import InputError
from islands.kinds.protocol import Kind
from islands.migration.channel import Channel, ChannelKind
from islands.spec import IslandSpec

T = TypeVar("T")

METHODS: Final[Mapping[ChannelKind, tuple[str, ...]]] = {
    "migrants": (),
    "partners": ("evaluate_with",),
    "components": ("supplied", "components"),
    "surroundings": ("surrounded",),
}
"""What a biology must have to make use of what channels bring; see :mod:`islands.kinds.protocol`."""


def gives(kind: Kind, channel: ChannelKind, spec: IslandSpec) -> str:
    """Give the name of what an island gives to channels of this kind, such as ``mesh``; empty for nothing.

    ``gives`` is a mapping, ``{"surroundings": "mesh"}``. Migrants need none: every kind gives its genotypes, and its
    species is the name of what travels. A name may tell of settings that have to fit: ``bits of 48``.
    """
    nothing: Mapping[str, str] = {}
    return _of_island(kind, "gives", spec, nothing).get(channel, "")


def takes(kind: Kind, channel: ChannelKind, spec: IslandSpec) -> tuple[str, ...]:
    """Give the names of what an island takes from channels of this kind; empty for nothing.

    ``takes`` is a mapping, ``{"surroundings": ("mesh", "solid")}``.
    """
    nothing: Mapping[str, str | Sequence[str]] = {}
    return _names(_of_island(kind, "takes", spec, nothing).get(channel, ()))


def needs(kind: Kind, spec: IslandSpec) -> tuple[ChannelKind, ...]:
    """Give the kinds of channels that an island cannot do without; ``needs`` is ``("partners",)``."""
    nothing: Sequence[ChannelKind] = ()
    return cast("tuple[ChannelKind, ...]", _names(_of_island(kind, "needs", spec, nothing)))


def needed(kind: Kind, channel: ChannelKind, spec: IslandSpec) -> tuple[str, ...]:
    """Give the names of what has to come to an island on channels of this kind, each of them; empty for none.

    ``needed`` is a mapping, ``{"partners": ("space on cubic",)}``: names of what others give.
    """
    nothing: Mapping[str, str | Sequence[str]] = {}
    return _names(_of_island(kind, "needed", spec, nothing).get(channel, ()))


def variation(kind: Kind) -> frozenset[str]:
    """Give the keys of a kind's genome section that may differ within a species.

    ``variation`` is an attribute of the kind alone: names of settings of crossover and mutation, which leave every
    genotype readable, and scored alike, on each island.
    """
    return frozenset(_names(getattr(kind, "variation", ())))


def _of_island(kind: Kind, name: str, spec: IslandSpec, default: T) -> T:
    found: T | Callable[[IslandSpec], T] = getattr(kind, name, default)
    return found(spec) if callable(found) else found


def _names(given: str | Iterable[str]) -> tuple[str, ...]:
    """Give names as a tuple; a text is one name."""
    return (given,) if isinstance(given, str) else tuple(given)


def check_biology(biology: object, spec: IslandSpec, channels: Iterable[Channel]) -> None:
    """Check that an island can make use of what channels bring it.

    Parameters
    ----------
    biology
        As the island's kind made it.
    spec
        The island.
    channels
        Those that reach it, or others of its group.

    Raises
    ------
    InputError
        When the biology lacks a method that a channel's kind calls.
    """
    for channel in channels:
        for method in METHODS[channel.kind]:
            if not callable(getattr(biology, method, None)):
                got = f"'{spec.kind}', which takes {channel.kind} and whose biology has no {method}"
                remedy = f"channel '{channel.name}' brings it {channel.kind}: add the method, or change the channel"
                raise InputError(spec.where("kind"), f"a kind with {method}", got, remedy)
