"""A plane."""

from __future__ import annotations

from typing import Literal

from pydantic import field_validator

from genome.settings import Vector3
from growth.environment.boundaries._kernels import HALF_SPACE
from growth.environment.boundaries.convex import Convex, convex, frame_along
from growth.environment.boundaries.protocol import BoundarySettings


def direction(value: Vector3) -> Vector3:
    """Refuse the zero vector as a direction."""
    if not any(value):
        raise ValueError("a direction that is not zero")
    return value


class PlaneSettings(BoundarySettings):
    """A plane by one of its points and its normal; ``inside`` is the half-space behind the normal."""

    shape: Literal["plane"]
    at: Vector3
    normal: Vector3 = (0.0, 0.0, 1.0)

    _not_zero = field_validator("normal")(direction)


def plane(settings: PlaneSettings) -> Convex:
    """Build a plane."""
    return convex(settings, HALF_SPACE, settings.at, frame_along(settings.normal), (1.0, 1.0, 1.0))
