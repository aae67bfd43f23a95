"""Channels, their edges, and what travels on them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from islands.individual import Scores

ChannelKind = Literal["migrants", "partners", "components", "surroundings"]


@dataclass(frozen=True, slots=True)
class Channel:
    """The settings that all edges of one channel share.

    Attributes
    ----------
    number
        Place in the experiment's list of channels, from 0: the order in which packets join.
    name
        As the log names it.
    kind
        What it carries.
    every
        Migrants travel at the end of each epoch that this divides; epoch 0 sends none.
    count
        How many travel on an edge at a time.
    select
        Which members emigrate: ``best``, ``random``, ``tournament``.
    tournament
        Entrants of a tournament, where ``select`` holds them.
    replace
        Whose place an immigrant takes: ``worst``, ``random``.
    accept
        ``always``, or ``better``: only if it is better than the member whose place it would take.
    """

    number: int
    name: str
    kind: ChannelKind = "migrants"
    every: int = 1
    count: int = 1
    select: str = "best"
    tournament: int = 2
    replace: str = "worst"
    accept: str = "always"

    def carries(self, epoch: int) -> bool:
        """Tell whether migrants travel at the end of this epoch."""
        return epoch > 0 and epoch % self.every == 0


@dataclass(frozen=True, slots=True)
class Edge:
    """One directed connection of a channel, from the island ``source`` to the island ``target`` (numbers, names)."""

    channel: Channel
    source: int
    target: int
    source_name: str
    target_name: str


@dataclass(frozen=True, slots=True)
class Migrant:
    """An individual on its way: values only, so that no deme ever shares an object with another.

    Attributes
    ----------
    id
        Stays the same in the deme that it joins.
    genotype
        Its language-neutral encoding.
    fitness, scores, error
        As at its source.
    """

    id: int
    genotype: str
    fitness: float | None
    scores: Scores
    error: str


@dataclass(frozen=True, slots=True)
class Packet:
    """What one edge delivers at the end of one epoch; it may be empty.

    Attributes
    ----------
    channel
        The channel's number.
    source, target
        The islands' numbers.
    epoch
        The epoch at whose end it was sent.
    scoring
        How the source scores; a target that scores otherwise scores the migrants again.
    migrants
        Best first.
    """

    channel: int
    source: int
    target: int
    epoch: int
    scoring: str
    migrants: tuple[Migrant, ...] = ()
