"""Compiled loops of the model ``galasyn``."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

IN_LINE: Final = 1e-9
"""A share of load whose part across is smaller than this of the whole is along the line to the centre of mass."""


@njit(cache=True)
def _at_points(points: Floats, members: Ints) -> tuple[Ints, Ints]:
    """Sort joints by where they are, so that those that cross in one point are neighbours.

    Returns
    -------
    order : (m,) int64
        The members, sorted.
    first : (g + 1,) int64
        Those of the g-th point are ``order[first[g] : first[g + 1]]``.
    """
    doubled = np.empty((members.size, 3), dtype=np.int64)  # joints lie half way between whole coordinates
    for m in range(members.size):
        for axis in range(3):
            doubled[m, axis] = int(2.0 * points[members[m], axis])
    low = np.array([doubled[:, axis].min() for axis in range(3)])
    keys = np.empty(members.size, dtype=np.int64)
    for m in range(members.size):
        keys[m] = (((doubled[m, 0] - low[0]) << 21 | doubled[m, 1] - low[1]) << 21) | doubled[m, 2] - low[2]
    rank = np.argsort(keys, kind="mergesort")
    first = np.empty(members.size + 1, dtype=np.int64)
    count = 0
    for m in range(members.size):
        if m == 0 or keys[rank[m]] != keys[rank[m - 1]]:
            first[count] = m
            count += 1
    first[count] = members.size
    return members[rank], first[: count + 1].copy()


@njit(cache=True)
def _lean(at: Floats, out: Floats, i: int, a: int, b: int, mx: float, my: float, factor: float, evenly: bool) -> None:
    """Let the joints a to b of a part meet the moment (mx, my, 0) about its joint i.

    Parameters
    ----------
    at
        (4, m) float64: the joints' x, y and z, and their parts across.
    out
        (6, m) float64, forces and moments, added to: the force (m x r) / r^2 at the end of the lever r has the moment m
        less its part along r, which stays at joint i as a twist.
    factor, evenly
        Each meets a share of this, times its part across unless ``evenly``.
    """
    tx = ty = tz = 0.0
    for j in range(a, b):
        x, y, z = at[0, j] - at[0, i], at[1, j] - at[1, i], at[2, j] - at[2, i]
        met = (factor if evenly else factor * at[3, j]) / (x * x + y * y + z * z)
        out[0, j] += met * my * z
        out[1, j] -= met * mx * z
        out[2, j] += met * (mx * y - my * x)
        twist = met * (mx * x + my * y)
        tx += twist * x
        ty += twist * y
        tz += twist * z
    out[3, i] += tx
    out[4, i] += ty
    out[5, i] += tz


@njit(cache=True)
def _part_of_galasyn(at: Floats, shares: Floats, first: Ints, weight: float, out: Floats) -> None:
    """Do one part: joints in order of their points, relative to the centre of mass; see :func:`galasyn`."""
    for i in range(shares.size):
        x, y, z = at[0, i], at[1, i], at[2, i]
        square = x * x + y * y + z * z
        along = shares[i] * z / square if square > 0.0 else 0.0
        at[3, i] = -shares[i] * (math.sqrt((x * x + y * y) / square) if square > 0.0 else 1.0)
        if at[3, i] < IN_LINE * weight:
            at[3, i] = 0.0
        out[0, i] += along * x
        out[1, i] += along * y
        out[2, i] += along * z
    after = np.zeros(first.size)  # parts across of the points from here on
    for g in range(first.size - 2, -1, -1):
        after[g] = after[g + 1] + at[3, first[g] : first[g + 1]].sum()
    before = 0.0
    for g in range(first.size - 1):
        a, b = first[g], first[g + 1]
        turned = before + after[g + 1]  # of the others: joints that cross in one point have no lever against each other
        others = shares.size - (b - a)
        for i in range(a, b):
            if at[3, i] > 0.0:
                # the moment of the part across about its joint is that of the whole share: (centre - joint) x share
                mx, my = -at[1, i] * shares[i], at[0, i] * shares[i]
                if others == 0:  # nobody to lean on: all of it stays with the joint
                    out[0, i] = out[1, i] = 0.0
                    out[2, i] = shares[i]
                    out[3, i] += mx
                    out[4, i] += my
                else:
                    factor = 1.0 / turned if turned > 0.0 else 1.0 / others
                    _lean(at, out, i, 0, a, mx, my, factor, turned == 0.0)
                    _lean(at, out, i, b, shares.size, mx, my, factor, turned == 0.0)
        before += at[3, a:b].sum()


@njit(cache=True)
def galasyn(
    points: Floats, stiffness: Floats, first: Ints, order: Ints, weights: Floats, centres: Floats
) -> tuple[Floats, Floats]:
    """Share out each part's weight by Galasyn's vectors (Senatore 2009, 'the one block problem').

    Parameters
    ----------
    points, stiffness, first, order, weights, centres
        As for :func:`evaluators.blocks.load._rigid.rigid`; a joint's share is in proportion to its stiffness.

    Returns
    -------
    forces, moments : (j, 3) float64
        As of ``rigid``, but in balance only where a part has one joint, or by chance.
    """
    forces, moments = np.zeros_like(points), np.zeros_like(points)
    for p in range(weights.size):
        members, spots = _at_points(points, order[first[p] : first[p + 1]])
        k = 0.0
        for j in members:
            k += stiffness[j]
        at, out, shares = np.empty((4, members.size)), np.zeros((6, members.size)), np.empty(members.size)
        for m in range(members.size):
            shares[m] = -weights[p] * stiffness[members[m]] / k  # along z
            for axis in range(3):
                at[axis, m] = points[members[m], axis] - centres[p, axis]
        _part_of_galasyn(at, shares, spots, weights[p], out)
        for m in range(members.size):
            for axis in range(3):
                forces[members[m], axis] = out[axis, m]
                moments[members[m], axis] = out[3 + axis, m]
    return forces, moments
