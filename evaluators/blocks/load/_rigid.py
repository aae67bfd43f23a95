"""Compiled loops of the model ``rigid``."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


@njit(cache=True)
def _turn(
    a: float, b: float, c: float, d: float, e: float, f: float, mx: float, my: float
) -> tuple[float, float, float]:
    """Solve [[a, d, e], [d, b, f], [e, f, c]] turn = (mx, my, 0), a positive definite matrix, by L D L^T."""
    l21, l31 = d / a, e / a
    d2 = b - l21 * d
    l32 = (f - l31 * d) / d2
    d3 = c - l31 * e - l32 * l32 * d2
    y2 = my - l21 * mx
    y3 = -l31 * mx - l32 * y2
    tz = y3 / d3
    ty = y2 / d2 - l32 * tz
    return mx / a - l21 * ty - l31 * tz, ty, tz


@njit(cache=True)
def _middle(points: Floats, stiffness: Floats, members: Ints) -> tuple[float, float, float, float]:
    """Give the sum of the joints' stiffnesses, and their centre of stiffness."""
    k = x = y = z = 0.0
    for j in members:
        s = stiffness[j]
        k += s
        x += s * points[j, 0]
        y += s * points[j, 1]
        z += s * points[j, 2]
    return k, x / k, y / k, z / k


@njit(cache=True)
def rigid(
    points: Floats, stiffness: Floats, turning: float, first: Ints, order: Ints, weights: Floats, centres: Floats
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
    first, order
        (p + 1,) and (c,) int64: part p stands on the joints ``order[first[p] : first[p + 1]]``.
    weights, centres
        (p,) float64 and (p, 3) float64, of each part.

    Returns
    -------
    forces, moments : (j, 3) float64
        What is above each joint does this to what is below; zeros at joints of no part.
    """
    forces, moments = np.zeros_like(points), np.zeros_like(points)
    for p in range(weights.size):
        members = order[first[p] : first[p + 1]]
        k, cx, cy, cz = _middle(points, stiffness, members)
        a = b = c = turning * k
        d = e = f = 0.0
        for j in members:
            s, x, y, z = stiffness[j], points[j, 0] - cx, points[j, 1] - cy, points[j, 2] - cz
            a += s * (y * y + z * z)
            b += s * (x * x + z * z)
            c += s * (x * x + y * y)
            d -= s * x * y
            e -= s * x * z
            f -= s * y * z
        # the moment of the weight (0, 0, -w) about the centre of stiffness has no vertical part
        mx, my = -(centres[p, 1] - cy) * weights[p], (centres[p, 0] - cx) * weights[p]
        tx, ty, tz = _turn(a, b, c, d, e, f, mx, my)
        for j in members:
            s, x, y, z = stiffness[j], points[j, 0] - cx, points[j, 1] - cy, points[j, 2] - cz
            forces[j, 0] = s * (ty * z - tz * y)
            forces[j, 1] = s * (tz * x - tx * z)
            forces[j, 2] = s * (tx * y - ty * x) - s / k * weights[p]
            moments[j, 0] = s * turning * tx
            moments[j, 1] = s * turning * ty
            moments[j, 2] = s * turning * tz
    return forces, moments
