"""What files say of shapes: cross-sections of carriers and surfaces, as tables."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from growth.timed.tables import Floats, Ints

SAMPLES: Final = 720
"""Angles at which a cross-section is known: every half degree."""

CELLS: Final = 12
"""A surface is known at so many places along each side, and one more."""


class Figures(NamedTuple):
    """Cross-sections and surfaces of a system; s sections, f surfaces, c codes.

    Attributes
    ----------
    sections
        (s, SAMPLES) float64, polar radii as multiples of the turtle's radius, positive.
    surfaces
        (f, CELLS + 1, CELLS + 1, 3) float64, along heading, left and up, by u and v.
    section_of, surface_of
        (c,) int64, which section a code chooses, to which surface it gives weight; NONE of others.
    """

    sections: Floats
    surfaces: Floats
    section_of: Ints
    surface_of: Ints


_NONE: Final = np.empty(0, dtype=np.int64)

NO_FIGURES: Final = Figures(np.empty((0, SAMPLES)), np.empty((0, CELLS + 1, CELLS + 1, 3)), _NONE, _NONE)
"""Of a system that has none; no code has any."""
