"""Surface: how much of a form lies open to light and air."""

from __future__ import annotations

from evaluators.timed.measures import area_of
from evaluators.timed.unfolding import Unfolding


def surface(unfolding: Unfolding) -> float:
    """Add the areas of all parts at the last time.

    A polygon or surface counts once, as a leaf's area does. What of a part lies within another, or under it, counts:
    joints are small to what they join, and to cut every part with every other would take longer than to grow them.

    Returns
    -------
    float
        In squares of the turtle's unit: close to 2 pi r (l + r) for a cylinder, and the same from all sides.
    """
    return area_of(unfolding.form)
