"""The sides of rooms: how the edges of cells join to straight runs between the same two rooms."""

from __future__ import annotations

from typing import NamedTuple

from evaluators.plans.drawings.drawing import OUTSIDE
from growth.polyforms.polyform import Ints, Plan

Corner = tuple[int, int]
"""Of a cell, on the tiling's lattice of corners."""


class Run(NamedTuple):
    """A straight side of a room.

    Attributes
    ----------
    first, last
        Its ends; the room lies left.
    beyond
        The number of the room on the other side, or the outside's.
    edges
        How many edges of cells it is long.
    """

    first: Corner
    last: Corner
    beyond: int
    edges: int


def sides(plan: Plan, cells: Ints) -> dict[int, list[Run]]:
    """Give the sides of each room, and of the outside, in order around it.

    Parameters
    ----------
    plan
        Of a tiling of the plane.
    cells
        Its cells where they are drawn.

    Returns
    -------
    dict
        By room and for the outside: runs, each beginning where the one before ends. The room lies left of all; a
        run ends where the direction changes or another room begins beyond.
    """
    steps = _steps(plan, cells)
    rings = {room: _ring(around) for room, around in sorted(steps.items())}
    return {room: _runs(ring) for room, ring in rings.items()}


def _steps(plan: Plan, cells: Ints) -> dict[int, dict[Corner, tuple[Corner, int]]]:
    """Give for each room from corner to corner along its rim, and what lies beyond."""
    corners = plan.tiling.vertices(cells)[:, :, :2]
    flat = corners @ plan.tiling.positions[:2, :2].T
    turned = (flat[:, 0, 0] * (flat[:, 1, 1] - flat[:, 2, 1]) + flat[:, 1, 0] * (flat[:, 2, 1] - flat[:, 0, 1])
              + flat[:, 2, 0] * (flat[:, 0, 1] - flat[:, 1, 1])) < 0  # fmt: skip
    left: dict[tuple[Corner, Corner], int] = {}
    for ring, clockwise, room in zip(corners.tolist(), turned.tolist(), plan.rooms.tolist(), strict=True):
        points = [(x, y) for x, y in (ring[::-1] if clockwise else ring)]
        left.update(((a, b), room) for a, b in zip(points, points[1:] + points[:1], strict=True))
    steps: dict[int, dict[Corner, tuple[Corner, int]]] = {}
    for (a, b), room in left.items():
        other = left.get((b, a), OUTSIDE)
        if other != room:
            steps.setdefault(room, {})[a] = (b, other)
        if other == OUTSIDE:
            steps.setdefault(OUTSIDE, {})[b] = (a, room)
    return steps


def _ring(around: dict[Corner, tuple[Corner, int]]) -> list[Run]:
    """Give the rim edge by edge; it is one ring, as rooms and plans are discs."""
    first = at = min(around)
    found: list[Run] = []
    while not found or at != first:
        to, beyond = around[at]
        found.append(Run(at, to, beyond, 1))
        at = to
    return found


def _runs(ring: list[Run]) -> list[Run]:
    start = next((k for k in range(len(ring)) if not _goes_on(ring[k - 1], ring[k])), 0)
    found: list[Run] = []
    for edge in ring[start:] + ring[:start]:
        if found and _goes_on(found[-1], edge):
            found[-1] = Run(found[-1].first, edge.last, edge.beyond, found[-1].edges + 1)
        else:
            found.append(edge)
    return found


def _goes_on(before: Run, edge: Run) -> bool:
    return before.beyond == edge.beyond and direction(before) == direction(edge)


def direction(run: Run) -> Corner:
    """Give the lattice's step of one edge of a run."""
    return (run.last[0] - run.first[0]) // run.edges, (run.last[1] - run.first[1]) // run.edges
