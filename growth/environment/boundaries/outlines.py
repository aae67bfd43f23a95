"""Triangles of the convex shapes in their own frames, for pictures and comparisons."""

from __future__ import annotations

from typing import Final

import numpy as np

from growth.environment.boundaries import _kernels as kernels
from growth.environment.boundaries.protocol import Floats, Triangles

SEGMENTS: Final = 96
"""Sides of a round outline."""


def outline_of(kind: int, size: Floats, extent: float) -> tuple[Floats, Triangles]:
    """Give vertices and triangles, fronts outward; a half-space is a square of side ``2 * extent``."""
    if kind == kernels.BALL:
        angles = np.linspace(0.0, np.pi, SEGMENTS // 2 + 1)
        return _turned_profile(size[0] * np.sin(angles[1:-1]), -size[0] * np.cos(angles[1:-1]), -size[0], size[0])
    if kind == kernels.DRUM:
        return _turned_profile(np.full(2, size[0]), np.array([-size[2], size[2]]), -size[2], size[2])
    if kind == kernels.HALF_SPACE:
        square = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
        return extent * square, np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
    corners = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [part for a, b, c, d in sides for part in ((a, b, c), (a, c, d))]
    return corners * size, np.array(triangles, dtype=np.int32)


def _turned_profile(radii: Floats, heights: Floats, bottom: float, top: float) -> tuple[Floats, Triangles]:
    """Turn a profile about z: rings of ``SEGMENTS`` vertices from the bottom to the top, and a pole at either end."""
    turn = np.linspace(0.0, 2.0 * np.pi, SEGMENTS, endpoint=False)
    x, y = radii[:, None] * np.cos(turn), radii[:, None] * np.sin(turn)
    rings = np.stack([x, y, np.broadcast_to(heights[:, None], x.shape)], axis=2).reshape(-1, 3)
    vertices = np.concatenate([rings, [[0.0, 0.0, bottom], [0.0, 0.0, top]]])
    here = np.arange(SEGMENTS)
    after = (here + 1) % SEGMENTS
    low, high = len(rings), len(rings) + 1
    parts = [np.stack([np.full(SEGMENTS, low), after, here], axis=1)]
    for ring in range(len(radii) - 1):
        a, b = ring * SEGMENTS + here, ring * SEGMENTS + after
        c, d = b + SEGMENTS, a + SEGMENTS
        parts += [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    last = (len(radii) - 1) * SEGMENTS
    parts.append(np.stack([last + here, last + after, np.full(SEGMENTS, high)], axis=1))
    return vertices, np.concatenate(parts).astype(np.int32)
