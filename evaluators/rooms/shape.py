"""What a room's shape is worth: its rim, its corners, its proportions."""

from __future__ import annotations

import numpy as np

from evaluators.rooms import _kernels
from growth.polyforms.polyform import Polyform


def perimeter(room: Polyform) -> float:
    """Give the length of the boundary, of cubes its area: at least 2 ceil(2 sqrt(n)) for n squares."""
    return float(_kernels.rim(room.cells, room.tiling.steps))


def corners(room: Polyform) -> float:
    """Count the angles of the boundary, 4 of a rectangle; of cubes the points where an odd number of cubes meet."""
    tiling = room.tiling
    return float(_kernels.turning(room.cells, tiling.corners, tiling.lattice, tiling.straight))


def perimeter_to_area(room: Polyform) -> float:
    """Give the boundary's length over the area (of cubes, area over volume), in units of an edge."""
    return perimeter(room) / (len(room.cells) * room.tiling.area)


def proportions(room: Polyform) -> float:
    """Give the short side over the long side of the smallest upright box around the room, above 0 and at most 1.

    Of cubes the box's two horizontal sides.
    """
    tiling = room.tiling
    whole = np.zeros(len(room.cells), dtype=np.int64)
    return float(_kernels.slimness(room.cells, whole, 1, tiling.corners, tiling.lattice, tiling.positions)[0])
