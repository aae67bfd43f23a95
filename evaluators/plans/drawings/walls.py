"""Walls with thickness: the faces of rooms, and the body of each wall between them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Final, NamedTuple

from evaluators.plans.drawings.drawing import OUTSIDE, Point, Ring, Wall
from evaluators.plans.drawings.edges import Corner, Run, direction

OUTER: Final = 0.30
INNER: Final = 0.12
"""Thicknesses in metres, where cells are large."""
LARGEST: Final = 0.22
"""Of an outer wall, as a share of a cell's edge; inner walls are thinner in the same proportion."""

Place = Callable[[Corner], Point]


class Face(NamedTuple):
    """One side of a room along the face of its wall.

    Attributes
    ----------
    start, end
        Chains of points from the axis' end to where the face begins, and to where it ends: one point each, two where
        the room's wall grows thinner or thicker along a straight line.
    """

    start: tuple[Point, ...]
    end: tuple[Point, ...]


def thicknesses(unit: float) -> tuple[float, float]:
    """Give the thickness of outer and of inner walls for cells of so long an edge."""
    outer = min(OUTER, LARGEST * unit)
    return outer, outer * INNER / OUTER


def faces(runs: Sequence[Run], room: int, unit: float, place: Place) -> list[Face]:
    """Give the faces of a room's, or the outside's, sides."""
    half = [_half(room, run.beyond, unit) for run in runs]
    ends: list[list[tuple[Point, ...]]] = []
    for k, run in enumerate(runs):
        before, at = runs[k - 1], place(run.first)
        one, two = _normal(before, place), _normal(run, place)
        if direction(before) != direction(run):
            ends.append([(_meeting(at, one, half[k - 1], two, half[k]),)] * 2)
            continue
        thin, thick = (_moved(at, two, far) for far in sorted((half[k - 1], half[k])))
        chains: dict[float, tuple[Point, ...]] = {max(half[k - 1], half[k]): (thin, thick)}
        chains[min(half[k - 1], half[k])] = (thin,)
        ends.append([chains[half[k - 1]], chains[half[k]]])
    return [Face(ends[k][1], ends[(k + 1) % len(runs)][0]) for k in range(len(runs))]


def floor(found: Sequence[Face]) -> Ring:
    """Give the ring along the faces."""
    points: list[Point] = []
    for face in found:
        points += [face.start[-1], face.end[-1]]
    return straightened(points)


def walls(
    sides: Mapping[int, Sequence[Run]], found: Mapping[int, Sequence[Face]], unit: float, place: Place
) -> list[Wall]:
    """Give the walls, room by room in order around them, each once."""
    where = {(room, run.first): k for room, runs in sides.items() for k, run in enumerate(runs)}
    made = []
    for room, runs in sides.items():
        for k, run in enumerate(runs):
            if room != OUTSIDE and (run.beyond == OUTSIDE or room < run.beyond):
                left, right = found[room][k], found[run.beyond][where[run.beyond, run.last]]
                made.append(_wall(room, run, left, right, unit, place))
    return made


def _wall(room: int, run: Run, left: Face, right: Face, unit: float, place: Place) -> Wall:
    first, last = place(run.first), place(run.last)
    length = math.dist(first, last)
    along = ((last[0] - first[0]) / length, (last[1] - first[1]) / length)

    def far(point: Point) -> float:
        return (point[0] - first[0]) * along[0] + (point[1] - first[1]) * along[1]

    # The side as the room beyond sees it begins at this one's end.
    before = (*reversed(left.start), first, *right.end)
    after = (*reversed(right.start), last, *left.end)
    low = max(0.0, far(left.start[-1]), far(right.end[-1]))
    high = min(length, far(left.end[-1]), far(right.start[-1]))
    return Wall(first, last, (room, run.beyond), 2 * _half(room, run.beyond, unit), before, after, (low, high))


def _half(room: int, beyond: int, unit: float) -> float:
    outer, inner = thicknesses(unit)
    return (outer if OUTSIDE in (room, beyond) else inner) / 2


def _normal(run: Run, place: Place) -> Point:
    (ax, ay), (bx, by) = place(run.first), place(run.last)
    length = math.hypot(bx - ax, by - ay)
    return (ay - by) / length, (bx - ax) / length


def _moved(at: Point, normal: Point, far: float) -> Point:
    return at[0] + far * normal[0], at[1] + far * normal[1]


def _meeting(at: Point, one: Point, far_one: float, two: Point, far_two: float) -> Point:
    """Give the point that lies so far from two lines through a point, by their unit normals."""
    cross = one[0] * two[1] - one[1] * two[0]
    x = (far_one * two[1] - far_two * one[1]) / cross
    y = (far_two * one[0] - far_one * two[0]) / cross
    return at[0] + x, at[1] + y


def straightened(points: Sequence[Point]) -> Ring:
    """Leave out points of a ring that are given twice or lie on the straight line between their neighbours."""
    kept = [point for k, point in enumerate(points) if math.dist(point, points[k - 1]) > CLOSE]
    count = len(kept)
    return tuple(kept[k] for k in range(count) if abs(_turn(kept[k - 1], kept[k], kept[(k + 1) % count])) > CLOSE)


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


CLOSE: Final = 1e-9
