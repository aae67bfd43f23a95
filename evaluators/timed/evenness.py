"""Evenness: whether a gait carries the body at one speed, on as many feet at every time."""

from __future__ import annotations

import numpy as np

from evaluators.timed.gait import gait_of
from evaluators.timed.steadiness import steadiness
from evaluators.timed.unfolding import Unfolding


def evenness(unfolding: Unfolding) -> float:
    """Multiply the steadiness of the body's speed by that of the number of feet that bear it.

    The speed from a sample to the next is the mean push of the feet that are on the ground at both, and 0 where none is
    (:func:`~evaluators.timed.gait.gait_of`); the number is that of those feet.

    Returns
    -------
    float
        From 0 to 1: 1 for a wheel of many legs, and for two legs of which always one goes back on the ground at one
        speed; (k - 1) / (n - 1) squared where all feet push evenly in k of n intervals, and all are in the air in the
        others; 0 for an animal that gets nowhere, without feet, or seen once.
    """
    gait = gait_of(unfolding)
    if gait is None:
        return 0.0
    bearing = (gait.stands[1:] & gait.stands[:-1]).sum(axis=1)
    speeds = gait.pushes.sum(axis=1) / np.maximum(bearing, 1)
    return steadiness(speeds) * steadiness(bearing.astype(np.float64))
