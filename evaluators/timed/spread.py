"""Spread: how wide a form is to its height."""

from __future__ import annotations

from typing import Final

from evaluators.timed.measures import extents
from evaluators.timed.unfolding import Unfolding

FLATTEST: Final = 1e-6
"""A height under this part of the form's size counts as this part of it, so that level forms have a spread."""


def spread(unfolding: Unfolding) -> float:
    """Divide the mean of the extents along x and y by that along z, at the last time.

    Returns
    -------
    float
        Without unit: 1 for a sphere, 2 r / l for an upright cylinder, 1e6 at most for a square that lies level.
    """
    x, y, z = extents(unfolding.form).tolist()
    return (x + y) / 2.0 / max(z, FLATTEST * max(x, y, z)) if max(x, y, z) > 0.0 else 0.0
