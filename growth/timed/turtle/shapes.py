"""The shapes of parts that are not carriers: unit cylinder, sphere and disc, polygons and surfaces."""

from __future__ import annotations

import numpy as np

from growth.forms import newell_normals, triangulate
from growth.surface import Surface
from growth.timed.drawing import Shape
from growth.timed.tables import Floats, Ints


def cylinder(sides: int) -> Shape:
    """Give the cylinder of radius 1 from z = 0 to z = 1."""
    ring = _ring(sides)
    vertices = np.concatenate([_lifted(ring, 0.0), _lifted(ring, 1.0), [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])
    triangles = np.concatenate(
        [_band(0, sides, sides), _cap(2 * sides, 0, sides, -1), _cap(2 * sides + 1, sides, sides, 1)]
    )
    return Shape("cylinder", vertices, triangles.astype(np.int32), closed=True)


def sphere(sides: int) -> Shape:
    """Give the sphere of radius 1, of meridians from pole to pole."""
    rows = max(sides // 2, 2)
    ring = _ring(sides)
    slopes = np.pi * np.arange(1, rows) / rows
    belts = [_lifted(ring * np.sin(slope), -np.cos(slope)) for slope in slopes]
    vertices = np.concatenate([*belts, [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]])
    last = sides * (rows - 2)
    triangles = [_band(sides * row, sides * (row + 1), sides) for row in range(rows - 2)]
    triangles += [_cap(sides * (rows - 1), 0, sides, -1), _cap(sides * (rows - 1) + 1, last, sides, 1)]
    return Shape("sphere", vertices, np.concatenate(triangles).astype(np.int32), closed=True)


def disc(inner: float, sides: int) -> Shape:
    """Give the plate of radius 1 from z = -0.5 to z = 0.5, with a round hole of a radius."""
    ring = _ring(sides)
    if inner <= 0.0:
        whole = cylinder(sides)
        return Shape("disc", whole.vertices - [0.0, 0.0, 0.5], whole.triangles, closed=True)
    rings = [_lifted(ring, -0.5), _lifted(ring, 0.5), _lifted(inner * ring, 0.5), _lifted(inner * ring, -0.5)]
    bands = [_band(sides * at, sides * ((at + 1) % 4), sides) for at in range(4)]
    return Shape("disc", np.concatenate(rings), np.concatenate(bands).astype(np.int32), closed=True)


def polygon(corners: Floats) -> Shape | None:
    """Give the polygon of corners (n, 3), or nothing where it has no area.

    Corners that are equal to the one before are one, the first to the last too.
    """
    kept = corners[(corners != np.roll(corners, 1, axis=0)).any(axis=1)]
    if len(kept) < 3:
        return None
    size = float(np.linalg.norm(np.ptp(kept, axis=0)))
    if float(np.linalg.norm(newell_normals(kept))) <= 1e-12 * size * size:
        return None
    count = len(kept)
    ring = np.arange(count, dtype=np.int32)
    none = np.empty((0, 2), dtype=np.int32)
    face = Surface(kept, none, none[:, 0], (), np.array([0, count], dtype=np.int32), ring)
    return Shape("polygon", *triangulate(face), closed=False)


def patch(places: Floats) -> Shape:
    """Give the surface whose places (n, n, 3) are known along u and v."""
    count = places.shape[0]
    at = np.arange(count * count).reshape(count, count)
    a, b, c, d = (part.reshape(-1) for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    triangles = np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)
    return Shape("surface", places.reshape(-1, 3), triangles.astype(np.int32), closed=False)


def _ring(sides: int) -> Floats:
    angles = 2.0 * np.pi * np.arange(sides) / sides
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _lifted(ring: Floats, height: float) -> Floats:
    return np.concatenate([ring, np.full((len(ring), 1), height)], axis=1)


def _band(low: int, high: int, sides: int) -> Ints:
    """Give the triangles between a ring and the next above it."""
    near = np.arange(sides)
    far = (near + 1) % sides
    return np.stack([low + near, low + far, high + far, low + near, high + far, high + near], axis=1).reshape(-1, 3)


def _cap(centre: int, first: int, sides: int, way: int) -> Ints:
    """Give the triangles of a fan that looks up, or down."""
    near = np.arange(sides)
    far = (near + 1) % sides
    ends = (near, far) if way > 0 else (far, near)
    return np.stack([np.full(sides, centre), first + ends[0], first + ends[1]], axis=1)
