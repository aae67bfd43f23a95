"""What islands emit: one small tuple a fact. Only the log writer turns records into Parquet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from islands.individual import Origin, Scores


class Born(NamedTuple):
    """An individual, as first scored."""

    generation: int
    epoch: int
    id: int
    parents: tuple[int, ...]
    components: tuple[int, ...]
    partners: tuple[int, ...]
    origin: Origin
    genotype: str
    fitness: float | None
    scores: Scores
    error: str
    growth_ms: float
    evaluation_ms: float


class Rescored(NamedTuple):
    """A later scoring of an individual already bred."""

    generation: int
    epoch: int
    id: int
    reason: str
    fitness: float | None
    scores: Scores
    partners: tuple[int, ...]
    error: str
    evaluation_ms: float


class Generation(NamedTuple):
    """A deme at the end of one generation; the figures are over its valid members, ``None`` when there is none."""

    generation: int
    epoch: int
    evaluations: int
    best: float | None
    mean: float | None
    std: float | None
    worst: float | None
    diversity: float | None
    invalid: int
    wall_ms: float


class Crossing(NamedTuple):
    """A migrant at the gate of its target, let in or not; ``epoch`` is the one at whose start it would join."""

    epoch: int
    channel: str
    kind: str
    source: str
    target: str
    id: int
    fitness: float | None
    accepted: bool
    reason: str


class Note(NamedTuple):
    """Something that happened to an island and that the events table tells."""

    epoch: int
    kind: str
    detail: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Records:
    """All records of one island in one epoch, in the order in which things happened."""

    born: tuple[Born, ...] = ()
    rescored: tuple[Rescored, ...] = ()
    generations: tuple[Generation, ...] = ()
    crossings: tuple[Crossing, ...] = ()
    notes: tuple[Note, ...] = ()
