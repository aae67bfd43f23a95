"""Smoothness: how evenly a form develops."""

from __future__ import annotations

import numpy as np

from evaluators.timed.measures import area_of
from evaluators.timed.steadiness import LEAST, steadiness
from evaluators.timed.unfolding import Unfolding


def smoothness(unfolding: Unfolding) -> float:
    """Tell how alike the changes of a form are from sample to sample.

    What changes is the square root of the form's area: a length, which grows evenly where all lengths do. Growing and
    shrinking are both change.

    Returns
    -------
    float
        From 0 to 1 (:func:`~evaluators.timed.steadiness.steadiness`): 1 for even growth, for a form that does not
        change, and for a single sample; 0 for one that jumps once and else stays as it is; (k - 1) / (n - 1) for one
        that grows evenly in k of n intervals.
    """
    lengths = np.sqrt([area_of(drawing) for drawing in unfolding.drawings])
    changes = np.abs(np.diff(lengths))
    return steadiness(changes) if changes.sum() > LEAST * lengths.max() else 1.0
