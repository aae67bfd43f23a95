"""Directions spread over the sphere."""

from __future__ import annotations

import numpy as np

from growth.environment.boundaries.protocol import Floats


def spiral(count: int) -> Floats:
    """Give ``count`` unit vectors (count, 3) spread evenly over the sphere on a spiral, the first of them upward."""
    index = np.arange(count)
    z = 1.0 - 2.0 * index / (count - 1)
    turn = index * np.pi * (3.0 - np.sqrt(5.0))
    radius = np.sqrt(np.maximum(0.0, 1.0 - z * z))
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)
