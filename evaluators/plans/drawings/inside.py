"""Whether points lie in polygons, and where words fit best."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from evaluators.plans.drawings.drawing import Label, Point, Ring

Floats = NDArray[np.float64]

ACROSS: Final = 9
"""Places that are tried for words across the longer side of a room's box, times two, less one."""
LARGEST: Final = 0.28
SMALLEST: Final = 0.04
"""Heights of letters in metres for cells of a metre."""
LETTER: Final = 0.68
LINES: Final = 2.7
"""The width of a letter and the height of two lines, in heights of letters."""
BETTER: Final = 1.25
"""How much larger upright words must be to be preferred."""


def inside(points: Floats, ring: Ring) -> NDArray[np.bool_]:
    """Tell which of points (n, 2) lie in a polygon."""
    found = np.zeros(len(points), dtype=bool)
    x, y = points[:, 0], points[:, 1]
    for (ax, ay), (bx, by) in zip(ring, (*ring[1:], ring[0]), strict=True):
        if ay != by:
            found ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) * (bx - ax) / (by - ay))
    return found


def label(words: Sequence[str], ring: Ring, obstacles: Sequence[Floats], unit: float) -> Label:
    """Find where words of some lines fit largest in a polygon.

    Parameters
    ----------
    words
        The lines.
    ring
        The room's floor.
    obstacles
        (n, 2) points that the words should not cover, such as a door's swing.
    unit
        The length of a cell's edge, in metres.
    """
    points = np.array(ring)
    low, high = points.min(axis=0), points.max(axis=0)
    step = max(float((high - low).max()) / (2 * ACROSS - 1), 1e-9)
    places = np.stack(
        np.meshgrid(*(np.arange(a + step / 2, b, step / 2) for a, b in zip(low, high, strict=True))), axis=-1
    )
    middle = points.mean(axis=0)
    spots = np.concatenate([places.reshape(-1, 2), middle[None]])
    spots = spots[inside(spots, ring)]
    rim = _along(ring, step / 6)
    wide = max(LETTER * max(map(len, words)), 1.0)
    found: list[tuple[float, float, Point, bool]] = []
    for barred in ([rim, *obstacles], [rim]):
        for upright in (False, True):
            box = np.array([LINES, wide] if upright else [wide, LINES])
            apart = np.abs(spots[:, None, :] - np.concatenate(barred)[None, :, :]) / (box / 2)
            sizes = apart.max(axis=2).min(axis=1)
            size = np.minimum(sizes, LARGEST * unit).round(6)
            near = np.hypot(*(spots - middle).T).round(6)
            best = int(np.lexsort((near, -sizes.round(2), -size))[0])
            found.append(
                (
                    float(size[best]) / (BETTER if upright else 1.0),
                    float(size[best]),
                    tuple(spots[best].tolist()),
                    upright,
                )
            )
        if max(found)[0] >= LARGEST * unit / 3:
            break
    _, size, at, upright = max(found, key=lambda one: one[0])
    return Label(at, max(size, SMALLEST * unit), upright)


def _along(ring: Ring, step: float) -> Floats:
    """Give points along a polygon's sides."""
    parts = []
    for a, b in zip(ring, (*ring[1:], ring[0]), strict=True):
        count = max(int(np.hypot(b[0] - a[0], b[1] - a[1]) / step), 1) + 1
        parts.append(np.linspace(a, b, count))
    return np.concatenate(parts)
