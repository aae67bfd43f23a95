"""Compiled loops over a dense grid of cells: what the outside reaches, and how many rays from each cell meet a wall.

A grid is laid out flat, the last axis fastest, with a margin of one cell around on every axis along which its lattice
has neighbours; a step to a neighbour is then one number added to a place, and a step out of the grid over one side
comes back in the margin of the other.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Bytes = NDArray[np.uint8]


@njit(cache=True)
def reached(free: Bytes, inner: Bytes, steps: Ints) -> Bytes:
    """Flood a grid from its margin.

    Parameters
    ----------
    free
        (n,) uint8, 1 for a cell that may be passed; 0 for walls, and for places that are no cells of the lattice.
    inner
        (n,) uint8, 0 in the margin.
    steps
        (s,) int64, from a place to its neighbours.

    Returns
    -------
    (n,) uint8, 1 for the free cells that a path over free cells joins to the margin, those of the margin included.
    """
    out = np.zeros(free.size, dtype=np.uint8)
    dry = free.copy()
    waiting = np.empty(free.size, dtype=np.int64)
    height = 0
    for i in range(free.size):
        if inner[i] == 0 and free[i] != 0:
            dry[i] = 0
            waiting[height] = i
            height += 1
    while height > 0:
        height -= 1
        i = waiting[height]
        out[i] = 1
        for s in range(steps.size):
            j = i + steps[s]
            if 0 <= j < free.size and dry[j] != 0:
                dry[j] = 0
                waiting[height] = j
                height += 1
    return out


@njit(cache=True)
def _looked(seen: Bytes, walls: Bytes, inner: Bytes, here: Bytes, count: Bytes) -> None:
    """Look one step along a direction from each cell of a block: at a wall, or at what is seen from there."""
    for i in range(here.size):
        met = (seen[i] | walls[i]) & inner[i]
        here[i] = met
        count[i] += met


@njit(cache=True)
def sights(walls: Bytes, inner: Bytes, steps: Ints) -> Bytes:
    """Count the directions in which a ray from each cell meets a wall, however far away.

    Each direction is one sweep over the grid towards where the rays come from. A block as long as the step looks at
    blocks that are done, so that the compiler may take many cells at once.

    Parameters
    ----------
    walls
        (n,) uint8, 1 for a wall; none in the margin.
    inner
        (n,) uint8, 0 in the margin, out of which nothing is seen.
    steps
        (s,) int64, at most 255, from a place to its neighbours.

    Returns
    -------
    (n,) uint8, 0 in the margin; walls look too.
    """
    count = np.zeros(walls.size, dtype=np.uint8)
    seen = np.zeros(walls.size, dtype=np.uint8)
    edge = np.abs(steps).max()  # no inner cell stands nearer to either end
    last = walls.size - edge
    for step in steps:
        length = abs(step)
        if length < 16:
            for k in range(last - edge):
                i = edge + k if step < 0 else last - 1 - k
                met = (seen[i + step] | walls[i + step]) & inner[i]
                seen[i] = met
                count[i] += met
            continue
        for k in range((last - edge + length - 1) // length):
            if step < 0:
                a = edge + k * length
                b = min(a + length, last)
            else:
                b = last - k * length
                a = max(b - length, edge)
            _looked(seen[a + step : b + step], walls[a + step : b + step], inner[a:b], seen[a:b], count[a:b])
    return count
