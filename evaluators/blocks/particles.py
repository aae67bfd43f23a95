"""Particles: how many airborne particles a body catches (Galasyn's trap, Senatore 2009, chapter 1)."""

from __future__ import annotations

from typing import Final

import numpy as np

from evaluators.blocks.rays import cells_at, hits, spread
from evaluators.blocks.structure import Structure
from growth.blocks.body import BOUNDARY, Body

COUNT: Final = 4096
"""How many particles are sent."""


def particles(structure: Structure) -> float:
    """Give the mean cross-section that a body offers to particles that come straight from all over the sky.

    Particles enter its bounding box evenly, from directions that are evenly spread over the upper half sphere; those
    that meet an internal or envelope block first are caught. Starts and directions are always the same.

    Parameters
    ----------
    structure
        The boundary stops particles, and they are lost.

    Returns
    -------
    float
        In squares of the lattice's unit, 0 or more. A convex body without boundary in the way offers a quarter of its
        surface (Cauchy): 1.5 for a cube. 0 without blocks.
    """
    return caught(structure.body)


def caught(body: Body) -> float:
    """Give the same of a body whose load does not matter."""
    built = body.cells[body.systems != BOUNDARY]
    if not len(built):
        return 0.0
    reach = np.abs(body.lattice.corners).max(axis=0)
    low, size = built.min(axis=0) - reach, np.ptp(built, axis=0) + 2.0 * reach
    drawn = spread(COUNT)
    up, angle = drawn[:, 0], 2.0 * np.pi * drawn[:, 1]
    flat = np.sqrt(1.0 - up * up)
    towards = np.stack([flat * np.cos(angle), flat * np.sin(angle), up], axis=1)  # where a particle comes from
    seen = np.abs(towards) * (size.prod() / size)  # of each pair of the box's sides, as seen from there
    section = seen.sum(axis=1)
    bounds = np.cumsum(seen, axis=1) / section[:, np.newaxis]
    axis = np.minimum((drawn[:, 2:3] >= bounds).sum(axis=1), 2)
    rows = np.arange(COUNT)
    before = bounds[rows, axis] - seen[rows, axis] / section
    within = (drawn[:, 2] - before) * section / seen[rows, axis]
    entry = np.empty((COUNT, 3))
    entry[rows, axis] = towards[rows, axis] > 0
    entry[rows, (axis + 1) % 3] = within
    entry[rows, (axis + 2) % 3] = drawn[:, 3]
    starts = low + entry * size
    ends = np.where(towards > 0, body.cells.max(axis=0) + reach, body.cells.min(axis=0) - reach)
    away = ((ends - starts) / towards).min(axis=1) + 0.5  # out of the walls that may stand around the body
    starts += away[:, np.newaxis] * towards
    met = hits(body, starts, cells_at(starts, body.lattice), -towards)
    stopped = (met >= 0) & (body.systems[met] != BOUNDARY)
    return float(section[stopped].sum() / COUNT)
