"""The volume that an enclosure surrounds, and what it costs ("In terms of configurations of solid matter", Coates)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluators.symbiosis.symbiosis import Symbiosis


def enclosed(symbiosis: Symbiosis) -> float:
    """Give the volume that is surrounded.

    By the flood, the number of cells that are no walls and stay dry. By visibility, the sum over all cells c that are
    no walls of w(c) = max(0, 2 v(c) - 1), v being the share of the directions in which a ray from c meets a wall: a
    cell on the outer side of a wall sees walls in at most half of them, and counts nothing.

    Parameters
    ----------
    symbiosis
        The space's cells are no walls.

    Returns
    -------
    float
        In cells, 0 or more.
    """
    around = symbiosis.surroundings
    if symbiosis.settings.surrounded == "flood":
        return float(around.dry.sum(dtype=np.int64))
    return doubled(around.sights[around.walls == 0], around.directions) / around.directions


def enclosed_ratio(symbiosis: Symbiosis) -> float:
    """Give the volume that is surrounded over the enclosure's own.

    Parameters
    ----------
    symbiosis
        All cells of the enclosure count, those that the space carves too.

    Returns
    -------
    float
        0 or more: 27 / 98 for the closed shell of one cell around a cube of three; 0 without enclosure.
    """
    own = len(symbiosis.enclosure)
    return enclosed(symbiosis) / own if own else 0.0


def economy(symbiosis: Symbiosis) -> float:
    """Give the volume that is surrounded over the sum of it and the enclosure's own.

    Parameters
    ----------
    symbiosis
        As for :func:`enclosed_ratio`, of which this is r / (1 + r).

    Returns
    -------
    float
        From 0 up to, and without, 1; 0 without enclosure.
    """
    inside, own = enclosed(symbiosis), len(symbiosis.enclosure)
    return inside / (inside + own) if own else 0.0


def doubled(sights: NDArray[np.uint8], directions: int) -> int:
    """Add up max(0, 2 s - d) over numbers of directions s, of d in all: the weights of cells, times d."""
    many = np.bincount(sights, minlength=directions + 1)
    return int(many @ np.maximum(2 * np.arange(directions + 1) - directions, 0))
