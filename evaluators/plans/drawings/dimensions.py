"""Dimension lines along the four sides of a plan."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

from evaluators.plans.brief import Side
from evaluators.plans.drawings.doors import faces
from evaluators.plans.drawings.drawing import Dimension, Point, Wall
from evaluators.plans.layout import COMPASS

APART: Final = 0.7
"""How far the second line is from the first, in metres, at least; the first is :data:`NEAREST` times as far out."""
NEAREST: Final = 1.3
MOST: Final = 25
"""So many such distances are the larger side of all that is drawn at most: lines stay apart on small scales."""
SIDES: Final[tuple[Side, ...]] = ("south", "east", "north", "west")


def dimensions(walls: Sequence[Wall], size: float, *, chains: bool) -> list[Dimension]:
    """Measure the plan from axis to axis.

    Parameters
    ----------
    walls
        Of the plan.
    size
        The larger side of all that is drawn, in metres.
    chains
        Whether each side has a line of its own for the ends of its outer walls, as where walls are at right angles.

    Returns
    -------
    list of Dimension
        For each side the stretches between the ends of outer walls that face it; behind them in the south and the west
        the whole.
    """
    outer = [wall for wall in walls if wall.outer]
    points = [point for wall in outer for point in (wall.first, wall.last)]
    apart = max(APART, size / MOST)
    found: list[Dimension] = []
    for side in SIDES:
        axis = 0 if side in ("south", "north") else 1
        every = [point[axis] for point in points]
        line = _line(points, side)
        stops = [min(every), max(every)]
        if chains:
            facing = [wall for wall in outer if faces(wall, COMPASS[side])]
            stops += [point[axis] for wall in facing for point in (wall.first, wall.last)]
        ordered = _apart(sorted(stops))
        row = 0
        if len(ordered) > 2:
            found += [_dimension(side, a, b, line, apart * (NEAREST + row)) for a, b in pairwise(ordered)]
            row = 1
        if side in ("south", "west") or (row == 0 and chains):
            found.append(_dimension(side, ordered[0], ordered[-1], line, apart * (NEAREST + row)))
    return found


def _line(points: Sequence[Point], side: Side) -> float:
    """Give where the house ends on a side."""
    across = [point[1 if side in ("south", "north") else 0] for point in points]
    return max(across) if side in ("north", "east") else min(across)


def _dimension(side: Side, first: float, last: float, line: float, away: float) -> Dimension:
    at = line + (away if side in ("north", "east") else -away)
    if side in ("south", "north"):
        return Dimension(side, (first, at), (last, at))
    return Dimension(side, (at, first), (at, last))


def _apart(stops: Sequence[float]) -> list[float]:
    """Leave out what is given twice."""
    kept = [stops[0]]
    kept += [b for a, b in pairwise(stops) if b - a > 1e-6]
    return kept
