"""Compiled loops of the load models: how deep blocks lie, what each cut carries, and how far it is out of balance.

``joint`` is a row of pairs of places in the cells, ``part`` a connected part of the blocks above one cut.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


@njit(cache=True)
def depths(count: int, joints: Ints, starts: NDArray[np.bool_]) -> Ints:
    """Tell how many joints lie between each block and the nearest start: breadth first.

    Parameters
    ----------
    count
        How many blocks there are.
    joints
        (j, 2) int64.
    starts
        (count,) bool.

    Returns
    -------
    (count,) int64: 0 at the starts, -1 for what is joined to none of them.
    """
    first = np.zeros(count + 1, dtype=np.int64)
    for j in range(joints.shape[0]):
        first[joints[j, 0] + 1] += 1
        first[joints[j, 1] + 1] += 1
    for i in range(count):
        first[i + 1] += first[i]
    near = np.empty(2 * joints.shape[0], dtype=np.int64)
    fill = first[:count].copy()
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        near[fill[a]] = b
        fill[a] += 1
        near[fill[b]] = a
        fill[b] += 1
    depth = np.full(count, -1, dtype=np.int64)
    queue = np.empty(count, dtype=np.int64)
    end = 0
    for i in range(count):
        if starts[i]:
            depth[i] = 0
            queue[end] = i
            end += 1
    head = 0
    while head < end:
        i = queue[head]
        head += 1
        for n in range(first[i], first[i + 1]):
            j = near[n]
            if depth[j] < 0:
                depth[j] = depth[i] + 1
                queue[end] = j
                end += 1
    return depth


@njit(cache=True)
def by_group(group: Ints, count: int) -> tuple[Ints, Ints]:
    """Sort things by group: those of group g are ``order[first[g] : first[g + 1]]``; those of -1 are left out."""
    first = np.zeros(count + 1, dtype=np.int64)
    for i in range(group.size):
        if group[i] >= 0:
            first[group[i] + 1] += 1
    for g in range(count):
        first[g + 1] += first[g]
    order = np.empty(first[count], dtype=np.int64)
    fill = first[:count].copy()
    for i in range(group.size):
        if group[i] >= 0:
            order[fill[group[i]]] = i
            fill[group[i]] += 1
    return first, order


@njit(cache=True)
def _root(above: Ints, i: int) -> int:
    """Find what stands for the block's part, and shorten the way there."""
    while above[i] != i:
        above[i] = above[above[i]]
        i = above[i]
    return i


@njit(cache=True)
def _join(above: Ints, size: Ints, total: Ints, a: int, b: int) -> None:
    """Make the parts of two blocks one, with the sums of their sizes and coordinates."""
    a, b = _root(above, a), _root(above, b)
    if a != b:
        if size[a] < size[b]:
            a, b = b, a
        above[b] = a
        size[a] += size[b]
        for axis in range(3):
            total[a, axis] += total[b, axis]


@njit(cache=True)
def parts_above(cells: Ints, depth: Ints, joints: Ints) -> tuple[Ints, Ints, Floats]:
    """Find the connected parts of the blocks above each layer, from the deepest layer down.

    Parameters
    ----------
    cells
        (n, 3) int64.
    depth
        (n,) int64, of :func:`depths`; blocks of -1 belong to no part.
    joints
        (j, 2) int64, the less deep block first. Their two depths differ by one at most.

    Returns
    -------
    part : (j,) int64
        For each joint the part that stands on it: what hangs together at the depth of its upper block and deeper. -1
        for a joint within a layer, which is cut nowhere.
    counts : (p,) int64
        How many blocks each part has.
    centres : (p, 3) float64
        Their centres of mass.
    """
    lower = np.empty(joints.shape[0], dtype=np.int64)
    deepest = 0
    for j in range(joints.shape[0]):
        lower[j] = depth[joints[j, 0]]
        deepest = max(deepest, depth[joints[j, 1]])
    first, order = by_group(lower, deepest + 1)
    above, size, total = np.arange(cells.shape[0]), np.ones(cells.shape[0], dtype=np.int64), cells.copy()
    known = np.full(cells.shape[0], -1, dtype=np.int64)  # the latest part of a root
    part = np.full(joints.shape[0], -1, dtype=np.int64)
    counts = np.empty(joints.shape[0], dtype=np.int64)
    centres = np.empty((joints.shape[0], 3), dtype=np.float64)
    found = 0
    for k in range(deepest, 0, -1):
        for o in range(first[k], first[k + 1]):
            _join(above, size, total, joints[order[o], 0], joints[order[o], 1])
        start = found
        for o in range(first[k - 1], first[k]):
            j = order[o]
            if depth[joints[j, 1]] == k:
                root = _root(above, joints[j, 1])
                if known[root] < start:
                    known[root] = found
                    counts[found] = size[root]
                    for axis in range(3):
                        centres[found, axis] = total[root, axis] / size[root]
                    found += 1
                part[j] = known[root]
    return part, counts[:found].copy(), centres[:found].copy()


@njit(cache=True)
def imbalance(points: Floats, forces: Floats, moments: Floats, part: Ints, weights: Floats, centres: Floats) -> Floats:
    """Tell how far each part is from equilibrium.

    Parameters
    ----------
    points, forces, moments, part, weights, centres
        (j, 3) float64, where the joints are and what they carry; (j,) int64, which part stands on each; (p,) and (p, 3)
        float64, its weight and centre of mass.

    Returns
    -------
    (p, 2) float64
        Norms of the force and of the moment about the centre of mass that are missing.
    """
    sums = np.zeros((weights.size, 6))
    for p in range(weights.size):
        sums[p, 2] = weights[p]
    for j in range(part.size):
        p = part[j]
        if p < 0:
            continue
        x, y, z = points[j, 0] - centres[p, 0], points[j, 1] - centres[p, 1], points[j, 2] - centres[p, 2]
        fx, fy, fz = forces[j, 0], forces[j, 1], forces[j, 2]
        sums[p, 0] += fx
        sums[p, 1] += fy
        sums[p, 2] += fz
        sums[p, 3] += moments[j, 0] + y * fz - z * fy
        sums[p, 4] += moments[j, 1] + z * fx - x * fz
        sums[p, 5] += moments[j, 2] + x * fy - y * fx
    out = np.empty((weights.size, 2))
    for p in range(weights.size):
        out[p, 0] = math.sqrt(sums[p, 0] ** 2 + sums[p, 1] ** 2 + sums[p, 2] ** 2)
        out[p, 1] = math.sqrt(sums[p, 3] ** 2 + sums[p, 4] ** 2 + sums[p, 5] ** 2)
    return out
