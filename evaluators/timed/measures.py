"""What criteria of drawings measure: bounds, areas and volumes of parts in the world."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from growth.timed.drawing import Drawing, Shape
from growth.timed.tables import Floats, Ints


def extents(drawing: Drawing) -> Floats:
    """Give the extents (3,) of all parts along x, y and z; zeros without parts."""
    lows, highs = [], []
    for shape, parts in _by_shape(drawing):
        frames = drawing.frames[parts]
        corners = shape.vertices @ frames[:, :3, :3].transpose(0, 2, 1) + frames[:, None, :3, 3]
        lows.append(corners.min(axis=(0, 1)))
        highs.append(corners.max(axis=(0, 1)))
    if not lows:
        return np.zeros(3)
    return np.asarray(np.max(highs, axis=0) - np.min(lows, axis=0))


def size_of(drawing: Drawing) -> float:
    """Give the largest extent along x, y or z; 0 without parts."""
    return float(extents(drawing).max())


def area_of(drawing: Drawing) -> float:
    """Give the area of all triangles; 0 without parts."""
    return float(sum((areas.sum() for _, _, areas in triangle_areas(drawing)), start=0.0))


def triangle_areas(drawing: Drawing) -> Iterator[tuple[Shape, Ints, Floats]]:
    """Give each shape, its parts (k,), and the areas (k, t) of their triangles in the world.

    A frame maps area vectors by its cofactors, whose columns are cross products of the frame's: so flat frames need no
    inverse.
    """
    for shape, parts in _by_shape(drawing):
        corners = shape.vertices.T[:, shape.triangles.T]
        vectors = 0.5 * _crossed(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        x, y, z = np.moveaxis(drawing.frames[parts, :3, :3], 2, 0)
        cofactors = np.stack([_crossed(y.T, z.T).T, _crossed(z.T, x.T).T, _crossed(x.T, y.T).T], axis=2)
        across = cofactors @ vectors
        yield shape, parts, np.sqrt(np.einsum("kjt,kjt->kt", across, across))


def volume_of(drawing: Drawing) -> float:
    """Add the volumes of the closed parts; what lies in several of them counts several times."""
    total = 0.0
    for shape, parts in _by_shape(drawing):
        if shape.closed:
            corners = (shape.vertices - shape.vertices[0]).T[:, shape.triangles.T]
            own = float(np.einsum("jt,jt->", _crossed(corners[:, 0], corners[:, 1]), corners[:, 2])) / 6.0
            total += float(np.abs(np.linalg.det(drawing.frames[parts, :3, :3]) * own).sum())
    return total


def _crossed(a: Floats, b: Floats) -> Floats:
    """Give the cross products of columns (3, n); NumPy's own takes three times as long."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _by_shape(drawing: Drawing) -> Iterator[tuple[Shape, Ints]]:
    """Give each shape that parts have, with its parts in ascending order."""
    order = np.argsort(drawing.which, kind="stable")
    places, starts = np.unique(drawing.which[order], return_index=True)
    for place, parts in zip(places.tolist(), np.split(order, starts[1:]), strict=bool(len(places))):
        yield drawing.shapes[place], parts
