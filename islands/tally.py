"""How islands stand at an epoch's end: the little of them that the driver sees."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, final

from genome.mishaps import one_line
from islands.figures import figures
from islands.individual import Individual
from islands.spec import IslandSpec
from islands.state import Advance, State

MOST_REASON: Final = 160
"""Characters of the reason that a summary gives."""

Champion = tuple[float, int]
"""Fitness and id of the best individual that an island ever bred, member still or not; of equal ones the older."""


@dataclass(frozen=True, slots=True)
class IslandSummary:
    """How an island stands at an epoch's end: what the driver may see of it.

    Attributes
    ----------
    island, epoch, generation
        Which island, and when.
    evaluations, migrants
        Scorings, and migrants that were let in: in the epochs since the last summary.
    best, mean, invalid
        Figures of its members.
    champion
        See :data:`Champion`; ``None`` while it bred none that is valid.
    trouble
        The commonest reason why its members are invalid, when all are; otherwise empty.
    """

    island: str
    epoch: int
    generation: int
    evaluations: int
    best: float | None
    mean: float | None
    invalid: int
    migrants: int
    champion: Champion | None
    trouble: str = ""


@final
class Tally:
    """The summaries of some islands' epochs, for as long as somebody may ask for them.

    Parameters
    ----------
    islands
        The islands, in order.
    """

    def __init__(self, islands: Iterable[IslandSpec]) -> None:
        self._names = {spec.number: spec.name for spec in islands}
        self._champions: dict[int, Champion] = {}
        self._epochs: dict[int, dict[int, IslandSummary]] = {}

    def add(self, island: int, step: Advance[Any]) -> None:
        """Sum up an epoch of one island; an island's epochs come in order."""
        rows = step.records.generations
        last = rows[-1] if rows else figures(step.state.deme, step.state.generation, step.state.epoch, 0, None, 0.0)
        contenders = [(row.fitness, row.id) for row in step.records.born if row.fitness is not None]
        if island in self._champions:
            contenders.append(self._champions[island])
        if contenders:
            self._champions[island] = min(contenders, key=lambda one: (-one[0], one[1]))
        self._epochs.setdefault(step.state.epoch, {})[island] = IslandSummary(
            island=self._names[island],
            epoch=step.state.epoch,
            generation=step.state.generation,
            evaluations=sum(row.evaluations for row in rows),
            best=last.best,
            mean=last.mean,
            invalid=last.invalid,
            migrants=sum(row.accepted and row.kind == "migrants" for row in step.records.crossings),
            champion=self._champions.get(island),
            trouble=_trouble(step.state) if last.best is None else "",
        )

    def since(self, before: int, through: int) -> tuple[IslandSummary, ...]:
        """Give how the islands stood at the end of epoch ``through``, counting from after epoch ``before``."""
        if through not in self._epochs:
            return ()
        spans = [self._epochs[epoch] for epoch in range(before + 1, through + 1)]
        found = []
        for island, row in ((island, self._epochs[through][island]) for island in self._names):
            if len(spans) == 1:
                found.append(row)
                continue
            evaluations = sum(span[island].evaluations for span in spans)
            migrants = sum(span[island].migrants for span in spans)
            found.append(replace(row, evaluations=evaluations, migrants=migrants))
        return tuple(found)

    def champions(self, epoch: int) -> dict[int, Champion | None]:
        """Give each island's champion at the end of an epoch that all have finished and nobody has forgotten."""
        return {island: self._epochs[epoch][island].champion for island in self._names}

    def restore(self, champions: Mapping[int, Champion | None]) -> None:
        """Begin with the champions of epochs before; to be called before all else."""
        self._champions.update((island, one) for island, one in champions.items() if one is not None)

    def forget(self, before: int) -> None:
        """Forget epochs before this one."""
        for epoch in [epoch for epoch in self._epochs if epoch < before]:
            del self._epochs[epoch]


def _trouble(state: State[Any]) -> str:
    """Say why an island has no valid member."""
    if not state.deme and not state.counter:
        return "it waits for parts"
    return most_frequent_error(state.deme)


def most_frequent_error(deme: Sequence[Individual[Any]]) -> str:
    """Give an error that is typical of a deme: of the commonest reason the commonest text; empty without any."""
    errors = [member.error for member in deme if member.error]
    if not errors:
        return ""
    reasons = [error.partition(":")[0] for error in errors]
    commonest = Counter(reasons).most_common(1)[0][0]
    texts = [error for error, reason in zip(errors, reasons, strict=True) if reason == commonest]
    return one_line(Counter(texts).most_common(1)[0][0], MOST_REASON)
