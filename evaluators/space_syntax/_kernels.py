"""Compiled breadth-first searches over a graph of spaces, from every space.

SciPy's `csgraph` finds the same distances, but by Dijkstra's method with a heap where every step is 1 long.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


@njit(cache=True)
def _search(root: int, starts: Ints, neighbours: Ints, order: Ints, depth: Ints, ways: Floats) -> int:
    """Find the spaces that a root reaches, nearest first, their depths and the numbers of shortest paths to them.

    ``depth`` is -1 and ``ways`` 0 for all spaces beforehand. Gives how many places of ``order`` were filled.
    """
    order[0] = root
    depth[root] = 0
    ways[root] = 1.0
    done, known = 0, 1
    while done < known:
        i = order[done]
        done += 1
        for at in range(starts[i], starts[i + 1]):
            j = neighbours[at]
            if depth[j] < 0:
                depth[j] = depth[i] + 1
                order[known] = j
                known += 1
            if depth[j] == depth[i] + 1:
                ways[j] += ways[i]
    return known


@njit(cache=True)
def depths(starts: Ints, neighbours: Ints) -> Ints:
    """Add up the distances from each space to all that it reaches: (n,) int64."""
    count = starts.size - 1
    total = np.zeros(count, dtype=np.int64)
    order = np.empty(count, dtype=np.int64)
    depth = np.full(count, -1, dtype=np.int64)
    ways = np.zeros(count)
    for root in range(count):
        for at in range(_search(root, starts, neighbours, order, depth, ways)):
            i = order[at]
            total[root] += depth[i]
            depth[i] = -1
            ways[i] = 0.0
    return total


@njit(cache=True)
def between(starts: Ints, neighbours: Ints) -> Floats:
    """Add up, over all unordered pairs of other spaces, the share of their shortest paths that lead through each space.

    What depends on a space is handed back from the farthest to the nearest (Brandes 2001, theorem 6).

    Returns
    -------
    (n,) float64
    """
    count = starts.size - 1
    through = np.zeros(count)
    order = np.empty(count, dtype=np.int64)
    depth = np.full(count, -1, dtype=np.int64)
    ways = np.zeros(count)
    share = np.zeros(count)
    for root in range(count):
        known = _search(root, starts, neighbours, order, depth, ways)
        for at in range(known - 1, 0, -1):
            i = order[at]
            for place in range(starts[i], starts[i + 1]):
                j = neighbours[place]
                if depth[j] == depth[i] - 1:
                    share[j] += ways[j] / ways[i] * (1.0 + share[i])
            through[i] += share[i]
        for at in range(known):
            i = order[at]
            depth[i] = -1
            ways[i] = 0.0
            share[i] = 0.0
    return through / 2.0  # each pair was met from both ends
