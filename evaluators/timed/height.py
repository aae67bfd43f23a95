"""Height: how far it is from a form's lowest to its highest point."""

from __future__ import annotations

from evaluators.timed.measures import extents
from evaluators.timed.unfolding import Unfolding


def height(unfolding: Unfolding) -> float:
    """Give the extent along z at the last time.

    Returns
    -------
    float
        In the turtle's unit: l for an upright cylinder of length l; 0 for a level plate without thickness.
    """
    return float(extents(unfolding.form)[2])
