"""Whether points lie in polygons, and where words fit best."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from evaluators.plans.drawings.drawing import Label, Ring

Floats = NDArray[np.float64]

PLACES: Final = 25
"""That are tried for words across the longer side of a room's box."""
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
    step = float((high - low).max()) / PLACES
    grid = np.meshgrid(*(np.arange(a + step / 2, b, step) for a, b in zip(low, high, strict=True)))
    middle = points.mean(axis=0)
    spots = np.concatenate([np.stack(grid, axis=-1).reshape(-1, 2), middle[None]])
    spots = spots[inside(spots, ring)]
    rim = _along(ring, step / 3)
    wide = LETTER * max(map(len, words))
    found: list[tuple[float, Label]] = []
    for barred in ([rim, *obstacles], [rim]):
        rim_x, rim_y = np.concatenate(barred).T
        across, up = np.abs(spots[:, :1] - rim_x), np.abs(spots[:, 1:] - rim_y)
        for upright in (False, True):
            x, y = (LINES, wide) if upright else (wide, LINES)
            free = np.maximum(across / (x / 2), up / (y / 2)).min(axis=1).round(6)
            sizes = np.minimum(free, LARGEST * unit)
            best = int(np.lexsort((np.hypot(*(spots - middle).T).round(6), -free, -sizes))[0])
            one = Label((float(spots[best, 0]), float(spots[best, 1])), float(sizes[best]), upright)
            found.append((one.size / BETTER if upright else one.size, one))
        if max(size for size, _ in found) >= LARGEST * unit / 3:
            break
    one = max(found, key=lambda row: row[0])[1]
    return one._replace(size=max(one.size, SMALLEST * unit))


def _along(ring: Ring, step: float) -> Floats:
    """Give points along a polygon's sides."""
    parts = []
    for a, b in zip(ring, (*ring[1:], ring[0]), strict=True):
        count = max(int(np.hypot(b[0] - a[0], b[1] - a[1]) / step), 1) + 1
        parts.append(np.linspace(a, b, count))
    return np.concatenate(parts)
