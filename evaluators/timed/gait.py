"""A form's feet: the tips that live at all samples and touch the ground, and how they move (McCormack, section 5.3).

A legged animal walks on the spot: its body stays where the turtle began, and the ground moves under it with the feet
that stand. So the body's speed is that of the standing feet, the other way round.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from evaluators.timed.measures import size_of
from evaluators.timed.steadiness import LEAST
from evaluators.timed.unfolding import Unfolding
from growth.timed.drawing import Drawing
from growth.timed.tables import Floats, Ints

SOLE: Final = 0.0025
"""A tip is on the ground up to this part of the form's size above the lowest place that any tip has."""


class Gait(NamedTuple):
    """What k feet do at n samples.

    Attributes
    ----------
    heights
        (n, k) float64, above the ground.
    stands
        (n, k) bool, whether they are on it.
    pushes
        (n - 1, k) float64, how far each moves against the body's heading from a sample to the next, on the ground at
        both; 0 where it is not, and of feet that are never in the air.
    """

    heights: Floats
    stands: NDArray[np.bool_]
    pushes: Floats


def gait_of(unfolding: Unfolding) -> Gait | None:
    """Find the feet of a form and how they move.

    The body's heading is the level direction against which standing feet move, all in all. A foot that is on the ground
    at all samples takes no step: what grows, or is dragged, along the ground moves no body, however far it goes.

    Returns
    -------
    Gait or None
        ``None`` with fewer than two samples, or without a foot. Where standing feet move nowhere in all, no push is
        other than 0.
    """
    tracks = _tracks(unfolding.drawings)
    if len(tracks) < 2 or not tracks.shape[1]:
        return None
    heights = tracks[:, :, 2] - tracks[:, :, 2].min()
    size = size_of(unfolding.form)
    stands = heights <= SOLE * size
    feet = stands.any(axis=0)
    heights, stands = heights[:, feet], stands[:, feet]
    steps = stands[1:] & stands[:-1] & ~stands.all(axis=0)
    moves = np.diff(tracks[:, feet, :2], axis=0) * steps[:, :, None]
    drift = moves.sum(axis=(0, 1))
    length = float(np.hypot(*drift))
    way = drift / length if length > LEAST * size else np.zeros(2)
    return Gait(heights, stands, moves @ way)


def touchdowns(gait: Gait) -> Ints:
    """Count how often each foot (k,) comes down on the ground, once at least."""
    return np.asarray(np.maximum((gait.stands[1:] & ~gait.stands[:-1]).sum(axis=0), 1))


def _tracks(drawings: tuple[Drawing, ...]) -> Floats:
    """Give the places (n, k, 3) of the tips that live at all samples, in ascending order of their lineages.

    A tip of lineage 0, where no module has moved the turtle, is none.
    """
    found = [np.unique(drawing.tip_lineages, return_index=True) for drawing in drawings]
    shared = found[0][0]
    for lineages, _ in found[1:]:
        shared = np.intersect1d(shared, lineages, assume_unique=True)
    shared = shared[shared != 0]
    return np.stack(
        [
            drawing.tips[first[np.searchsorted(lineages, shared)]]
            for drawing, (lineages, first) in zip(drawings, found, strict=True)
        ]
    )
