"""Individuals: immutable, named by one number for the whole run, and the same wherever they live."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Generic, Literal, Protocol, TypeVar

Origin = Literal["seed", "random", "crossover", "mutation", "crossover+mutation", "adaptation", "intervention"]
G = TypeVar("G")

Scores = tuple[tuple[str, float], ...]
"""Criteria and their values, sorted by name."""

Outcomes = tuple[tuple[str, float | None], ...]
"""Of each pairing of an individual: a name of the partners in it, and the fitness, ``None`` where it was invalid."""

COUNTER_BITS: Final = 40
"""An id holds the island's number above this many bits, and the count of that island's individuals below."""


@dataclass(frozen=True, slots=True)
class Evaluation:
    """What scoring an individual gave.

    Attributes
    ----------
    fitness
        Maximised; ``None`` when the individual is invalid. Never NaN.
    scores
        All criteria measured, those without a goal too.
    error
        Empty when valid, otherwise ``reason: what happened``.
    growth_ms, evaluation_ms
        Wall time of growing and of measuring, in milliseconds; outside the promise of determinism.
    notes
        What the log should tell about this scoring: pairs of an event's kind and its detail, plain JSON values.
    """

    fitness: float | None
    scores: Scores = ()
    error: str = ""
    growth_ms: float = 0.0
    evaluation_ms: float = 0.0
    notes: tuple[tuple[str, dict[str, object]], ...] = ()


@dataclass(frozen=True, slots=True)
class Individual(Generic[G]):
    """A member of a deme.

    Attributes
    ----------
    id
        Unique in the run, kept by migrants.
    genotype
        An immutable value of the island kind.
    fitness
        Maximised, by the goals of the island where it lives; ``None`` when invalid.
    scores, error
        As in :class:`Evaluation`.
    since
        The island's generation in which it was born there or came there.
    outcomes
        What its fitness was made of; kept only where fitness is shared (:mod:`islands.sharing`).
    """

    id: int
    genotype: G
    fitness: float | None
    scores: Scores
    error: str
    since: int = 0
    outcomes: Outcomes = ()


class Rated(Protocol):
    """Whatever has an id and a fitness: an individual at home or on its way."""

    @property
    def id(self) -> int:
        """As of :class:`Individual`."""
        ...

    @property
    def fitness(self) -> float | None:
        """As of :class:`Individual`."""
        ...


def make_id(island: int, count: int) -> int:
    """Give the id of the ``count``-th individual (from 0) that the island with this number has bred."""
    return island << COUNTER_BITS | count


def home_of(individual: int) -> int:
    """Give the number of the island that bred the individual with this id."""
    return individual >> COUNTER_BITS


def merit(individual: Rated) -> tuple[float, int]:
    """Give a key that sorts the best first: valid before invalid, higher fitness first, then the lower id."""
    if individual.fitness is None:
        return (float("inf"), individual.id)
    return (-individual.fitness, individual.id)


def beats(one: Rated, other: Rated) -> bool:
    """Tell whether one is strictly better than another: valid against invalid, or of higher fitness."""
    if one.fitness is None:
        return False
    return other.fitness is None or one.fitness > other.fitness
