"""Compiled loops over cells: which of them touch, and which one a ray meets first."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]
Bytes = NDArray[np.uint8]


@njit(cache=True)
def _home(x: int, y: int, z: int, mask: int) -> int:
    """Give the slot of the table at which the search for a cell begins."""
    mixed = x * 73856093 ^ y * 19349663 ^ z * 83492791
    return (mixed ^ (mixed >> 17)) & mask


@njit(cache=True)
def table(cells: Ints) -> Ints:
    """Lay cells out for :func:`place_of`: an open-addressing hash table of their places, -1 where it is empty.

    Parameters
    ----------
    cells
        (n, 3) int64, no two alike.

    Returns
    -------
    (m,) int64, m a power of two, at least twice n.
    """
    size = 4
    while size < 2 * cells.shape[0]:
        size *= 2
    slots = np.full(size, -1, dtype=np.int64)
    for i in range(cells.shape[0]):
        slot = _home(cells[i, 0], cells[i, 1], cells[i, 2], size - 1)
        while slots[slot] >= 0:
            slot = (slot + 1) & (size - 1)
        slots[slot] = i
    return slots


@njit(cache=True)
def place_of(slots: Ints, cells: Ints, x: int, y: int, z: int) -> int:
    """Give the place of the cell (x, y, z), or -1 where there is none."""
    mask = slots.size - 1
    slot = _home(x, y, z, mask)
    while slots[slot] >= 0:
        i = slots[slot]
        if cells[i, 0] == x and cells[i, 1] == y and cells[i, 2] == z:
            return int(i)
        slot = (slot + 1) & mask
    return -1


@njit(cache=True)
def touching(cells: Ints, offsets: Ints, contacts: Bytes) -> tuple[Ints, Bytes]:
    """Find all pairs of neighbours.

    Parameters
    ----------
    cells
        (n, 3) int64, no two alike.
    offsets, contacts
        The lattice's; an offset is looked along when it is above its opposite in lexicographic order.

    Returns
    -------
    pairs : (j, 2) int64
        Places in ``cells``, in ascending order of the first; each pair once.
    kinds : (j,) uint8
        What they share.
    """
    slots = table(cells)
    ahead = np.empty(offsets.shape[0], dtype=np.int64)
    count = 0
    for k in range(offsets.shape[0]):
        x, y, z = offsets[k]
        if x > 0 or (x == 0 and (y > 0 or (y == 0 and z > 0))):
            ahead[count] = k
            count += 1
    pairs = np.empty((cells.shape[0] * count, 2), dtype=np.int64)
    kinds = np.empty(cells.shape[0] * count, dtype=np.uint8)
    found = 0
    for i in range(cells.shape[0]):
        for c in range(count):
            k = ahead[c]
            j = place_of(slots, cells, cells[i, 0] + offsets[k, 0], cells[i, 1] + offsets[k, 1],
                         cells[i, 2] + offsets[k, 2])  # fmt: skip
            if j >= 0:
                pairs[found, 0] = i
                pairs[found, 1] = j
                kinds[found] = contacts[k]
                found += 1
    return pairs[:found].copy(), kinds[:found].copy()


@njit(cache=True)
def first_hits(cells: Ints, sides: Ints, starts: Floats, within: Ints, ways: Floats) -> Ints:
    """Follow rays from cell to cell, over the faces that they leave by, until each meets one of the cells.

    Parameters
    ----------
    cells
        (n, 3) int64, at least one, no two alike.
    sides
        (f, 3) int64, a lattice's offsets over faces: a face lies half way, at right angles to its offset.
    starts, ways
        (r, 3) float64. A ray that runs exactly along an edge passes by the neighbour that comes first in ``sides``.
    within
        (r, 3) int64, the cell that each ray starts in.

    Returns
    -------
    (r,) int64: the place of the first of the cells, that of the start included; -1 for a ray that meets none.
    """
    slots = table(cells)
    low = np.array([cells[:, 0].min(), cells[:, 1].min(), cells[:, 2].min()])
    high = np.array([cells[:, 0].max(), cells[:, 1].max(), cells[:, 2].max()])
    out = np.full(starts.shape[0], -1, dtype=np.int64)
    at = np.empty(3, dtype=np.int64)
    forward = np.empty(sides.shape[0], dtype=np.int64)
    speeds = np.empty(sides.shape[0])
    for r in range(starts.shape[0]):
        count = 0
        for s in range(sides.shape[0]):
            speed = ways[r, 0] * sides[s, 0] + ways[r, 1] * sides[s, 1] + ways[r, 2] * sides[s, 2]
            if speed > 0.0:
                forward[count] = s
                speeds[count] = speed
                count += 1
        at[:] = within[r]
        ahead = count > 0
        while True:
            near = True
            for axis in range(3):
                near = near and low[axis] <= at[axis] <= high[axis]
                # left for good: on the way out, beyond all that cells reach (one unit at most from their centres)
                ahead = ahead and not (at[axis] > high[axis] + 1 and ways[r, axis] >= 0.0)
                ahead = ahead and not (at[axis] < low[axis] - 1 and ways[r, axis] <= 0.0)
            if near:
                out[r] = place_of(slots, cells, at[0], at[1], at[2])
            if out[r] >= 0 or not ahead:
                break
            nearest = np.inf
            side = -1
            for c in range(count):
                s = forward[c]
                far = 0.0
                for axis in range(3):
                    far += (at[axis] + 0.5 * sides[s, axis] - starts[r, axis]) * sides[s, axis]
                if far < nearest * speeds[c]:
                    nearest = far / speeds[c]
                    side = s
            for axis in range(3):
                at[axis] += sides[side, axis]
    return out
