"""Cross-sections that every file has: circle, square, triangle and five-pointed star."""

from __future__ import annotations

from typing import Final

import numpy as np

from genome.timed.commands import SECTIONS
from growth.timed.figures import SAMPLES
from growth.timed.tables import Floats

CIRCLE: Final = 0
"""The place of the circle among the sections."""

DENT: Final = 0.5
"""The radius of a star between two points, which have 1."""


def shipped() -> Floats:
    """Give the polar radii (s, SAMPLES) of :data:`~genome.timed.commands.SECTIONS`; their corners have radius 1.

    The triangle and the star have a corner at the angle 0, the turtle's left; the square at 45 degrees.
    """
    angles = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    third = np.pi / 3.0
    point = np.pi / 5.0
    out = np.abs(np.mod(angles + point, 2.0 * point) - point)
    made = {
        "circle": np.ones(SAMPLES),
        "square": np.sqrt(0.5) / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles))),
        "triangle": 0.5 / np.cos(np.mod(angles, 2.0 * third) - third),
        "star": DENT * np.sin(point) / (np.sin(out) + DENT * np.sin(point - out)),
    }
    return np.stack([made[name] for name in SECTIONS])


def resampled(tables: Floats, sides: int) -> Floats:
    """Give the radii of sections (s, SAMPLES) at so many angles, (s, sides); linear between those that are known."""
    places = np.arange(sides) * (SAMPLES / sides)
    low = np.floor(places).astype(np.int64)
    share = places - low
    return np.asarray(tables[:, low] * (1.0 - share) + tables[:, (low + 1) % SAMPLES] * share)
