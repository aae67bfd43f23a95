"""Which forms a sheet shows: of each island the best at a few times of the run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

from orchestrator.folder import RunFolder
from orchestrator.query import ask

STAGES: Final = 4
"""Columns of a sheet; one more shows the best of the whole run."""

ISLANDS: Final = 24
"""The most rows of a sheet."""

SQL: Final = """
with ranked as (
    select island, epoch, id, fitness, row_number() over (partition by island, epoch order by fitness desc, id) as place
    from individuals where fitness is not null
)
select island, epoch, id, fitness from ranked where place = 1 order by island, epoch
"""
"""Of each island and epoch the best that was bred in it; of equal ones the lowest id."""


class Cell(NamedTuple):
    """One picture of a sheet: the best that an island bred in the last epoch, up to then, that it bred a valid one in.

    Attributes
    ----------
    stage
        The column's epoch.
    epoch
        When it was bred; not after ``stage``.
    id, fitness
        Of the individual.
    """

    stage: int
    epoch: int
    id: int
    fitness: float


class Row(NamedTuple):
    """An island's pictures; a stage at which it had bred nobody valid yet has none. The last is the best of all."""

    island: str
    cells: tuple[Cell | None, ...]


BEST: Final = "best of all"
"""The last column's name."""


class Stages(NamedTuple):
    """A sheet's plan.

    Attributes
    ----------
    epochs
        Of the columns, ascending.
    rows
        In the order of the islands.
    left_out
        Islands that a sheet has no place for; of each group the first ones stay.
    without
        Islands that bred nobody valid.
    """

    epochs: tuple[int, ...]
    rows: tuple[Row, ...]
    left_out: tuple[str, ...]
    without: tuple[str, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        """What stands over the pictures."""
        return (*(f"epoch {epoch}" for epoch in self.epochs), BEST)


def stages(folder: RunFolder, islands: Sequence[str], count: int = STAGES, most: int = ISLANDS) -> Stages:
    """Choose what a sheet shows.

    Parameters
    ----------
    folder
        The run.
    islands
        By name, in the order of the rows.
    count
        How many columns, from the first epoch to the last.
    most
        How many rows.

    Raises
    ------
    InputError
        When the log cannot be read.
    """
    found: dict[str, list[tuple[int, int, float]]] = {}
    for island, epoch, identity, fitness in ask(folder.log, SQL).rows:
        found.setdefault(str(island), []).append((int(epoch), int(identity), float(fitness)))
    epochs = evenly(max((one[-1][0] for one in found.values()), default=0), count)
    known = [name for name in islands if name in found]
    shown = sorted(_spread(known, most), key=known.index)
    rows = tuple(Row(name, (*(_at(found[name], stage) for stage in epochs), _best(found[name]))) for name in shown)
    missing = tuple(name for name in known if name not in shown)
    return Stages(epochs, rows, missing, tuple(name for name in islands if name not in found))


def evenly(last: int, count: int) -> tuple[int, ...]:
    """Give so many whole numbers from 0 to the last, evenly apart; fewer where there are no more."""
    steps = max(min(count, last + 1) - 1, 1)
    return tuple(dict.fromkeys(round(last * place / steps) for place in range(steps + 1)))


def group_of(island: str) -> str:
    """Give the name of an island's group: ``north-3`` is the fourth of ``north``."""
    stem, dash, number = island.rpartition("-")
    return stem if dash and number.isdecimal() else island


def _at(bred: list[tuple[int, int, float]], stage: int) -> Cell | None:
    before = [one for one in bred if one[0] <= stage]
    return Cell(stage, *before[-1]) if before else None


def _best(bred: list[tuple[int, int, float]]) -> Cell:
    epoch, identity, fitness = max(bred, key=lambda one: (one[2], -one[0]))
    return Cell(epoch, epoch, identity, fitness)


def _spread(names: Sequence[str], most: int) -> list[str]:
    """Take the first islands of every group in turn, until there is no more place."""
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault(group_of(name), []).append(name)
    turns = max(map(len, groups.values()), default=0)
    return [members[turn] for turn in range(turns) for members in groups.values() if turn < len(members)][:most]
