"""Symmetry: how nearly a body is its own mirror image in an upright plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks.structure import Structure

Ints = NDArray[np.int64]


def symmetry(structure: Structure) -> float:
    """Give the best intersection over union of a body and its mirror image.

    The planes are upright, at right angles to x, to y, or to a diagonal between them, wherever the lattice maps onto
    itself.

    Parameters
    ----------
    structure
        Internal blocks; envelope and boundary follow from them and do not count.

    Returns
    -------
    float
        Above 0, at most 1: 1 for a body with such a plane; 1 without blocks.
    """
    x, y, z = structure.body.internal.T
    if not x.size:
        return 1.0
    ways = ((x, y), (y, x), (x - y, x + y), (x + y, x - y))  # along the normal, and along the plane
    both = max(_kept(along, fixed, z) for along, fixed in ways)
    return float(both / (2 * x.size - both))


def _kept(along: Ints, fixed: Ints, z: Ints) -> int:
    """Give the most blocks whose mirror images are blocks too, over all planes across ``along``.

    Two blocks of one line (alike in ``fixed`` and ``z``) are each other's image in the plane at half the sum of their
    places along it; a block is its own image in the plane through it.
    """
    order = np.lexsort((along, fixed, z))
    along, fixed, z = along[order], fixed[order], z[order]
    starts = np.flatnonzero(np.r_[True, (np.diff(fixed) != 0) | (np.diff(z) != 0)])
    lengths = np.diff(np.r_[starts, along.size])
    first = np.repeat(np.arange(along.size), np.repeat(lengths, lengths))  # each block with each of its line
    begin = np.cumsum(np.r_[0, np.repeat(lengths, lengths)[:-1]])
    second = np.arange(first.size) - begin[first] + np.repeat(starts, lengths)[first]
    sums = along[first] + along[second]
    return int(np.bincount(sums - sums.min()).max())
