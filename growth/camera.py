"""The camera of a picture: a long lens that looks down at the form from one side, z up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

HALF_ANGLE: Final = float(np.tan(np.radians(13.0)))
"""Half the picture's larger side, at distance one."""

FILL: Final = 0.86
"""The share of the picture that the form may take."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """A camera.

    Attributes
    ----------
    eye
        (3,) float64.
    axes
        (3, 3) float64, rows: right, up, towards the viewer.
    size
        Width and height in pixels.
    """

    eye: Floats
    axes: Floats
    size: tuple[int, int]

    @property
    def scale(self) -> float:
        """Pixels that something of length one takes at distance one."""
        return max(self.size) / (2.0 * HALF_ANGLE)

    def rays(self, columns: Floats, rows: Floats) -> Floats:
        """Give unit directions (n, 3) through places of the picture, in pixels from its upper left corner."""
        width, height = self.size
        x, y = (columns - 0.5 * width) / self.scale, (0.5 * height - rows) / self.scale
        ways = x[:, None] * self.axes[0] + y[:, None] * self.axes[1] - self.axes[2]
        return np.asarray(ways / np.linalg.norm(ways, axis=1, keepdims=True))

    def seen(self, points: Floats) -> Floats:
        """Give the places (..., 2) in the picture, in pixels, of points (..., 3) in front of the camera."""
        local = (points - self.eye) @ self.axes.T
        depth = np.maximum(-local[..., 2:], 1e-12)
        width, height = self.size
        flat = local[..., :2] / depth * self.scale
        return np.asarray(flat * [1.0, -1.0] + [0.5 * width, 0.5 * height])


def looking_at(points: Floats, size: tuple[int, int], azimuth: float, elevation: float) -> Camera:
    """Place a camera so that points (n, 3) fill its picture.

    Parameters
    ----------
    points
        What must be seen.
    size
        Width and height in pixels.
    azimuth, elevation
        Where the camera stands, seen from the form, in degrees; azimuth from x towards y.
    """
    a, e = np.radians(azimuth), np.radians(elevation)
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    axes = np.stack([right, np.cross(towards, right), towards])
    local = points @ axes.T
    half = np.array(size) / max(size) * HALF_ANGLE * FILL
    centre = 0.5 * (local.min(axis=0) + local.max(axis=0))
    distance = 1.0
    for _ in range(8):
        offset = local - centre
        distance = float((np.abs(offset[:, :2]) / half + offset[:, 2:]).max())
        distance = max(distance, float(offset[:, 2].max()) + 1e-9, 1e-9)
        flat = offset[:, :2] / np.maximum(distance - offset[:, 2:], 1e-12)
        centre[:2] += 0.5 * (flat.min(axis=0) + flat.max(axis=0)) * distance
    return Camera(centre @ axes + distance * towards, axes, size)
