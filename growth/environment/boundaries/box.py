"""A box."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from genome.settings import Vector3
from growth.environment.boundaries._kernels import BLOCK
from growth.environment.boundaries.convex import Convex, convex, frame_turned
from growth.environment.boundaries.protocol import BoundarySettings

_Length = Annotated[float, Field(gt=0)]


def _as_tuple(value: object) -> object:
    return tuple(value) if isinstance(value, list) else value


class BoxSettings(BoundarySettings):
    """A box by its centre, its lengths along x, y and z, and turns about the fixed x, then y, then z axis (degrees)."""

    shape: Literal["box"]
    at: Vector3
    size: Annotated[tuple[_Length, _Length, _Length], BeforeValidator(_as_tuple)]
    rotation: Vector3 = (0.0, 0.0, 0.0)


def box(settings: BoxSettings) -> Convex:
    """Build a box."""
    x, y, z = settings.size
    return convex(settings, BLOCK, settings.at, frame_turned(settings.rotation), (x / 2, y / 2, z / 2))
