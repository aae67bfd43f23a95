"""Lift: how high a gait lifts the feet."""

from __future__ import annotations

from evaluators.timed.gait import gait_of
from evaluators.timed.unfolding import Unfolding


def lift(unfolding: Unfolding) -> float:
    """Give how far each foot goes up from its lowest place, in the mean over the feet.

    Returns
    -------
    float
        In the turtle's unit: h where every foot rises by h; 0 for an animal that stands still, or shuffles, without
        feet, or seen once.
    """
    gait = gait_of(unfolding)
    return 0.0 if gait is None else float((gait.heights.max(axis=0) - gait.heights.min(axis=0)).mean())
