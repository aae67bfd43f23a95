"""Stride: how far a gait carries the body with each step."""

from __future__ import annotations

from evaluators.timed.gait import gait_of, touchdowns
from evaluators.timed.unfolding import Unfolding


def stride(unfolding: Unfolding) -> float:
    """Give how far feet go back on the ground from one touchdown to the next, in the mean over the feet.

    Back is against the body's heading (:func:`~evaluators.timed.gait.gait_of`). A foot that goes forward on the ground
    takes back what it has pushed, one that is never lifted pushes nothing, and feet that push different ways take from
    each other. How far a foot goes between a sample in the air and one on the ground does not count: samples must be
    dense to a step. The window is best a whole number of cycles, or some steps count in part.

    Returns
    -------
    float
        In the turtle's unit: 2 l sin(a) for legs of length l that swing from -a to a about upright axes, on the ground
        on the way back; 0 for an animal that stands still, without feet, or seen once.
    """
    gait = gait_of(unfolding)
    return 0.0 if gait is None else float((gait.pushes.sum(axis=0) / touchdowns(gait)).mean())
