"""Kernels that measure one form of cells; see :mod:`growth.polyforms.tiling` for the tables."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

ABSENT = -(2**20)


@njit(cache=True)
def rim(cells: Ints, steps: Ints) -> int:
    """Count the edges (of cubes the faces) beyond which lies no cell of the form."""
    low = np.array([cells[:, 0].min(), cells[:, 1].min(), cells[:, 2].min()]) - 1
    high = np.array([cells[:, 0].max(), cells[:, 1].max(), cells[:, 2].max()]) + 1
    there = np.zeros((high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1), dtype=np.uint8)
    for n in range(len(cells)):
        there[cells[n, 0] - low[0], cells[n, 1] - low[1], cells[n, 2] - low[2]] = 1
    total = 0
    for n in range(len(cells)):
        kind = cells[n, 2] if steps.shape[0] > 1 else 0
        for way in range(steps.shape[1]):
            if steps[kind, way, 0] != ABSENT:
                x = cells[n, 0] + steps[kind, way, 0] - low[0]
                y = cells[n, 1] + steps[kind, way, 1] - low[1]
                z = cells[n, 2] + steps[kind, way, 2] - low[2]
                total += there[x, y, z] == 0
    return total


@njit(cache=True)
def turning(cells: Ints, corners: Ints, lattice: Ints, straight: int) -> int:
    """Count the corners of a form that is a disc (of cubes those at which an odd number of cubes meet)."""
    each = corners.shape[1]
    places = np.empty((len(cells) * each, 3), dtype=np.int64)
    for n in range(len(cells)):
        kind = cells[n, 2] if corners.shape[0] > 1 else 0
        for k in range(each):
            for axis in range(3):
                value = corners[kind, k, axis]
                for other in range(3):
                    value += lattice[axis, other] * cells[n, other]
                places[n * each + k, axis] = value
    low = np.array([places[:, 0].min(), places[:, 1].min(), places[:, 2].min()])
    high = np.array([places[:, 0].max(), places[:, 1].max(), places[:, 2].max()])
    meet = np.zeros((high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1), dtype=np.uint8)
    for n in range(len(places)):
        meet[places[n, 0] - low[0], places[n, 1] - low[1], places[n, 2] - low[2]] += 1
    total = 0
    full = 8 if each == 8 else (3 if each == 6 else (6 if each == 3 else 4))
    for count in meet.ravel():
        if each == 8:
            total += count % 2
        elif 0 < count < full and count != straight:
            total += 1
    return total


@njit(cache=True)
def slimness(cells: Ints, rooms: Ints, count: int, corners: Ints, lattice: Ints, positions: Floats) -> Floats:
    """Give the short over the long horizontal side of the upright box around each room: (count,) float64."""
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    for n in range(len(cells)):
        kind = cells[n, 2] if corners.shape[0] > 1 else 0
        for k in range(corners.shape[1]):
            x, y = 0.0, 0.0
            for axis in range(3):
                place = corners[kind, k, axis]
                for other in range(3):
                    place += lattice[axis, other] * cells[n, other]
                x += positions[0, axis] * place
                y += positions[1, axis] * place
            room = rooms[n]
            low[room, 0], high[room, 0] = min(low[room, 0], x), max(high[room, 0], x)
            low[room, 1], high[room, 1] = min(low[room, 1], y), max(high[room, 1], y)
    sides = high - low
    found = np.empty(count)
    for room in range(count):
        found[room] = min(sides[room, 0], sides[room, 1]) / max(sides[room, 0], sides[room, 1])
    return found
