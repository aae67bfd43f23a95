"""The convex shapes' common body: exact answers in closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from growth.environment.boundaries import _kernels as kernels
from growth.environment.boundaries.outlines import outline_of
from growth.environment.boundaries.protocol import BoundarySettings, Flags, Floats, Triangles, skin_for


@final
@dataclass(frozen=True, slots=True, eq=False)
class Convex:
    """A ball, half-space, block or drum, of which the inside or the outside is solid.

    Attributes
    ----------
    kind
        One of the kinds in ``_kernels.py``.
    centre
        (3,) float64.
    frame
        (3, 3) float64, rows are the shape's own axes.
    size
        (3,) float64, the kind's measures.
    outside
        Whether the solid side is outside the shape.
    soft, skin
        See :class:`~growth.environment.boundaries.protocol.Boundary`.
    """

    kind: int
    centre: Floats
    frame: Floats
    size: Floats
    outside: bool
    soft: bool
    skin: float

    def first_hit(self, start: Floats, end: Floats) -> Floats:
        """Give the fraction of each way at which it enters the solid side."""
        return kernels.first_hit(self.kind, self.centre, self.frame, self.size, self.outside, self.skin, start, end)

    def inside(self, points: Floats) -> Flags:
        """Say of each point whether it is within the solid side."""
        return kernels.inside(self.kind, self.centre, self.frame, self.size, self.outside, points)

    def nearest_free(self, points: Floats, clearance: float = 1.0) -> Floats:
        """Move points of the solid side to the nearest of the free side."""
        gap = self.skin * clearance
        if self.outside and self.kind != kernels.HALF_SPACE:
            gap = min(gap, 0.5 * float(self.size.min()))
        return kernels.nearest_free(self.kind, self.centre, self.frame, self.size, self.outside, gap, points)

    def outline(self, extent: float) -> tuple[Floats, Triangles]:
        """Give the shape's triangles; a half-space as a square of its plane."""
        vertices, triangles = outline_of(self.kind, self.size, extent)
        return np.ascontiguousarray(vertices @ self.frame + self.centre), triangles


def convex(
    settings: BoundarySettings, kind: int, at: Sequence[float], frame: NDArray[np.float64], size: Sequence[float]
) -> Convex:
    """Build a convex boundary from its place, frame and measures."""
    centre = np.array(at, dtype=np.float64)
    measures = np.array(size, dtype=np.float64)
    least, most = (1.0, 1.0) if kind == kernels.HALF_SPACE else (float(measures.min()), float(measures.max()))
    skin = skin_for(least, float(np.abs(centre).max()) + most)
    return Convex(kind, centre, np.ascontiguousarray(frame), measures, settings.solid == "outside", settings.soft, skin)


def frame_along(axis: Sequence[float]) -> Floats:
    """Give a frame (3, 3) whose third row is along ``axis``; the identity for the z axis."""
    z = np.array(axis, dtype=np.float64)
    z = z / np.abs(z).max()  # first, so that no square underflows
    z = z / np.linalg.norm(z)
    if np.hypot(z[0], z[1]) < 1e-150:
        return np.diag([1.0, np.sign(z[2]), np.sign(z[2])])
    x = np.cross([0.0, 0.0, 1.0], z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


def frame_turned(rotation: Sequence[float]) -> Floats:
    """Give the frame (3, 3) of a body turned about the fixed x, then y, then z axis, in degrees."""
    (cx, sx), (cy, sy), (cz, sz) = (_cos_sin(angle) for angle in rotation)
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
    about_y = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    about_z = np.array([[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]])
    return np.ascontiguousarray((about_z @ about_y @ about_x).T)


def _cos_sin(degrees: float) -> tuple[float, float]:
    """Give cosine and sine, exact at the quarter turns."""
    quarters, rest = divmod(degrees, 90.0)
    if rest == 0.0:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarters % 4)]
    angle = math.radians(degrees)
    return math.cos(angle), math.sin(angle)
