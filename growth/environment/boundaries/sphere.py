"""A sphere."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from genome.settings import Vector3
from growth.environment.boundaries._kernels import BALL
from growth.environment.boundaries.convex import Convex, convex
from growth.environment.boundaries.protocol import BoundarySettings


class SphereSettings(BoundarySettings):
    """A sphere by its centre and radius."""

    shape: Literal["sphere"]
    at: Vector3
    radius: Annotated[float, Field(gt=0)]


def sphere(settings: SphereSettings) -> Convex:
    """Build a sphere."""
    return convex(settings, BALL, settings.at, np.eye(3), (settings.radius,) * 3)
