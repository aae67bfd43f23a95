"""Compiled loops of the environment: forces, and moves cut short.

The convex shapes and the tree of triangles have theirs in ``boundaries/_kernels.py`` and ``boundaries/_tree.py``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final, TypeVar, cast

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]

F = TypeVar("F", bound=Callable[..., Any])

LEAST_DISTANCE: Final = 0.01
"""Forces of points nearer than this are those at this distance (semantics.md section 1 leaves the figure open)."""


def kernel(function: F) -> F:
    """Compile a function with Numba, kept on disk; strict floating point, one thread."""
    return cast("F", njit(cache=True)(function))


@kernel
def forces(points: Floats, gravity: Floats, sources: Floats) -> Floats:
    """Sum gravity and the pulls of the sources on each point.

    Parameters
    ----------
    points
        (n, 3) float64.
    gravity
        (3,) float64.
    sources
        (k, 5) float64: position, strength (negative: pushes), exponent.

    Returns
    -------
    (n, 3) float64: strength / distance^exponent along the direction to the source (Hemberg 2006, section 4.7).
    A source exactly at a point has no direction and adds nothing.
    """
    out = np.empty_like(points)
    for i in range(points.shape[0]):
        fx, fy, fz = gravity[0], gravity[1], gravity[2]
        for k in range(sources.shape[0]):
            dx = sources[k, 0] - points[i, 0]
            dy = sources[k, 1] - points[i, 1]
            dz = sources[k, 2] - points[i, 2]
            distance = math.sqrt(dx * dx + dy * dy + dz * dz)
            if distance > 0.0:
                size = sources[k, 3] / max(distance, LEAST_DISTANCE) ** sources[k, 4]
                fx += size * (dx / distance)
                fy += size * (dy / distance)
                fz += size * (dz / distance)
        out[i, 0] = fx
        out[i, 1] = fy
        out[i, 2] = fz
    return out


@kernel
def backed_off(start: Floats, end: Floats, hits: Floats, skin: float, fractions: Floats) -> None:
    """Lower each way's fraction to a skin before its hit.

    Parameters
    ----------
    start, end
        (n, 3) float64, where each way begins and ends.
    hits
        (n,) float64, the fraction of the way at which a boundary is met; infinite where none is.
    skin
        The distance kept before it.
    fractions
        (n,) float64, lowered in place; infinite where nothing has been met.
    """
    for i in range(hits.shape[0]):
        if hits[i] <= 1.0:
            dx = end[i, 0] - start[i, 0]
            dy = end[i, 1] - start[i, 1]
            dz = end[i, 2] - start[i, 2]
            length = math.sqrt(dx * dx + dy * dy + dz * dz)
            fraction = 0.0
            if length > 0.0 and hits[i] * length > 1.001 * skin:  # nearer is at rest: rounding must not make it creep
                fraction = max(0.0, hits[i] - skin / length)
            fractions[i] = min(fractions[i], fraction)


@kernel
def cut_short(start: Floats, end: Floats, fractions: Floats) -> Floats:
    """Give the points at a fraction of their way: the end exactly where it is infinite, the start exactly at zero."""
    out = end.copy()
    for i in range(fractions.shape[0]):
        if fractions[i] <= 1.0:
            for j in range(3):
                out[i, j] = start[i, j] + fractions[i] * (end[i, j] - start[i, j])
    return out
