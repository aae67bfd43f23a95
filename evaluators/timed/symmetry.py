"""Symmetry: how nearly a form is its own mirror image in an upright plane."""

from __future__ import annotations

from typing import Final

import numpy as np

from evaluators.timed.measures import triangle_areas
from evaluators.timed.steadiness import LEAST
from evaluators.timed.unfolding import Unfolding
from growth.timed.drawing import Drawing
from growth.timed.tables import Floats, Ints

SECTORS: Final = 72
"""How many sectors a turn has, at least: a cell is 5 degrees wide."""

RINGS: Final = 8
LEVELS: Final = 12
BLUR: Final = 2.0
"""How far an area reaches along its ring, to either side, in widths of a ring: as far wherever it is."""

FOLDS: Final = 8
"""Symmetries of up to so many planes are found whichever way they stand; others to half a sector."""


def symmetry(unfolding: Unfolding) -> float:
    """Give the best overlap of a form and its mirror image at the last time, over upright planes through its middle.

    The area of each triangle goes to its corners in equal parts, and from there into cells of a cylinder around the
    upright line through the area's mean: sectors, rings and levels. A plane through that line maps sectors onto
    sectors. The overlap is the smaller of a cell's area and its image's, summed, over the larger of them, summed.
    Where a corner lies between the middles of cells, they share it: a small change of the form is a small change of its
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
        areas.append(np.bincount(slots.reshape(-1), shares.reshape(-1), len(parts) * count).astype(np.float64))
    return np.concatenate(points), np.concatenate(areas)


def _main_direction(x: Floats, y: Floats, weights: Floats) -> tuple[int, float]:
    """Give the fold of a form's strongest angular moment, and the angle at which it points.

    A mirror plane of the form stands at that angle, or at a multiple of half a turn over the fold from it. What is
    round points along x.
    """
    places = x + 1j * y
    units = places / np.maximum(np.abs(places), 1e-300)
    moments = np.array([(weights * units**fold).sum() for fold in range(1, FOLDS + 1)])
    strongest = int(np.argmax(np.abs(moments)))
    if np.abs(moments[strongest]) <= LEAST * float(weights.sum()):
        return 1, 0.0
    return strongest + 1, float(np.angle(moments[strongest])) / (strongest + 1)


def _cells(angles: Floats, radii: Floats, heights: Floats, areas: Floats, sectors: int) -> Floats:
    """Share areas out among cells (sectors, rings + 2, levels + 2); the innermost ring has no sectors.

    A place goes to the two nearest middles along each axis, the nearer getting more. One on the upright line has no
    angle: what goes to the innermost ring is spread over all sectors.
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
    return _blurred(cells)


def _blurred(cells: Floats) -> Floats:
    """Spread areas along the rings (the second axis), most where they are, so that cells far in are no narrower."""
    sectors, rings, _ = cells.shape
    waves = np.fft.rfft(cells, axis=0)
    reach = BLUR / np.arange(1, rings)  # radians, at most a third of a turn
    numbers = np.arange(len(waves))[:, None]
    waves[:, 1:] *= (np.sinc(numbers * reach / (2.0 * np.pi)) ** 2)[:, :, None]
    return np.maximum(np.fft.irfft(waves, sectors, axis=0), 0.0)
