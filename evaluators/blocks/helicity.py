"""Helicity: how far the centre line of a body winds about the vertical, and whether it keeps its sense."""

from __future__ import annotations

import numpy as np

from evaluators.blocks.structure import Structure

NEAR = 1e-9
"""Turns of level centres nearer to the axis than this count for nothing."""


def helicity(structure: Structure) -> float:
    """Measure how far the levels' centres wind about their common axis, times how well they keep one sense.

    The centre of the internal blocks of each level has a radius and a direction, seen from the mean of all levels'
    centres. From level to level it turns by an angle in (-pi, pi]; each turn counts by the product of the two radii, so
    that a line that leans through the axis, or wavers about it, does not count as winding. With T the mean turn so
    weighted times the number of turns, the helicity is min(1, |T| / 2 pi) times |sum of turns| over the sum of
    |turns|, both weighted (the thesis shows helices and leaves their measure open).

    Parameters
    ----------
    structure
        Internal blocks; levels without any are passed over. A double helix has its centres on the axis and counts as
        straight.

    Returns
    -------
    float
        0 to 1: 0 for a straight or a leaning column and any body in a plane, 1 for a helix of one full turn or more,
        whichever its sense.
    """
    cells = structure.body.internal
    if not len(cells):
        return 0.0
    level = cells[:, 2] - cells[:, 2].min()
    count = np.bincount(level)
    present = count > 0
    centres = np.stack([np.bincount(level, cells[:, axis])[present] / count[present] for axis in (0, 1)], axis=1)
    out = centres - centres.mean(axis=0)
    a, b = out[:-1], out[1:]
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    cross[np.abs(cross) < NEAR] = 0.0  # rounding gives a line through the axis no sense
    turns = np.where(cross == 0.0, 0.0, np.arctan2(cross, (a * b).sum(axis=1)))
    weights = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    net, gross = abs(float((weights * turns).sum())), float((weights * np.abs(turns)).sum())
    if gross == 0.0:
        return 0.0
    wound = net / float(weights.sum()) * len(turns)
    return min(1.0, wound / (2.0 * np.pi)) * net / gross
