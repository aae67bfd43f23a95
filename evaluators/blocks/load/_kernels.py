"""Compiled loops of the load models: how deep blocks lie, what each cut carries, and how far it is out of balance.

``joint`` is a row of pairs of places in the cells, ``part`` a connected part of the blocks above one cut.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final, TypeVar, cast

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

F = TypeVar("F", bound=Callable[..., Any])

IN_LINE: Final = 1e-9
"""A share of load whose part across is smaller than this of the whole is along the line to the centre of mass."""


def kernel(function: F) -> F:
    """Compile a function with Numba, kept on disk; strict floating point, one thread."""
    return cast("F", njit(cache=True)(function))


@kernel
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


@kernel
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
    deepest = 0
    for i in range(depth.size):
        deepest = max(deepest, depth[i])
    first = np.zeros(deepest + 2, dtype=np.int64)  # joints by the depth of their lower block
    for j in range(joints.shape[0]):
        first[depth[joints[j, 0]] + 1] += 1
    for k in range(deepest + 1):
        first[k + 1] += first[k]
    order = np.empty(joints.shape[0], dtype=np.int64)
    fill = first[: deepest + 1].copy()
    for j in range(joints.shape[0]):
        k = depth[joints[j, 0]]
        order[fill[k]] = j
        fill[k] += 1
    above = np.arange(cells.shape[0])
    size = np.ones(cells.shape[0], dtype=np.int64)
    total = cells.copy()
    known = np.full(cells.shape[0], -1, dtype=np.int64)  # the part of a root at the present cut
    part = np.full(joints.shape[0], -1, dtype=np.int64)
    counts = np.empty(joints.shape[0], dtype=np.int64)
    centres = np.empty((joints.shape[0], 3), dtype=np.float64)
    found = 0
    for k in range(deepest, 0, -1):
        for o in range(first[k], first[k + 1]):
            a, b = joints[order[o], 0], joints[order[o], 1]
            while above[a] != a:
                above[a] = above[above[a]]
                a = above[a]
            while above[b] != b:
                above[b] = above[above[b]]
                b = above[b]
            if a != b:
                if size[a] < size[b]:
                    a, b = b, a
                above[b] = a
                size[a] += size[b]
                total[a] += total[b]
        start = found
        for o in range(first[k - 1], first[k]):
            j = order[o]
            b = joints[j, 1]
            if depth[b] != k:
                continue
            while above[b] != b:
                b = above[b]
            if known[b] < start:
                known[b] = found
                counts[found] = size[b]
                for axis in range(3):
                    centres[found, axis] = total[b, axis] / size[b]
                found += 1
            part[j] = known[b]
    return part, counts[:found].copy(), centres[:found].copy()


@kernel
def by_part(part: Ints, count: int) -> tuple[Ints, Ints]:
    """Sort joints by part: those of part p are ``order[first[p] : first[p + 1]]``; joints of -1 are left out."""
    first = np.zeros(count + 1, dtype=np.int64)
    for j in range(part.size):
        if part[j] >= 0:
            first[part[j] + 1] += 1
    for p in range(count):
        first[p + 1] += first[p]
    order = np.empty(first[count], dtype=np.int64)
    fill = first[:count].copy()
    for j in range(part.size):
        if part[j] >= 0:
            order[fill[part[j]]] = j
            fill[part[j]] += 1
    return first, order


@kernel
def rigid(
    points: Floats, stiffness: Floats, turning: float, part: Ints, weights: Floats, centres: Floats
) -> tuple[Floats, Floats]:
    """Let each part stand as a rigid body on its elastic joints.

    Taken about the centre of stiffness of the joints, sinking and turning come apart: forces in proportion to stiffness
    carry the weight, and a 3x3 system gives the turn that meets its moment.

    Parameters
    ----------
    points
        (j, 3) float64, where the joints are.
    stiffness
        (j,) float64, force per displacement in any direction.
    turning
        Moment per angle in any direction, for a stiffness of 1; above zero.
    part, weights, centres
        (j,) int64, (p,) float64 and (p, 3) float64: which part stands on each joint, its weight and centre of mass.

    Returns
    -------
    forces, moments : (j, 3) float64
        What is above each joint does this to what is below; zeros at joints of no part.
    """
    forces = np.zeros_like(points)
    moments = np.zeros_like(points)
    first, order = by_part(part, weights.size)
    for p in range(weights.size):
        k = cx = cy = cz = 0.0
        for o in range(first[p], first[p + 1]):
            s = stiffness[order[o]]
            k += s
            cx += s * points[order[o], 0]
            cy += s * points[order[o], 1]
            cz += s * points[order[o], 2]
        cx /= k
        cy /= k
        cz /= k
        a = b = c = turning * k
        d = e = f = 0.0
        for o in range(first[p], first[p + 1]):
            s = stiffness[order[o]]
            x, y, z = points[order[o], 0] - cx, points[order[o], 1] - cy, points[order[o], 2] - cz
            a += s * (y * y + z * z)
            b += s * (x * x + z * z)
            c += s * (x * x + y * y)
            d -= s * x * y
            e -= s * x * z
            f -= s * y * z
        # the moment of the weight (0, 0, -w) about the centre of stiffness has no vertical part
        mx = -(centres[p, 1] - cy) * weights[p]
        my = (centres[p, 0] - cx) * weights[p]
        # Cholesky's L D L^T of [[a, d, e], [d, b, f], [e, f, c]], which is positive definite
        l21, l31 = d / a, e / a
        d2 = b - l21 * d
        l32 = (f - l31 * d) / d2
        d3 = c - l31 * e - l32 * l32 * d2
        y2 = my - l21 * mx
        y3 = -l31 * mx - l32 * y2
        tz = y3 / d3
        ty = y2 / d2 - l32 * tz
        tx = mx / a - l21 * ty - l31 * tz
        for o in range(first[p], first[p + 1]):
            j = order[o]
            s = stiffness[j]
            x, y, z = points[j, 0] - cx, points[j, 1] - cy, points[j, 2] - cz
            forces[j, 0] = s * (ty * z - tz * y)
            forces[j, 1] = s * (tz * x - tx * z)
            forces[j, 2] = s * (tx * y - ty * x) - s / k * weights[p]
            moments[j, 0] = s * turning * tx
            moments[j, 1] = s * turning * ty
            moments[j, 2] = s * turning * tz
    return forces, moments


@kernel
def galasyn(points: Floats, stiffness: Floats, part: Ints, weights: Floats, centres: Floats) -> tuple[Floats, Floats]:
    """Share out each part's weight by Galasyn's vectors (Senatore 2009, 'the one block problem').

    Parameters
    ----------
    points, stiffness, part, weights, centres
        As for :func:`rigid`; a joint's share is in proportion to its stiffness.

    Returns
    -------
    forces, moments : (j, 3) float64
        As of :func:`rigid`, but in balance only where a part has one joint, or by chance.
    """
    forces = np.zeros_like(points)
    moments = np.zeros_like(points)
    across = np.zeros(part.size)
    first, order = by_part(part, weights.size)
    for p in range(weights.size):
        k = 0.0
        for o in range(first[p], first[p + 1]):
            k += stiffness[order[o]]
        for o in range(first[p], first[p + 1]):
            j = order[o]
            share = -weights[p] * stiffness[j] / k  # along z
            x, y, z = points[j, 0] - centres[p, 0], points[j, 1] - centres[p, 1], points[j, 2] - centres[p, 2]
            square = x * x + y * y + z * z
            along = share * z / square if square > 0.0 else 0.0
            across[j] = abs(share) * math.sqrt((x * x + y * y) / square) if square > 0.0 else abs(share)
            if across[j] < IN_LINE * weights[p]:
                across[j] = 0.0
            forces[j, 0] += along * x
            forces[j, 1] += along * y
            forces[j, 2] += along * z
        for o in range(first[p], first[p + 1]):
            i = order[o]
            if across[i] == 0.0:
                continue
            share = -weights[p] * stiffness[i] / k
            # the moment of the part across about its joint is that of the whole share: (centre - joint) x share
            mx = (centres[p, 1] - points[i, 1]) * share
            my = -(centres[p, 0] - points[i, 0]) * share
            others = 0
            turned = 0.0
            for q in range(first[p], first[p + 1]):
                j = order[q]
                if (
                    points[j, 0] != points[i, 0] or points[j, 1] != points[i, 1] or points[j, 2] != points[i, 2]
                ):  # joints that cross in one point have no lever against each other
                    others += 1
                    turned += across[j]
            if others == 0:  # nobody to lean on: all of the load stays with the joint
                forces[i, 0] = forces[i, 1] = 0.0
                forces[i, 2] = share
                moments[i, 0] += mx
                moments[i, 1] += my
                continue
            for q in range(first[p], first[p + 1]):
                j = order[q]
                x, y, z = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1], points[j, 2] - points[i, 2]
                square = x * x + y * y + z * z
                if square == 0.0:
                    continue
                # the force (m x r) / r^2 has the moment m less its part along r, which stays as a twist
                met = (across[j] / turned if turned > 0.0 else 1.0 / others) / square
                forces[j, 0] += met * my * z
                forces[j, 1] -= met * mx * z
                forces[j, 2] += met * (mx * y - my * x)
                twist = met * (mx * x + my * y)
                moments[i, 0] += twist * x
                moments[i, 1] += twist * y
                moments[i, 2] += twist * z
    return forces, moments


@kernel
def imbalance(points: Floats, forces: Floats, moments: Floats, part: Ints, weights: Floats, centres: Floats) -> Floats:
    """Tell how far each part is from equilibrium.

    Parameters
    ----------
    points, forces, moments, part, weights, centres
        As for :func:`rigid`, and what it gives.

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
