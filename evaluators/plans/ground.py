"""Which cells lie in a site's outline, whole."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from growth.outline import Outline
from growth.polyforms.tiling import TILINGS

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

SHRUNK: Final = 1.0 - 1e-6
"""Cells are looked at a little smaller, so that an outline may run along their edges."""


@lru_cache(maxsize=64)
def ground(outline: Outline, tiling: str) -> tuple[NDArray[np.uint8], Ints]:
    """Give which cells lie whole in an outline: (layers, rows, columns) uint8, and the first one.

    Cubes count by their floors.
    """
    cells = TILINGS["square" if tiling == "cube" else tiling]
    points = np.array(outline.points)
    basis = (cells.positions @ cells.lattice)[:2, :2]
    box = np.array(
        [(x, y) for x in (points[:, 0].min(), points[:, 0].max()) for y in (points[:, 1].min(), points[:, 1].max())]
    )
    there = np.linalg.solve(basis, box.T).T
    low, high = np.floor(there.min(axis=0)).astype(np.int64) - 1, np.ceil(there.max(axis=0)).astype(np.int64) + 1
    rows, columns = np.meshgrid(np.arange(low[1], high[1] + 1), np.arange(low[0], high[0] + 1), indexing="ij")
    inside = np.zeros((cells.types, *rows.shape), dtype=np.uint8)
    for kind in range(cells.types):
        every = np.stack([columns.ravel(), rows.ravel(), np.full(rows.size, kind)], axis=1)
        rings = (cells.vertices(every) @ cells.positions.T)[..., :2]
        held = np.asarray(outline.holds(rings.reshape(-1, 2)).reshape(len(every), -1).all(axis=1))
        held[held] = ~_cut(rings[held], outline)
        inside[kind] = held.reshape(rows.shape)
    return inside, low


def room_for(outline: Outline, tiling: str) -> int:
    """Count the cells that lie whole in an outline."""
    return int(ground(outline, tiling)[0].sum())


def _cut(rings: Floats, outline: Outline) -> NDArray[np.bool_]:
    """Tell which convex cells, (n, m, 2), a side of the outline runs into, though their corners may all lie inside."""
    middle = rings.mean(axis=1, keepdims=True)
    rings = middle + SHRUNK * (rings - middle)
    after = np.roll(rings, -1, axis=1)
    found = np.zeros(len(rings), dtype=bool)
    for a, b in zip(outline.points, (*outline.points[1:], outline.points[0]), strict=True):
        here, there = np.array(a), np.array(b)
        ends = _side(here, there, rings) * _side(here, there, after) < 0
        spans = _side(rings, after, here) * _side(rings, after, there) < 0
        found |= (ends & spans).any(axis=1)
        turns = np.sign(_side(rings, after, here))
        found |= np.abs(turns.sum(axis=1)) == rings.shape[1]  # the outline's corner lies in the cell
    return found


def _side(a: Floats, b: Floats, c: Floats) -> Floats:
    """Say on which side of the line from a to b the point c lies."""
    return np.asarray(
        (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])
    )
