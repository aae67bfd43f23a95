"""What an island carries from one epoch to the next, and what an epoch makes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Generic, TypeVar

from islands.holdings import NOTHING, Holdings
from islands.individual import Individual
from islands.migration.channel import Packet
from islands.records import Records
from islands.steered import UNSTEERED, Steered
from islands.watch import Watch

G = TypeVar("G")
Deme = tuple[Individual[G], ...]


@dataclass(frozen=True, slots=True)
class State(Generic[G]):
    """All that an island carries from one epoch to the next.

    Attributes
    ----------
    deme
        Its members; fewer than its population once some moved away.
    epoch, generation
        The last ones finished; both 0 once the first population is scored.
    counter
        How many individuals it has bred.
    best
        The best fitness that any generation had; ``None`` while none had a valid member. Once the whole deme is scored
        again, the best by the new scores.
    stagnant
        Generations since it rose.
    held
        What channels other than of migrants brought.
    scoring
        Names the context in which the members are scored.
    steered
        What interventions have changed for good.
    watched
        What is remembered of the channels of partners that are watched.
    """

    deme: Deme[G]
    epoch: int
    generation: int
    counter: int
    best: float | None = None
    stagnant: int = 0
    held: Holdings = NOTHING
    scoring: str = ""
    steered: Steered = UNSTEERED
    watched: tuple[Watch, ...] = ()

    def with_deme(self, deme: Deme[G]) -> State[G]:
        """Give the same state with another deme."""
        return replace(self, deme=deme)


@dataclass(frozen=True, slots=True)
class Advance(Generic[G]):
    """What an epoch made: the next state, one packet for each outgoing edge, and the records."""

    state: State[G]
    departures: tuple[Packet, ...]
    records: Records
