"""Fitness and diversity over the generations, of each group of islands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from analysis.colours import colour, dashes
from analysis.report.drawing import drawn
from analysis.report.parts import Figure, Section, asked
from analysis.stages import group_of
from orchestrator.folder import RunFolder
from orchestrator.query import Answer

MOST: Final = 8
"""Islands of a group that have lines of their own; the others are in the table."""

SQL: Final = """
select island, generation, {columns} from generations
where island in ({islands}) order by island, generation
"""

Line = list[tuple[int, float]]


def curves(folder: RunFolder, islands: Sequence[str]) -> Section:
    """Draw a figure of fitness and one of diversity for each group."""
    groups: dict[str, list[str]] = {}
    for name in islands:
        groups.setdefault(group_of(name), []).append(name)
    figures = []
    for group, members in groups.items():
        figures += _of(folder, group, members)
    text = (
        "Bold lines are the best valid member of each island's deme, thin ones the mean. "
        "Fitness is maximised; goals differ between species, and so do their scales."
    )
    return Section("curves", "Fitness and diversity", text, tuple(figures))


def _of(folder: RunFolder, group: str, members: Sequence[str]) -> list[Figure]:
    named = ", ".join("'" + name.replace("'", "''") + "'" for name in members)
    sql, fitness = asked(folder, SQL.format(columns="best, mean", islands=named))
    other, diversity = asked(folder, SQL.format(columns="diversity", islands=named))
    more = f"The first {MOST} of {len(members)} islands have lines." if len(members) > MOST else ""
    shown = members[:MOST]
    bests = drawn(f"fitness {group}", lambda axes: _fitness(axes, fitness, shown))
    spreads = drawn(f"diversity {group}", lambda axes: _diversity(axes, diversity, shown))
    return [
        Figure(f"{group}: fitness", sql, fitness, bests, more),
        Figure(f"{group}: diversity", other, diversity, spreads, more),
    ]


def _fitness(axes: Any, answer: Answer, shown: Sequence[str]) -> None:  # noqa: ANN401 - matplotlib's
    for place, name in enumerate(shown):
        best, mean = lines(answer, name, "best"), lines(answer, name, "mean")
        axes.plot(*_apart(best), color=colour(place), linestyle=dashes(place), linewidth=1.8, label=name)
        axes.plot(*_apart(mean), color=colour(place), linestyle=dashes(place), linewidth=0.8)
    _named(axes, "fitness", shown)


def _diversity(axes: Any, answer: Answer, shown: Sequence[str]) -> None:  # noqa: ANN401 - matplotlib's
    for place, name in enumerate(shown):
        found = _apart(lines(answer, name, "diversity"))
        axes.plot(*found, color=colour(place), linestyle=dashes(place), linewidth=1.5, label=name)
    axes.set_ylim(-0.02, 1.02)
    _named(axes, "diversity, 0 to 1", shown)


def _named(axes: Any, what: str, shown: Sequence[str]) -> None:  # noqa: ANN401 - matplotlib's
    axes.set_xlabel("generation")
    axes.set_ylabel(what)
    axes.xaxis.get_major_locator().set_params(integer=True)
    if len(shown) > 1:
        axes.legend(frameon=False, fontsize=7, ncols=2 if len(shown) > 3 else 1)


def lines(answer: Answer, island: str, column: str) -> Line:
    """Give the points of one island's line: generations, and the values that there are."""
    place = answer.columns.index(column)
    rows = (row for row in answer.rows if row[0] == island and row[place] is not None)
    return [(int(row[1]), float(row[place])) for row in rows]


def _apart(line: Line) -> tuple[list[int], list[float]]:
    return [at for at, _ in line], [value for _, value in line]
