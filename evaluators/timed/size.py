"""Size: the largest extent of a form."""

from __future__ import annotations

from evaluators.timed.measures import size_of
from evaluators.timed.unfolding import Unfolding


def size(unfolding: Unfolding) -> float:
    """Give the largest extent along x, y or z at the last time.

    Returns
    -------
    float
        In the turtle's unit: l for an upright cylinder of length l and a radius under l / 2.
    """
    return size_of(unfolding.form)
