"""Compiling the environment's kernels ahead of time."""

from __future__ import annotations

import numpy as np

from growth.environment.boundaries import _kernels as kernels
from growth.environment.boundaries.convex import convex
from growth.environment.boundaries.mesh import closed_mesh
from growth.environment.boundaries.protocol import BoundarySettings
from growth.environment.environment import Environment


def compile_kernels() -> None:
    """Compile every kernel once, so that the cache on disk holds it before a run's clock starts."""
    settings = BoundarySettings()
    block = convex(settings, kernels.BLOCK, (0.0, 0.0, 0.0), np.eye(3), (1.0, 1.0, 1.0))
    body = closed_mesh(*block.outline(1.0), settings)
    gravity, sources = np.array([0.0, 0.0, -1.0]), np.ones((1, 5))
    environment = Environment({}, "", (), gravity, sources, (block, body), (body,))
    start = np.array([[0.1, 0.2, 3.0], [0.1, 0.2, 0.3]])
    environment.move(start, start + environment.forces(start) * 3.0)
    environment.release(start)
    body.nearest_free(start)
    environment.wrong_side(start)
