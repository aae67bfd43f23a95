"""Compiled queries of a closed triangle mesh: a tree of boxes, first hits, windings and nearest points.

All in float64: a vertex rests a millionth of the mesh's size off its surface, where float32 rays are blind
(docs/adr/0010-own-mesh-queries.md).
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from growth.environment._kernels import kernel

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]
Point = tuple[float, float, float]

LEAF: Final = 4
"""The most triangles in a leaf."""

STACK: Final = 64
"""Boxes that can wait; halving by count keeps the tree's depth under 32."""

EDGE: Final = 1e-9
"""A ray that passes an edge nearer than this, as a share of the triangle's size, gives an uncertain winding."""


@kernel
def build(low: Floats, high: Floats) -> tuple[Indices, Floats, Indices, Indices]:
    """Build a tree of boxes over triangles, halved by count along the longest axis of their centres.

    Parameters
    ----------
    low, high
        (m, 3) float64, the corners of each triangle's box.

    Returns
    -------
    order
        (m,) int32, the triangles in the order of the leaves.
    boxes
        (b, 6) float64, low and high corner.
    first, count
        (b,) int32: of a leaf, its first place in ``order`` and its number of triangles; of another box, its first
        child (the second stands next to it) and zero.
    """
    m = low.shape[0]
    order = np.arange(m).astype(np.int32)
    boxes = np.empty((2 * m, 6))
    first = np.zeros(2 * m, np.int32)
    count = np.zeros(2 * m, np.int32)
    count[0] = m
    made, box = 1, 0
    while box < made:
        a, n = first[box], count[box]
        boxes[box, :3] = np.inf
        boxes[box, 3:] = -np.inf
        lowest, highest = np.full(3, np.inf), np.full(3, -np.inf)
        for i in order[a : a + n]:
            for j in range(3):
                boxes[box, j] = min(boxes[box, j], low[i, j])
                boxes[box, 3 + j] = max(boxes[box, 3 + j], high[i, j])
                centre = low[i, j] + high[i, j]
                lowest[j], highest[j] = min(lowest[j], centre), max(highest[j], centre)
        if n > LEAF:
            axis = np.argmax(highest - lowest)
            part = order[a : a + n].copy()
            order[a : a + n] = part[np.argsort(low[part, axis] + high[part, axis], kind="mergesort")]
            half = n // 2
            first[made], count[made] = a, half
            first[made + 1], count[made + 1] = a + half, n - half
            first[box], count[box] = made, 0
            made += 2
        box += 1
    return order, boxes[:made].copy(), first[:made].copy(), count[:made].copy()


@kernel
def _in_box(boxes: Floats, b: int, p: Floats, inverse: Floats, low: float, high: float) -> bool:
    """Say whether ``p + t d`` meets a box for a t between two bounds, given 1 / d."""
    for j in range(3):
        near, far = (boxes[b, j] - p[j]) * inverse[j], (boxes[b, 3 + j] - p[j]) * inverse[j]
        if near > far:
            near, far = far, near
        if near > low:  # a NaN (0 times infinity: the ray lies in the box's side) fails both and cuts nothing
            low = near
        if far < high:
            high = far
    return low <= high * (1.0 + 1e-14) + 1e-300


@kernel
def _crossing(corners: Floats, i: int, p: Floats, d: Floats, axes: Indices) -> tuple[float, float, float]:
    """Cross a line with a triangle, without gaps along shared edges (Woop, Benthin and Wald 2013, section 3).

    Returns
    -------
    The parameter t of ``p + t d`` (infinite where they do not cross), the sign of the crossing (positive where the
    line goes from the back of the triangle to its front) and how far from the triangle's edges it is, as a share.
    """
    kx, ky, kz = axes[0], axes[1], axes[2]
    sx, sy, sz = d[kx] / d[kz], d[ky] / d[kz], 1.0 / d[kz]
    az, bz, cz = corners[i, 0, kz] - p[kz], corners[i, 1, kz] - p[kz], corners[i, 2, kz] - p[kz]
    ax, ay = corners[i, 0, kx] - p[kx] - sx * az, corners[i, 0, ky] - p[ky] - sy * az
    bx, by = corners[i, 1, kx] - p[kx] - sx * bz, corners[i, 1, ky] - p[ky] - sy * bz
    cx, cy = corners[i, 2, kx] - p[kx] - sx * cz, corners[i, 2, ky] - p[ky] - sy * cz
    u, v, w = cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax
    if (u < 0.0 or v < 0.0 or w < 0.0) and (u > 0.0 or v > 0.0 or w > 0.0):
        near = min(abs(u), abs(v), abs(w))
        return math.inf, 0.0, near / (abs(u) + abs(v) + abs(w))
    total = u + v + w
    if total == 0.0:
        return math.inf, 0.0, 1.0
    t = (u * az + v * bz + w * cz) * sz / total
    return t, -math.copysign(1.0, total), min(abs(u), abs(v), abs(w)) / abs(total)


@kernel
def _axes(d: Floats, axes: Indices) -> None:
    """Choose the axes in which a ray is sheared: the longest last, the others in the order that keeps windings."""
    kz = np.argmax(np.abs(d))
    kx, ky = (kz + 1) % 3, (kz + 2) % 3
    if d[kz] < 0.0:
        kx, ky = ky, kx
    axes[0], axes[1], axes[2] = kx, ky, kz


@kernel
def first_hit(
    corners: Floats, boxes: Floats, first: Indices, count: Indices, skin: float, start: Floats, end: Floats
) -> Floats:
    """Give the fraction of each way at which it first goes through a triangle from its front to its back.

    Parameters
    ----------
    corners
        (m, 3, 3) float64, the triangles in the order of the leaves, fronts to the free side.
    boxes, first, count
        The tree, see :func:`build`.
    skin
        A start this far or less past a triangle still counts as before it.
    start, end
        (n, 3) float64.

    Returns
    -------
    (n,) float64 in [0, 1], infinite where a way goes through none.
    """
    out = np.full(start.shape[0], np.inf)
    stack, axes = np.empty(STACK, np.int32), np.empty(3, np.int32)
    for i in range(start.shape[0]):
        p, d = start[i], end[i] - start[i]
        length = math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
        if not length > 0.0:
            continue
        low, best = -skin / length, 1.0
        inverse = 1.0 / d
        _axes(d, axes)
        stack[0], waiting = 0, 1
        while waiting > 0:
            waiting -= 1
            b = stack[waiting]
            if not _in_box(boxes, b, p, inverse, low, best):
                continue
            if count[b] == 0:
                stack[waiting], stack[waiting + 1] = first[b] + 1, first[b]
                waiting += 2
                continue
            for k in range(first[b], first[b] + count[b]):
                t, sign, _ = _crossing(corners, k, p, d, axes)
                if sign < 0.0 and low <= t < best:
                    best = t
                    out[i] = max(t, 0.0)
    return out


@kernel
def _winding(
    corners: Floats, boxes: Floats, first: Indices, count: Indices, p: Floats, d: Floats, stack: Indices, axes: Indices
) -> tuple[int, bool]:
    """Count the crossings of a ray, outward ones less inward ones, and say whether the count is certain."""
    inverse = 1.0 / d
    _axes(d, axes)
    total, certain = 0.0, True
    stack[0], waiting = 0, 1
    while waiting > 0:
        waiting -= 1
        b = stack[waiting]
        if not _in_box(boxes, b, p, inverse, 0.0, np.inf):
            continue
        if count[b] == 0:
            stack[waiting], stack[waiting + 1] = first[b] + 1, first[b]
            waiting += 2
            continue
        for k in range(first[b], first[b] + count[b]):
            t, sign, edge = _crossing(corners, k, p, d, axes)
            if edge < EDGE and t > 0.0:
                certain = False
            if sign != 0.0 and t > 0.0:
                total += sign
    return int(total), certain


@kernel
def windings(
    corners: Floats, boxes: Floats, first: Indices, count: Indices, directions: Floats, points: Floats
) -> NDArray[np.int64]:
    """Give each point's winding number: how often the mesh surrounds it.

    Parameters
    ----------
    corners, boxes, first, count
        The mesh, see :func:`first_hit`, fronts outward.
    directions
        (k, 3) float64, k odd: of rays that are tried in turn until one stays clear of all edges. Where none does, the
        median of their counts is taken.
    points
        (n, 3) float64.

    Returns
    -------
    (n,) int64: 0 outside; 1 inside; more where bodies overlap.
    """
    out = np.zeros(points.shape[0], np.int64)
    stack, axes = np.empty(STACK, np.int32), np.empty(3, np.int32)
    votes = np.empty(directions.shape[0], np.int64)
    for i in range(points.shape[0]):
        p = points[i]
        within = True
        for j in range(3):
            within = within and boxes[0, j] < p[j] < boxes[0, 3 + j]
        if not within:
            continue
        certain = False
        for k in range(directions.shape[0]):
            votes[k], certain = _winding(corners, boxes, first, count, p, directions[k], stack, axes)
            if certain:
                out[i] = votes[k]
                break
        if not certain:
            out[i] = np.sort(votes)[directions.shape[0] // 2]
    return out


@kernel
def _dot(a: Point, b: Point) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def _less(p: Point, q: Point) -> Point:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


@kernel
def _nearest_on(corners: Floats, i: int, p: Point) -> Point:
    """Give the point of a triangle nearest to ``p`` (Ericson 2005, section 5.1.5), folded triangles included."""
    a = (corners[i, 0, 0], corners[i, 0, 1], corners[i, 0, 2])
    b = (corners[i, 1, 0], corners[i, 1, 1], corners[i, 1, 2])
    c = (corners[i, 2, 0], corners[i, 2, 1], corners[i, 2, 2])
    ab, ac = _less(b, a), _less(c, a)
    ap, bp, cp = _less(p, a), _less(p, b), _less(p, c)
    d1, d2 = _dot(ab, ap), _dot(ac, ap)
    if d1 <= 0.0 and d2 <= 0.0:
        return a
    d3, d4 = _dot(ab, bp), _dot(ac, bp)
    if d3 >= 0.0 and d4 <= d3:
        return b
    d5, d6 = _dot(ab, cp), _dot(ac, cp)
    if d6 >= 0.0 and d5 <= d6:
        return c
    vc, vb, va = d1 * d4 - d3 * d2, d5 * d2 - d1 * d6, d3 * d6 - d5 * d4
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        s, t = (d1 / (d1 - d3) if d1 > d3 else 0.0), 0.0
    elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        s, t = 0.0, (d2 / (d2 - d6) if d2 > d6 else 0.0)
    elif va <= 0.0 and d4 >= d3 and d5 >= d6:
        span = (d4 - d3) + (d5 - d6)
        t = (d4 - d3) / span if span > 0.0 else 0.0
        s = 1.0 - t
    elif va + vb + vc > 0.0:
        s, t = vb / (va + vb + vc), vc / (va + vb + vc)
    else:
        s, t = 0.0, 0.0
    return a[0] + s * ab[0] + t * ac[0], a[1] + s * ab[1] + t * ac[1], a[2] + s * ab[2] + t * ac[2]


@kernel
def _away(boxes: Floats, b: int, p: Point) -> float:
    """Give the squared distance of a point from a box."""
    total = 0.0
    for j in range(3):
        gap = max(boxes[b, j] - p[j], 0.0, p[j] - boxes[b, 3 + j])
        total += gap * gap
    return total


@kernel
def nearest(corners: Floats, boxes: Floats, first: Indices, count: Indices, points: Floats) -> tuple[Floats, Indices]:
    """Give the nearest point of the mesh, and its triangle, for each point.

    Parameters
    ----------
    corners, boxes, first, count
        The mesh, see :func:`first_hit`.
    points
        (n, 3) float64.

    Returns
    -------
    (n, 3) float64 and (n,) int32; of equally near triangles the first that is met.
    """
    out = np.empty_like(points)
    which = np.zeros(points.shape[0], np.int32)
    stack = np.empty(STACK, np.int32)
    for i in range(points.shape[0]):
        p, best = (points[i, 0], points[i, 1], points[i, 2]), np.inf
        stack[0], waiting = 0, 1
        while waiting > 0:
            waiting -= 1
            b = stack[waiting]
            if _away(boxes, b, p) >= best:
                continue
            if count[b] == 0:
                near, far = first[b], first[b] + 1
                if _away(boxes, far, p) < _away(boxes, near, p):
                    near, far = far, near
                stack[waiting], stack[waiting + 1] = far, near
                waiting += 2
                continue
            for k in range(first[b], first[b] + count[b]):
                q = _nearest_on(corners, k, p)
                away = _less(q, p)
                distance = _dot(away, away)
                if distance < best:
                    best = distance
                    which[i] = k
                    out[i, 0], out[i, 1], out[i, 2] = q
    return out, which
