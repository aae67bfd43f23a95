"""Symmetry: how nearly a form is its own mirror image in an upright plane."""

from __future__ import annotations

from typing import Final

import numpy as np

from evaluators.timed.measures import triangle_areas
from evaluators.timed.unfolding import Unfolding
from growth.timed.drawing import Drawing
from growth.timed.tables import Floats, Ints

SECTORS: Final = 72
"""How many sectors a turn has, at least: a cell is 5 degrees wide."""

RINGS: Final = 8
LEVELS: Final = 12
FOLDS: Final = 8
"""Symmetries of up to so many planes are found whichever way they stand; others to half a sector."""


def symmetry(unfolding: Unfolding) -> float:
    """Give the best overlap of a form and its mirror image at the last time, over all upright planes through its middle.

    The area of each triangle goes to its corners in equal parts, and from there into cells of a cylinder around the
    upright line through the area's mean: sectors, rings and levels. A plane through that line maps sectors onto sectors.
    The overlap is the smaller of a cell's area and its image's, summed, over the larger of them, summed. Where a
    corner lies between the middles of cells, they share it, so that a small change of the form is a small change of its
    symmetry.

    Returns
    -------
    float
        Above 0, at most 1: 1 for a form with such a plane, and for one without area. A single leaning cylinder, too.
    """
    points, areas = _weighed(unfolding.form)
    total = float(areas.sum())
    if total <= 0.0:
        return 1.0
    middle = (areas @ points) / total
    x, y, z = (points - middle).T
    radii = np.hypot(x, y)
    fold, phase = _main_direction(x, y, radii * areas)
    sectors = fold * -(-SECTORS // fold)
    cells = _cells(np.arctan2(y, x) - phase, radii, z, areas, sectors)
    at = np.arange(sectors)
    both = max(float(np.minimum(cells, cells[(turn - at) % sectors]).sum()) for turn in range(sectors))
    return both / (2.0 * float(cells.sum()) - both)


def _weighed(drawing: Drawing) -> tuple[Floats, Floats]:
    """Give the corners (n, 3) of all parts, and the area (n,) that each has."""
    points, areas = [np.empty((0, 3))], [np.empty(0)]
    for shape, parts, own in triangle_areas(drawing):
        frames = drawing.frames[parts]
        places = shape.vertices @ frames[:, :3, :3].transpose(0, 2, 1) + frames[:, None, :3, 3]
        count = len(shape.vertices)
        slots = np.arange(len(parts))[:, None, None] * count + shape.triangles
        shares = np.broadcast_to(own[:, :, None] / 3.0, slots.shape)
        points.append(places.reshape(-1, 3))
        areas.append(np.bincount(slots.reshape(-1), shares.reshape(-1), minlength=len(parts) * count))
    return np.concatenate(points), np.concatenate(areas)


def _main_direction(x: Floats, y: Floats, weights: Floats) -> tuple[int, float]:
    """Give the fold of a form's strongest angular moment, and the angle at which it points.

    A mirror plane of the form stands at that angle, or at a multiple of half a turn over the fold from it.
    """
    places = x + 1j * y
    units = places / np.maximum(np.abs(places), 1e-300)
    moments = np.array([(weights * units**fold).sum() for fold in range(1, FOLDS + 1)])
    strongest = int(np.argmax(np.abs(moments)))
    return strongest + 1, float(np.angle(moments[strongest])) / (strongest + 1)


def _cells(angles: Floats, radii: Floats, heights: Floats, areas: Floats, sectors: int) -> Floats:
    """Share areas out among cells (sectors, rings + 2, levels + 2); the innermost ring has no sectors.

    A place goes to the two nearest middles along each axis, the nearer getting more. One on the upright line has no angle:
    what goes to the innermost ring is spread over all sectors.
    """
    steps = (sectors / (2.0 * np.pi), RINGS / max(float(radii.max()), 1e-300),
             LEVELS / max(float(np.ptp(heights)), 1e-300))  # fmt: skip
    across = [np.mod(angles * steps[0], sectors), radii * steps[1], (heights - heights.min()) * steps[2]]
    lows = [np.floor(place).astype(np.int64) for place in across]
    shape = (sectors, RINGS + 2, LEVELS + 2)
    cells = np.zeros(shape)
    for corner in np.ndindex(2, 2, 2):
        share = areas.copy()
        at: list[Ints] = []
        for place, low, up in zip(across, lows, corner, strict=True):
            share *= (place - low) if up else (1.0 - (place - low))
            at.append(low + up)
        slots = np.ravel_multi_index((at[0] % sectors, at[1], at[2]), shape)
        cells += np.bincount(slots, share, minlength=cells.size).reshape(shape)
    cells[:, 0] = cells[:, 0].mean(axis=0)
    return cells
