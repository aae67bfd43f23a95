"""Compiled loops of the convex shapes, in closed form, each in the frame of its shape.

A shape is an open convex set in its own frame: a ball about the origin, the half-space below z = 0, a block
about the origin, or an upright drum about the origin. A line runs through such a set between two parameters, from
which follows where it enters (the set is solid) or leaves (everything but the set is solid).
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from growth.environment._kernels import kernel

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Span = tuple[float, float]
Point = tuple[float, float, float]

BALL: Final = 0
HALF_SPACE: Final = 1
BLOCK: Final = 2
DRUM: Final = 3


@kernel
def _slab(p: float, d: float, half: float) -> Span:
    """Give the span of a line within ``-half < x < half``."""
    if d == 0.0:
        return (-math.inf, math.inf) if abs(p) < half else (math.inf, -math.inf)
    low, high = (-half - p) / d, (half - p) / d
    return (low, high) if d > 0.0 else (high, low)


@kernel
def _round(pp: float, pd: float, dd: float, miss: float, radius: float) -> Span:
    """Give the span of a line within a radius of the origin, from its dot products and squared least distance.

    The near root is taken from the product of the roots, so that a start on the surface gives exactly zero.
    """
    if dd == 0.0:
        return (-math.inf, math.inf) if pp < radius else (math.inf, -math.inf)
    if miss >= radius * radius:
        return (math.inf, -math.inf)
    reach = math.sqrt((radius * radius - miss) * dd)
    if reach == 0.0:
        return (math.inf, -math.inf)
    c = (pp - radius) * (pp + radius)
    if pd < 0.0:
        return c / (reach - pd), (reach - pd) / dd
    return (-pd - reach) / dd, -c / (pd + reach)


@kernel
def _span(kind: int, size: Floats, p: Point, d: Point) -> Span:
    """Give the parameters between which ``p + t d`` is in the shape; the first above the second where never."""
    if kind == BALL:
        dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
        pd = p[0] * d[0] + p[1] * d[1] + p[2] * d[2]
        pp = math.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])
        s = -pd / dd if dd > 0.0 else 0.0
        x, y, z = p[0] + s * d[0], p[1] + s * d[1], p[2] + s * d[2]
        return _round(pp, pd, dd, x * x + y * y + z * z, size[0])
    if kind == HALF_SPACE:
        if d[2] == 0.0:
            return (-math.inf, math.inf) if p[2] < 0.0 else (math.inf, -math.inf)
        t = -p[2] / d[2]
        return (t, math.inf) if d[2] < 0.0 else (-math.inf, t)
    if kind == BLOCK:
        a = _slab(p[0], d[0], size[0])
        b = _slab(p[1], d[1], size[1])
        c = _slab(p[2], d[2], size[2])
        return max(a[0], b[0], c[0]), min(a[1], b[1], c[1])
    dd = d[0] * d[0] + d[1] * d[1]
    pd = p[0] * d[0] + p[1] * d[1]
    pp = math.sqrt(p[0] * p[0] + p[1] * p[1])
    s = -pd / dd if dd > 0.0 else 0.0
    x, y = p[0] + s * d[0], p[1] + s * d[1]
    a = _round(pp, pd, dd, x * x + y * y, size[0])
    b = _slab(p[2], d[2], size[2])
    return max(a[0], b[0]), min(a[1], b[1])


@kernel
def _turned(frame: Floats, x: float, y: float, z: float) -> Point:
    return (
        frame[0, 0] * x + frame[0, 1] * y + frame[0, 2] * z,
        frame[1, 0] * x + frame[1, 1] * y + frame[1, 2] * z,
        frame[2, 0] * x + frame[2, 1] * y + frame[2, 2] * z,
    )


@kernel
def first_hit(
    kind: int, centre: Floats, frame: Floats, size: Floats, outside: bool, skin: float, start: Floats, end: Floats
) -> Floats:
    """Give the fraction of each way at which it enters the solid part.

    Parameters
    ----------
    kind, centre, frame, size
        The shape: its kind, (3,) centre, (3, 3) frame (rows are its axes) and (3,) measures.
    outside
        Whether the solid part is all that is outside the shape.
    skin
        A start this far or less past the surface still counts as before it.
    start, end
        (n, 3) float64.

    Returns
    -------
    (n,) float64 in [0, 1], infinite where the way does not enter the solid part.
    """
    out = np.full(start.shape[0], np.inf)
    for i in range(start.shape[0]):
        vx, vy, vz = end[i, 0] - start[i, 0], end[i, 1] - start[i, 1], end[i, 2] - start[i, 2]
        p = _turned(frame, start[i, 0] - centre[0], start[i, 1] - centre[1], start[i, 2] - centre[2])
        d = _turned(frame, vx, vy, vz)
        length = math.sqrt(vx * vx + vy * vy + vz * vz)
        if not length > 0.0:
            continue
        enter, leave = _span(kind, size, p, d)
        if not enter < leave:
            continue
        back = -skin / length
        if outside:
            if back <= leave < 1.0:
                out[i] = max(leave, 0.0)
        elif leave > 0.0 and back <= enter < 1.0:
            out[i] = max(enter, 0.0)
    return out


@kernel
def inside(kind: int, centre: Floats, frame: Floats, size: Floats, outside: bool, points: Floats) -> Flags:
    """Say of each point (n, 3) whether it is in the solid part; a point on the surface is not."""
    out = np.empty(points.shape[0], np.bool_)
    for i in range(points.shape[0]):
        x, y, z = _turned(frame, points[i, 0] - centre[0], points[i, 1] - centre[1], points[i, 2] - centre[2])
        sign = -1.0 if outside else 1.0
        if kind == BALL:
            depth = size[0] - math.sqrt(x * x + y * y + z * z)
        elif kind == HALF_SPACE:
            depth = -z
        elif kind == BLOCK:
            depth = min(size[0] - abs(x), size[1] - abs(y), size[2] - abs(z))
        else:
            depth = min(size[0] - math.sqrt(x * x + y * y), size[2] - abs(z))
        out[i] = sign * depth > 0.0
    return out


@kernel
def _pushed_out(kind: int, size: Floats, x: float, y: float, z: float, gap: float) -> Point:
    """Give the point of the shape's surface nearest to a point in it, a gap further out; ties go up."""
    if kind == BALL:
        r = math.sqrt(x * x + y * y + z * z)
        if r == 0.0:
            return 0.0, 0.0, size[0] + gap
        s = (size[0] + gap) / r
        return x * s, y * s, z * s
    if kind == HALF_SPACE:
        return x, y, gap
    up = size[2] - abs(z)
    top = math.copysign(size[2] + gap, z)
    if kind == BLOCK:
        along, across = size[0] - abs(x), size[1] - abs(y)
        if up <= along and up <= across:
            return x, y, top
        if along <= across:
            return math.copysign(size[0] + gap, x), y, z
        return x, math.copysign(size[1] + gap, y), z
    r = math.sqrt(x * x + y * y)
    if up <= size[0] - r:
        return x, y, top
    if r == 0.0:
        return size[0] + gap, 0.0, z
    s = (size[0] + gap) / r
    return x * s, y * s, z


@kernel
def _pulled_in(kind: int, size: Floats, x: float, y: float, z: float, gap: float) -> Point:
    """Give the point of the shape nearest to a point outside it, a gap within its surface."""
    if kind == BALL:
        s = min(1.0, (size[0] - gap) / math.sqrt(x * x + y * y + z * z))
        return x * s, y * s, z * s
    if kind == HALF_SPACE:
        return x, y, -gap
    w = size[2] - gap
    z = min(max(z, -w), w)
    if kind == BLOCK:
        u, v = size[0] - gap, size[1] - gap
        return min(max(x, -u), u), min(max(y, -v), v), z
    r = math.sqrt(x * x + y * y)
    if r > size[0] - gap:
        return x * ((size[0] - gap) / r), y * ((size[0] - gap) / r), z
    return x, y, z


@kernel
def nearest_free(
    kind: int, centre: Floats, frame: Floats, size: Floats, outside: bool, gap: float, points: Floats
) -> Floats:
    """Move points (n, 3) of the solid part to the nearest place outside it, a gap off its surface."""
    out = np.empty_like(points)
    for i in range(points.shape[0]):
        p = _turned(frame, points[i, 0] - centre[0], points[i, 1] - centre[1], points[i, 2] - centre[2])
        q = _pulled_in(kind, size, p[0], p[1], p[2], gap) if outside else _pushed_out(kind, size, p[0], p[1], p[2], gap)
        for j in range(3):
            out[i, j] = centre[j] + frame[0, j] * q[0] + frame[1, j] * q[1] + frame[2, j] * q[2]
    return out
