"""Volume: how much matter a form is."""

from __future__ import annotations

from evaluators.timed.measures import volume_of
from evaluators.timed.unfolding import Unfolding


def volume(unfolding: Unfolding) -> float:
    """Add the volumes of the closed parts at the last time; what lies in several of them counts several times.

    Returns
    -------
    float
        In cubes of the turtle's unit: close to pi r^2 l for a cylinder; 0 for polygons and surfaces.
    """
    return volume_of(unfolding.form)
