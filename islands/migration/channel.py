"""Channels, their edges, and what travels on them.

One mechanism carries all four kinds: at an epoch's end each edge sends one packet, empty if need be, and the target
takes it in before the next epoch's first selection. What a packet holds and what the target does with it depend on the
channel's kind:

- ``migrants``: individuals join the target's deme;
- ``partners``: representatives, which the target's members are scored together with;
- ``components``: finished parts, which the target's genotypes are assembled from;
- ``surroundings``: forms, which become part of the target's environment.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

from islands.individual import Scores

ChannelKind = Literal["migrants", "partners", "components", "surroundings"]
Chooser = Literal["best", "tournament", "random", "roulette", "diverse", "spread"]
Replacer = Literal["worst", "random", "oldest", "similar", "tournament"]
PairingScheme = Literal["best", "random", "several", "archive", "mixed"]
PairingScore = Literal["mean", "best", "worst"]


@dataclass(frozen=True, slots=True)
class Trigger:
    """A condition on a source's deme, besides the interval; exactly one is set.

    Attributes
    ----------
    stagnation
        It sends once its best has not improved for at least so many generations.
    diversity
        It sends while its diversity is under this bound.
    """

    stagnation: int | None = None
    diversity: float | None = None


@dataclass(frozen=True, slots=True)
class Pairing:
    """How the target of a ``partners`` channel pairs its members with those shown to it.

    Attributes
    ----------
    scheme
        ``best``: with the best shown. ``several``: with the ``count`` best shown. ``random``: with ``count`` of those
        shown, drawn for each member. ``archive``: with the best shown and ``count`` - 1 of the archive, drawn for each
        epoch. ``mixed``: with the best shown, some of the others shown and some of the archive, drawn for each epoch:
        half of the ``count`` - 1 from each, the odd one from those shown.
    count
        Pairings of one member.
    score
        What a member's pairings make together: their ``mean``, the ``best``, or the ``worst`` of them.
    archive
        How many past representatives are kept besides the best one shown now: the best one of each epoch before; the
        oldest go first.
    measures
        Whether the log tells at each epoch's end how the target's best fares against the archive
        (:mod:`islands.watch`).
    """

    scheme: PairingScheme = "best"
    count: int = 1
    score: PairingScore = "mean"
    archive: int = 0
    measures: bool = False


@dataclass(frozen=True, slots=True)
class Channel:
    """The settings that all edges of one channel share.

    Attributes
    ----------
    number
        Place in the experiment's list of channels, from 0: the order in which packets are taken in.
    name
        As the log names it.
    kind
        What it carries.
    every
        It carries at the end of each epoch that this divides; migrants do not travel at the end of epoch 0.
    count, rate
        How many travel on an edge at a time: a number, or with ``rate`` a share of the source's deme. Fewer do where a
        deme has no more members, as when some moved away on a channel before this one.
    select
        Which members emigrate.
    tournament
        Entrants of a tournament, where ``select`` or ``replace`` holds them.
    replace
        Whose place an immigrant takes.
    accept
        ``always``, or ``better``: only if it is better than the member whose place it would take.
    move
        Emigrants leave their deme instead of sending a copy. They are gone before later channels choose, and one that
        its target turns away is in no deme any more.
    routing
        ``broadcast``: each edge carries. ``point``: one edge of each source and epoch, drawn at random, carries.
    trigger
        A condition on the source's deme.
    pairing
        Of ``partners`` alone.
    keep
        Of ``components`` alone: how many parts of each source a target keeps, the newest first.
    since, until
        It carries at the ends of epochs from ``since`` on, and before ``until``; always without one.
    """

    number: int
    name: str
    kind: ChannelKind = "migrants"
    every: int = 1
    count: int = 1
    rate: float | None = None
    select: Chooser = "best"
    tournament: int = 2
    replace: Replacer = "worst"
    accept: Literal["always", "better"] = "always"
    move: bool = False
    routing: Literal["broadcast", "point"] = "broadcast"
    trigger: Trigger | None = None
    pairing: Pairing | None = None
    keep: int = 1
    since: int = 0
    until: int | None = None

    def carries(self, epoch: int) -> bool:
        """Tell whether it carries at the end of this epoch, its trigger aside."""
        if epoch < self.since or (self.until is not None and epoch >= self.until):
            return False
        return epoch % self.every == 0 and (epoch > 0 or self.kind != "migrants")

    def size(self, population: int) -> int:
        """Give how many travel on an edge from a deme of so many members.

        A rate's share is rounded to the nearest number, half a member up, and is at least one: 0.5 of 5 are 3.
        """
        if self.rate is None:
            return self.count
        # As a decimal: 0.145 of 100 are 14.5, though a few bits less as a float.
        return max(1, math.floor(round(self.rate * population, 9) + 0.5))


@dataclass(frozen=True, slots=True)
class Edge:
    """One directed connection of a channel, from the island ``source`` to the island ``target`` (numbers, names).

    Attributes
    ----------
    weight
        The probability that it carries when its channel does.
    adapter
        Name or import path of what translates genotypes on the way; empty for none.
    since, until
        It carries at the ends of epochs from ``since`` on, and before ``until``; always without one.
    """

    channel: Channel
    source: int
    target: int
    source_name: str
    target_name: str
    weight: float = 1.0
    adapter: str = ""
    since: int = 0
    until: int | None = None

    def is_there(self, epoch: int) -> bool:
        """Tell whether it is there at the end of an epoch."""
        return self.since <= epoch and (self.until is None or epoch < self.until)


class Migrant(NamedTuple):
    """An individual on its way: values only, so that no deme ever shares an object with another.

    Attributes
    ----------
    id
        Stays the same wherever it goes.
    text
        What travels: the language-neutral encoding of its genotype, or on a channel of another kind than ``migrants``
        what its kind offers there.
    fitness, scores, error
        As at its source.
    """

    id: int
    text: str
    fitness: float | None
    scores: Scores
    error: str


class Packet(NamedTuple):
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
