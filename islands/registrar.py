"""The registrar of one call of ``advance``: names and scores whoever is born, scores again, and keeps the records."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar, final

from islands.algorithms.breeding import Birth
from islands.context import Context
from islands.individual import Individual, make_id
from islands.pairings import Scored
from islands.records import Born, Crossing, Generation, Note, Records, Rescored
from islands.streams import EpochStreams

G = TypeVar("G")


@final
class Registrar(Generic[G]):
    """See the module's docstring.

    Parameters
    ----------
    island, epoch
        Where and when.
    generation
        The last one finished.
    counter
        How many the island has bred.
    context
        What it scores by.
    streams
        Of this epoch.
    pulse
        Called before each scoring; it may raise.
    sharing
        Whether members share fitness, so that they keep the outcomes of their pairings.

    Attributes
    ----------
    evaluations
        Individuals scored and not yet counted in a generation's row.
    """

    __slots__ = (
        "_island", "_pulse", "_sharing", "born", "context", "counter", "crossings", "epoch", "evaluations",
        "generation", "generations", "notes", "rescored", "streams",
    )  # fmt: skip

    def __init__(
        self,
        island: int,
        epoch: int,
        generation: int,
        counter: int,
        context: Context[G],
        streams: EpochStreams,
        pulse: Callable[[], None],
        *,
        sharing: bool = False,
    ) -> None:
        self._island = island
        self.streams = streams
        self._pulse = pulse
        self._sharing = sharing
        self.epoch = epoch
        self.generation = generation
        self.counter = counter
        self.context = context
        self.evaluations = 0
        self.born: list[Born] = []
        self.rescored: list[Rescored] = []
        self.generations: list[Generation] = []
        self.crossings: list[Crossing] = []
        self.notes: list[Note] = []

    def bear(self, birth: Birth[G]) -> Individual[G]:
        """Name, score and record one newborn."""
        genotype, parents, origin = birth
        identity = make_id(self._island, self.counter)
        found, partners, outcomes = self._score(genotype, identity)
        self.counter += 1
        text, parts = self.context.biology.encode(genotype), self.context.components(genotype)
        self.born.append(
            Born(
                self.generation, self.epoch, identity, parents, parts, partners, origin, text,
                found.fitness, found.scores, found.error, found.growth_ms, found.evaluation_ms,
            )
        )  # fmt: skip
        return Individual(identity, genotype, found.fitness, found.scores, found.error, self.generation, outcomes)

    def score_again(self, identity: int, genotype: G, reason: str, since: int) -> Individual[G]:
        """Score and record one already bred."""
        found, partners, outcomes = self._score(genotype, identity)
        self.rescored.append(
            Rescored(
                self.generation, self.epoch, identity, reason, found.fitness, found.scores, partners, found.error,
                found.growth_ms + found.evaluation_ms,
            )
        )  # fmt: skip
        return Individual(identity, genotype, found.fitness, found.scores, found.error, since, outcomes)

    def scores_as(self, scoring: str) -> bool:
        """Tell whether one that was scored so elsewhere need not be scored again.

        Where fitness is shared it must be: outcomes do not travel.
        """
        return scoring == self.context.scoring and not (self._sharing and self.context.company is not None)

    def note(self, kind: str, detail: dict[str, object]) -> None:
        """Keep something that the events table is to tell."""
        self.notes.append(Note(self.epoch, kind, detail))

    def records(self) -> Records:
        """Give all records."""
        return Records(
            tuple(self.born),
            tuple(self.rescored),
            tuple(self.generations),
            tuple(self.crossings),
            tuple(self.notes),
        )

    def _score(self, genotype: G, identity: int) -> Scored:
        found = self.context.score(genotype, self.streams, self._pulse)
        self.evaluations += 1
        for kind, detail in found.evaluation.notes:
            self.note(kind, {"id": identity, **detail})
        return found if self._sharing else found._replace(outcomes=())
