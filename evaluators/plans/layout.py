"""What criteria of plans see: a plan, its brief, and what follows from both: walls, distances and doors."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final, NamedTuple, final

import numpy as np
from numpy.typing import NDArray

from evaluators.plans import _kernels
from evaluators.plans.brief import Brief, Side
from evaluators.plans.ground import ground
from growth.polyforms.polyform import Plan
from growth.polyforms.tiling import TILINGS, Tiling

Ints = NDArray[np.int64]

COMPASS: Final[dict[Side, tuple[float, float]]] = {
    "north": (0.0, 1.0), "east": (1.0, 0.0), "south": (0.0, -1.0), "west": (-1.0, 0.0),
}  # fmt: skip

TOWARDS: Final = 0.6
"""An edge faces a side when its outward normal is nearer to it than this cosine (53 degrees) says."""


class Door(NamedTuple):
    """A door between two rooms, by their numbers; the adjacency that it is there for is met."""

    first: int
    second: int


class Place(NamedTuple):
    """Where a plan lies on its site.

    Attributes
    ----------
    shift
        What is added to its cells' x and y.
    inside
        How many of its cells lie in the outline.
    """

    shift: tuple[int, int]
    inside: int


@final
@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """A plan as it is judged.

    Attributes
    ----------
    plan, brief
        Its rooms are those of the brief, in the brief's order.
    shared
        (r, r) int64, edges of cells between rooms.
    outer
        (r, D) int64, edges of each room to the outside, by their vector.
    far
        (r, r) int64, walls crossed from room to room where rooms that share ``brief.door`` edges are adjacent; r where
        there is no way.
    doors
        For each adjacency that is met one, in the brief's order.
    place
        On the site; where the plan lies best.
    """

    plan: Plan
    brief: Brief
    shared: Ints
    outer: Ints
    far: Ints
    doors: tuple[Door, ...]
    place: Place

    def facing(self, room: int, side: Side) -> int:
        """Count the edges of a room's outer walls that face a side."""
        return int(self.outer[room, facing(self.plan.tiling.name, side)].sum())


def laid_out(plan: Plan, brief: Brief) -> Layout:
    """Find walls, distances, doors and place of a plan."""
    count = plan.count
    shared, outer = _kernels.walls(plan.cells, plan.rooms, count, plan.tiling.steps)
    far = _kernels.distances((shared >= brief.door).astype(np.uint8))
    number = {name: k for k, name in enumerate(brief.rooms)}
    pairs = [(number[one.first], number[one.second]) for one in brief.adjacencies]
    doors = tuple(Door(a, b) for a, b in pairs if shared[a, b] >= brief.door)
    place = Place((0, 0), len(plan.cells))
    if brief.site.outline is not None:
        inside, origin = ground(brief.site.outline, plan.tiling.name)
        found, x, y = _kernels.best_place(plan.cells, inside, origin)
        place = Place((x, y), found)
    return Layout(plan, brief, shared, outer, far, doors, place)


@lru_cache(maxsize=64)
def facing(tiling: str, side: Side) -> Ints:
    """Give the vectors of edges whose outward normal faces a side: (k,) int64."""
    cells = TILINGS[tiling]
    normals = outward(cells)
    return np.flatnonzero(normals @ np.array(COMPASS[side]) > TOWARDS)


@lru_cache(maxsize=16)
def _outward(tiling: str) -> NDArray[np.float64]:
    cells = TILINGS[tiling]
    found = np.zeros((len(cells.letters), 2))
    for kind in range(cells.types):
        middle = _middle(cells, np.array([0, 0, kind]))
        for vector in cells.around[kind].tolist():
            step = cells.steps[kind, vector]
            away = _middle(cells, np.array([0, 0, kind]) + step) - middle
            length = float(np.linalg.norm(away[:2]))
            if length > 0:
                found[vector] = away[:2] / length
    found.flags.writeable = False
    return found


def outward(tiling: Tiling) -> NDArray[np.float64]:
    """Give the outward normal in the plane of each edge vector: (D, 2); 0 of cubes' floors and ceilings."""
    return _outward(tiling.name)


def _middle(tiling: Tiling, cell: Ints) -> NDArray[np.float64]:
    return np.asarray((tiling.vertices(cell[None]) @ tiling.positions.T)[0].mean(axis=0))
