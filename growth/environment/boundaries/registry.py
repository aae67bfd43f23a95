"""The shapes that a boundary may have, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from growth.environment.boundaries.box import BoxSettings, box
from growth.environment.boundaries.convex import Convex
from growth.environment.boundaries.cylinder import CylinderSettings, cylinder
from growth.environment.boundaries.plane import PlaneSettings, plane
from growth.environment.boundaries.protocol import BoundarySettings
from growth.environment.boundaries.sphere import SphereSettings, sphere

SHAPES: Mapping[str, tuple[type[BoundarySettings], Callable[[Any], Convex]]] = {
    "box": (BoxSettings, box),
    "cylinder": (CylinderSettings, cylinder),
    "plane": (PlaneSettings, plane),
    "sphere": (SphereSettings, sphere),
}
