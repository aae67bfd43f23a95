"""A cylinder."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator

from genome.settings import Vector3
from growth.environment.boundaries._kernels import DRUM
from growth.environment.boundaries.convex import Convex, convex, frame_along
from growth.environment.boundaries.plane import direction
from growth.environment.boundaries.protocol import BoundarySettings


class CylinderSettings(BoundarySettings):
    """A closed cylinder by its centre (half way up), axis, radius and height."""

    shape: Literal["cylinder"]
    at: Vector3
    axis: Vector3 = (0.0, 0.0, 1.0)
    radius: Annotated[float, Field(gt=0)]
    height: Annotated[float, Field(gt=0)]

    _not_zero = field_validator("axis")(direction)


def cylinder(settings: CylinderSettings) -> Convex:
    """Build a cylinder."""
    size = (settings.radius, settings.radius, settings.height / 2)
    return convex(settings, DRUM, settings.at, frame_along(settings.axis), size)
