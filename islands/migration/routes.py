"""Which edges there are in which epoch: those that stay, and those that are drawn anew for each epoch."""

from __future__ import annotations

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final, final

from islands.migration.channel import Channel, Edge
from islands.streams import ARCHIPELAGO, Purpose, stream

REMEMBERED: Final = 256
"""Epochs whose drawn edges are remembered; more than hosts may be apart."""


@dataclass(frozen=True, slots=True)
class Redrawn:
    """A channel whose edges are drawn anew for each epoch: every member sends to ``degree`` others, each as likely.

    Attributes
    ----------
    channel
        Its settings.
    members
        The islands' numbers and names, ascending.
    degree
        Targets of each member, fewer than there are members.
    weight, adapter
        As of every :class:`~islands.migration.channel.Edge` of it.
    species
        Of each member: islands of one species need no adapter. Empty where all need it.
    since, until
        As of an :class:`~islands.migration.channel.Edge`. Where members change, there are several of one channel, one
        after the other.
    """

    channel: Channel
    members: tuple[tuple[int, str], ...]
    degree: int = 1
    weight: float = 1.0
    adapter: str = ""
    species: tuple[str, ...] = ()
    since: int = 0
    until: int | None = None

    def is_there(self, epoch: int) -> bool:
        """Tell whether it carries at the end of an epoch."""
        return self.since <= epoch and (self.until is None or epoch < self.until)

    def has(self, island: int) -> bool:
        """Tell whether an island is a member."""
        return any(island == number for number, _ in self.members)

    def edges(self, seed: int, epoch: int) -> tuple[Edge, ...]:
        """Give the edges on which packets travel at the end of an epoch, by source, then target."""
        rng = stream(seed, ARCHIPELAGO, Purpose.TOPOLOGY, epoch, self.channel.number)
        edges = []
        for place, (source, name) in enumerate(self.members):
            chosen = sorted(rng.choice(len(self.members) - 1, size=self.degree, replace=False).tolist())
            for other in chosen:
                there = other + (other >= place)
                target, target_name = self.members[there]
                kin = bool(self.species) and self.species[place] == self.species[there]
                adapter = "" if kin else self.adapter
                edges.append(Edge(self.channel, source, target, name, target_name, self.weight, adapter))
        return tuple(edges)


@final
class Routes:
    """The edges of a run as its islands and hosts look them up.

    Parameters
    ----------
    edges
        Those that are not drawn anew, in the order of channels, then sources, then targets: at least all that touch the
        islands asked for.
    redrawn
        Channels whose edges are drawn anew.
    seed
        The run's seed.
    """

    def __init__(self, edges: Iterable[Edge], redrawn: Sequence[Redrawn] = (), seed: int = 0) -> None:
        outgoing: dict[int, list[Edge]] = defaultdict(list)
        incoming: dict[int, list[Edge]] = defaultdict(list)
        for edge in edges:
            outgoing[edge.source].append(edge)
            incoming[edge.target].append(edge)
        self._outgoing: Final = {island: _Spans(found) for island, found in outgoing.items()}
        self._incoming: Final = {island: _Spans(sorted(found, key=_by_source)) for island, found in incoming.items()}
        self._redrawn: Final = tuple(redrawn)
        self._seed: Final = seed
        self._drawn: Final = lru_cache(maxsize=REMEMBERED)(self._draw)

    def outgoing(self, island: int, epoch: int) -> tuple[Edge, ...]:
        """Give the edges on which an island sends at the end of an epoch, by channel, then target."""
        fixed = self._outgoing.get(island, _NONE).at(epoch)
        if not self._redrawn:
            return fixed
        drawn = self._drawn(epoch)[0].get(island, ())
        return tuple(sorted((*fixed, *drawn), key=lambda edge: (edge.channel.number, edge.target)))

    def incoming(self, island: int, epoch: int) -> tuple[Edge, ...]:
        """Give the edges on which packets sent at the end of an epoch reach an island, by channel, then source."""
        fixed = self._incoming.get(island, _NONE).at(epoch)
        if not self._redrawn:
            return fixed
        drawn = self._drawn(epoch)[1].get(island, ())
        return tuple(sorted((*fixed, *drawn), key=_by_source))

    def channels_into(self, island: int) -> tuple[Channel, ...]:
        """Give the channels that bring an island something in some epoch, by number.

        What a channel brought is held after the edge that it came on is gone for an epoch.
        """
        found = [edge.channel for edge in self._incoming.get(island, _NONE).edges]
        found += [one.channel for one in self._redrawn if one.has(island)]
        return tuple(sorted(dict.fromkeys(found), key=lambda channel: channel.number))

    def live(self, island: int, epoch: int) -> frozenset[tuple[int, int]] | None:
        """Give channel and source of each edge that leads, or may be drawn to lead, to an island at an epoch's end.

        ``None`` where edges are there in every epoch, so that nothing that the island holds is ever let go.
        """
        spans = self._incoming.get(island, _NONE)
        if not spans.change and not any(one.since or one.until is not None for one in self._redrawn):
            return None
        ways = {(edge.channel.number, edge.source) for edge in spans.at(epoch)}
        for one in self._redrawn:
            if one.is_there(epoch) and one.has(island):
                ways |= {(one.channel.number, number) for number, _ in one.members if number != island}
        return frozenset(ways)

    def _draw(self, epoch: int) -> tuple[dict[int, list[Edge]], dict[int, list[Edge]]]:
        outgoing: dict[int, list[Edge]] = defaultdict(list)
        incoming: dict[int, list[Edge]] = defaultdict(list)
        for channel in self._redrawn:
            if not channel.is_there(epoch):
                continue
            for edge in channel.edges(self._seed, epoch):
                outgoing[edge.source].append(edge)
                incoming[edge.target].append(edge)
        return outgoing, incoming


@final
class _Spans:
    """Edges of one island, epoch by epoch: the same tuple for as long as none of them begins or ends."""

    __slots__ = ("_found", "_marks", "edges")

    def __init__(self, edges: Iterable[Edge]) -> None:
        self.edges: Final = tuple(edges)
        marks = [edge.since for edge in self.edges if edge.since]
        marks += [edge.until for edge in self.edges if edge.until is not None]
        self._marks: Final = tuple(sorted(dict.fromkeys(marks)))
        self._found: Final[dict[int, tuple[Edge, ...]]] = {}

    @property
    def change(self) -> bool:
        """Whether not all edges are there in every epoch."""
        return bool(self._marks)

    def at(self, epoch: int) -> tuple[Edge, ...]:
        """Give those that are there at the end of an epoch, in their order."""
        if not self._marks:
            return self.edges
        place = bisect_right(self._marks, epoch)
        if place not in self._found:
            self._found[place] = tuple(edge for edge in self.edges if edge.is_there(epoch))
        return self._found[place]


_NONE: Final = _Spans(())


def _by_source(edge: Edge) -> tuple[int, int]:
    return edge.channel.number, edge.source
