"""Which edges there are in which epoch: those that stay, and those that are drawn anew for each epoch."""

from __future__ import annotations

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
    """

    channel: Channel
    members: tuple[tuple[int, str], ...]
    degree: int = 1
    weight: float = 1.0
    adapter: str = ""
    species: tuple[str, ...] = ()

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
        Those that stay, in the order of channels, then sources, then targets: at least all that touch the islands
        asked for.
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
        self._outgoing: Final = {island: tuple(found) for island, found in outgoing.items()}
        self._incoming: Final = {
            island: tuple(sorted(found, key=lambda edge: (edge.channel.number, edge.source)))
            for island, found in incoming.items()
        }
        self._redrawn: Final = tuple(redrawn)
        self._seed: Final = seed
        self._drawn: Final = lru_cache(maxsize=REMEMBERED)(self._draw)

    def outgoing(self, island: int, epoch: int) -> tuple[Edge, ...]:
        """Give the edges on which an island sends at the end of an epoch, by channel, then target."""
        fixed = self._outgoing.get(island, ())
        if not self._redrawn:
            return fixed
        drawn = self._drawn(epoch)[0].get(island, ())
        return tuple(sorted((*fixed, *drawn), key=lambda edge: (edge.channel.number, edge.target)))

    def incoming(self, island: int, epoch: int) -> tuple[Edge, ...]:
        """Give the edges on which packets sent at the end of an epoch reach an island, by channel, then source."""
        fixed = self._incoming.get(island, ())
        if not self._redrawn:
            return fixed
        drawn = self._drawn(epoch)[1].get(island, ())
        return tuple(sorted((*fixed, *drawn), key=lambda edge: (edge.channel.number, edge.source)))

    def channels_into(self, island: int) -> tuple[Channel, ...]:
        """Give the channels that bring an island something in some epoch, by number.

        What a channel brought is held after the edge that it came on is gone.
        """
        found = [edge.channel for edge in self._incoming.get(island, ())]
        found += [one.channel for one in self._redrawn if any(island == number for number, _ in one.members)]
        return tuple(sorted(dict.fromkeys(found), key=lambda channel: channel.number))

    def _draw(self, epoch: int) -> tuple[dict[int, list[Edge]], dict[int, list[Edge]]]:
        outgoing: dict[int, list[Edge]] = defaultdict(list)
        incoming: dict[int, list[Edge]] = defaultdict(list)
        for channel in self._redrawn:
            for edge in channel.edges(self._seed, epoch):
                outgoing[edge.source].append(edge)
                incoming[edge.target].append(edge)
        return outgoing, incoming
