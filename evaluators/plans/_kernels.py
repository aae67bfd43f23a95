"""Kernels that measure plans: what rooms share, and where a plan fits its site best."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Bytes = NDArray[np.uint8]

ABSENT = -(2**20)


@njit(cache=True)
def walls(cells: Ints, rooms: Ints, count: int, steps: Ints) -> tuple[Ints, Ints]:
    """Count the edges of cells between rooms, and those to the outside.

    Returns
    -------
    shared
        (count, count) int64, symmetric, edges between two rooms; 0 on the diagonal.
    outer
        (count, D) int64, edges of each room and vector beyond which lies no cell.
    """
    low = np.array([cells[:, 0].min(), cells[:, 1].min(), cells[:, 2].min()]) - 1
    high = np.array([cells[:, 0].max(), cells[:, 1].max(), cells[:, 2].max()]) + 1
    there = np.full((high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1), -1, dtype=np.int64)
    for n in range(len(cells)):
        there[cells[n, 0] - low[0], cells[n, 1] - low[1], cells[n, 2] - low[2]] = rooms[n]
    shared = np.zeros((count, count), dtype=np.int64)
    outer = np.zeros((count, steps.shape[1]), dtype=np.int64)
    for n in range(len(cells)):
        kind = cells[n, 2] if steps.shape[0] > 1 else 0
        for way in range(steps.shape[1]):
            if steps[kind, way, 0] != ABSENT:
                x = cells[n, 0] + steps[kind, way, 0] - low[0]
                y = cells[n, 1] + steps[kind, way, 1] - low[1]
                z = cells[n, 2] + steps[kind, way, 2] - low[2]
                other = there[x, y, z]
                if other < 0:
                    outer[rooms[n], way] += 1
                elif other != rooms[n]:
                    shared[rooms[n], other] += 1
    return shared, outer


@njit(cache=True)
def distances(adjacent: Bytes) -> Ints:
    """Give how many walls are crossed from room to room, (r, r) int64; r where there is no way."""
    count = len(adjacent)
    far = np.full((count, count), count, dtype=np.int64)
    queue = np.empty(count, dtype=np.int64)
    for start in range(count):
        far[start, start] = 0
        queue[0] = start
        begin, end = 0, 1
        while begin < end:
            at = queue[begin]
            begin += 1
            for other in range(count):
                if adjacent[at, other] and far[start, other] == count:
                    far[start, other] = far[start, at] + 1
                    queue[end] = other
                    end += 1
    return far


@njit(cache=True)
def best_place(cells: Ints, inside: Bytes, origin: Ints) -> tuple[int, int, int]:
    """Find where most of a plan's cells lie in a site.

    Parameters
    ----------
    cells
        (n, 3).
    inside
        (layers, rows, columns), which cells lie in the site; the first of them is ``origin``, (2,): x, y.

    Returns
    -------
    How many lie in it, and the shift in x and y that puts them there: of equal ones the first, row by row.
    """
    low_x, high_x = cells[:, 0].min(), cells[:, 0].max()
    low_y, high_y = cells[:, 1].min(), cells[:, 1].max()
    best, at_x, at_y = -1, 0, 0
    for shift_y in range(origin[1] - high_y, origin[1] + inside.shape[1] - low_y):
        for shift_x in range(origin[0] - high_x, origin[0] + inside.shape[2] - low_x):
            found = 0
            for n in range(len(cells)):
                x = cells[n, 0] + shift_x - origin[0]
                y = cells[n, 1] + shift_y - origin[1]
                if 0 <= x < inside.shape[2] and 0 <= y < inside.shape[1]:
                    layer = cells[n, 2] if inside.shape[0] > 1 else 0
                    found += inside[layer, y, x]
            if found > best:
                best, at_x, at_y = found, shift_x, shift_y
    return best, at_x, at_y
