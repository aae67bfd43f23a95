"""Bringing points out of all solids at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from growth.environment.boundaries.directions import spiral
from growth.environment.boundaries.protocol import Boundary, Flags, Floats

ROUNDS: Final = 24
"""How often every boundary may push; from the fourth round on each push goes twice as far beyond the surface."""

DIRECTIONS: Final = 128
SHELLS: Final = 32


def inside_any(boundaries: Sequence[Boundary], points: Floats) -> Flags:
    """Say of each point (n, 3) whether it is within any of the solids."""
    within = np.zeros(len(points), dtype=np.bool_)
    for boundary in boundaries:
        within |= boundary.inside(points)
    return within


def released(boundaries: Sequence[Boundary], points: Floats) -> Floats | None:
    """Move the points that are in a solid to a free place near them.

    In one solid that is the nearest free place. Where solids overlap the boundaries push in turn, and a point that
    they push back and forth goes to the nearest free one among places in fixed directions around it.

    Parameters
    ----------
    boundaries
        The hard ones.
    points
        (n, 3) float64.

    Returns
    -------
    (n, 3) float64, points that were free unchanged; None where a point finds no free place.
    """
    out = points.copy()
    for number in range(ROUNDS):
        clearance = 2.0 ** max(0, number - 3)
        moved = False
        for boundary in boundaries:
            within = np.flatnonzero(boundary.inside(out))
            if len(within):
                out[within] = boundary.nearest_free(out[within], clearance)
                moved = True
        if not moved:
            return out
    for index in np.flatnonzero(inside_any(boundaries, out)):
        place = _searched(boundaries, points[index])
        if place is None:
            return None
        out[index] = place
    return out


def _searched(boundaries: Sequence[Boundary], point: Floats) -> Floats | None:
    """Find a free place around a point: on growing shells first, then back towards the point by halving."""
    reach = max(_reach(boundary, point) for boundary in boundaries)
    least = max(boundary.skin for boundary in boundaries)
    directions = spiral(DIRECTIONS)
    for radius in np.geomspace(least, max(4.0 * reach, 4.0 * least), SHELLS):
        candidates = np.ascontiguousarray(point + radius * directions)
        free = np.flatnonzero(~inside_any(boundaries, candidates))
        if len(free):
            return _drawn_back(boundaries, point, candidates[free[0]])
    return None


def _drawn_back(boundaries: Sequence[Boundary], point: Floats, place: Floats) -> Floats:
    solid, free = 0.0, 1.0
    for _ in range(20):
        middle = 0.5 * (solid + free)
        if inside_any(boundaries, (point + middle * (place - point))[None, :])[0]:
            solid = middle
        else:
            free = middle
    return place if free == 1.0 else np.asarray(point + free * (place - point))


def _reach(boundary: Boundary, point: Floats) -> float:
    vertices, _ = boundary.outline(1.0)
    return float(np.abs(vertices - point).max())
