"""How even a series of numbers is; what criteria of development and of motion share."""

from __future__ import annotations

from typing import Final

import numpy as np

from growth.timed.tables import Floats

LEAST: Final = 1e-9
"""Sums under this part of what they are compared with are rounding, and count as nothing."""


def steadiness(values: Floats) -> float:
    """Tell how nearly numbers are all alike.

    Half the sum of their distances from their mean is what would have to move from the larger to the smaller ones to
    make them alike; (n - 1) times the mean is what moves when all is in one. One less the share of the two.

    Parameters
    ----------
    values
        (n,) float64.

    Returns
    -------
    float
        From 0 to 1: 1 for numbers that are alike, and for one alone; (n - k) / (n - 1) less than 1 for k of n that are
        alike where the others are 0, so 0 for a single one; 0 where the mean is not above 0.
    """
    mean = float(values.mean()) if values.size else 0.0
    if mean <= 0.0 or mean <= LEAST * float(np.abs(values).max()):
        return 0.0
    if values.size == 1:
        return 1.0
    moved = 0.5 * float(np.abs(values - mean).sum())
    return max(0.0, 1.0 - moved / ((values.size - 1) * mean))
