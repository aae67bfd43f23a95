"""Rays over a lattice: which cell a point lies in, and an even spread of numbers to draw rays from."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks._kernels import first_hits
from growth.blocks.body import Body
from growth.blocks.lattice import FACE, Lattice

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

GOLDEN_4: Final = 1.1673039782614187
"""The positive root of x^5 = x + 1; its powers spread points evenly over four dimensions."""

WIDEST: Final = 5_000
"""The most cells along an axis that rays are sent over."""


def cells_at(points: Floats, lattice: Lattice) -> Ints:
    """Give the cells that points lie in: (n, 3) int64, those with the nearest centres.

    Parameters
    ----------
    points
        (n, 3) float64.
    lattice
        Where only even coordinate sums are cells, the coordinate that was rounded most is rounded the other way.
    """
    near = np.rint(points)
    if lattice.parity:
        odd = np.flatnonzero(near.sum(axis=1) % 2 != 0)
        off = points[odd] - near[odd]
        axis = np.abs(off).argmax(axis=1)
        near[odd, axis] += np.where(off[np.arange(odd.size), axis] >= 0, 1.0, -1.0)
    return near.astype(np.int64)


def spread(count: int) -> Floats:
    """Give (count, 4) float64 in [0, 1), evenly spread and always the same: additive recurrence, no generator."""
    steps = np.array([1.0 / GOLDEN_4**power for power in range(1, 5)])
    points: Floats = (0.5 + np.arange(1, count + 1)[:, np.newaxis] * steps) % 1.0
    return points


def hits(body: Body, starts: Floats, within: Ints, ways: Floats) -> Ints:
    """Give the place of the first of the body's cells that each ray meets, or -1: (r,) int64.

    Raises
    ------
    ValueError
        For a body so wide that rays would take minutes; one that hangs together is far smaller.
    """
    if len(body.cells) and int(np.ptp(body.cells, axis=0).max()) > WIDEST:
        raise ValueError(f"the body is more than {WIDEST} cells wide")
    sides = np.ascontiguousarray(body.lattice.offsets[body.lattice.contacts == FACE])
    return first_hits(body.cells, sides, starts, within, ways)
