"""The solid that a plan fills: its outline raised by a height, closed, as a boundary that other forms grow against."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from growth.polyforms.polyform import Plan, Polyform

Floats = NDArray[np.float64]
Triangles = NDArray[np.int32]


def raised(plan: Plan | Polyform, height: float) -> tuple[Floats, Triangles]:
    """Raise a plan from z = 0; of cubes take the cubes.

    Parameters
    ----------
    plan
        Any.
    height
        In edges of cells, above 0; not looked at for cubes.

    Returns
    -------
    vertices
        (v, 3) float64.
    triangles
        (t, 3) int32, fronts outward; closed and, since a plan is a disc, a sphere.
    """
    tiling, cells = plan.tiling, plan.cells
    every = tiling.vertices(cells)
    corners, place = np.unique(every.reshape(-1, 3), axis=0, return_inverse=True)
    place = place.reshape(len(cells), -1)
    points = corners @ tiling.positions.T
    if tiling.solid:
        return points, _fans(_cube_faces(cells, place)).astype(np.int32)
    top = points + np.array([0.0, 0.0, height])
    order = _counter_clockwise(points, place)
    floor, ceiling = _fans(order[:, ::-1]), _fans(order) + len(points)
    sides = np.stack([order, np.roll(order, -1, axis=1)], axis=2).reshape(-1, 2)
    keys = sides[:, 0] * len(points) + sides[:, 1]
    back = sides[:, 1] * len(points) + sides[:, 0]
    a, b = sides[~np.isin(keys, back)].T  # what bounds one cell alone
    walls = np.stack([a, b, b + len(points), a, b + len(points), a + len(points)], axis=1).reshape(-1, 3)
    return np.concatenate([points, top]), np.concatenate([floor, ceiling, walls]).astype(np.int32)


def _counter_clockwise(points: Floats, place: NDArray[np.intp]) -> NDArray[np.intp]:
    """Order each cell's corners counter-clockwise as seen from above."""
    x, y = points[place][..., 0], points[place][..., 1]
    twice = (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    return np.where((twice > 0)[:, None], place, place[:, ::-1])


def _fans(rings: NDArray[np.intp]) -> NDArray[np.intp]:
    """Cut convex rings (n, m) into triangles."""
    parts = [rings[:, [0, k, k + 1]] for k in range(1, rings.shape[1] - 1)]
    return np.concatenate(parts)


def _cube_faces(cells: NDArray[np.int64], place: NDArray[np.intp]) -> NDArray[np.intp]:
    """Give the outer faces of cubes as rings of four corners; corner (x, y, z) of a cube is its 4x + 2y + z."""
    there = {tuple(cell) for cell in cells.tolist()}
    found = []
    for cell, ring in zip(cells.tolist(), place, strict=True):
        for axis in range(3):
            for side in (0, 1):
                other = list(cell)
                other[axis] += 2 * side - 1
                if tuple(other) not in there:
                    u, v = (axis + 1) % 3, (axis + 2) % 3
                    weight = [4, 2, 1]
                    base = side * weight[axis]
                    quad = [base, base + weight[u], base + weight[u] + weight[v], base + weight[v]]
                    found.append(ring[quad if side else quad[::-1]])
    return np.array(found)
