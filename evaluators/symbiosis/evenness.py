"""Evenness: how nearly the envelope's outer skin has no folds, notches or pits, for the look of it."""

from __future__ import annotations

import numpy as np

from evaluators.symbiosis.symbiosis import Symbiosis
from growth.blocks.lattice import FACE


def evenness(symbiosis: Symbiosis) -> float:
    """Give the number of outer faces that the shadows of the enclosure need, over the number that it has.

    Outer faces are those between a wall and a cell outside. Each line of cells that follow each other over faces, in
    any of the lattice's directions over faces, and that meets a wall, comes in by one outer face and leaves by another;
    where the skin is even it meets no more. So twice the number of such lines over the number of outer faces is at most
    1, and 1 where no line leaves the enclosure and enters it again.

    Parameters
    ----------
    symbiosis
        What is outside follows from the flood, in either reading; walls inside do not count.

    Returns
    -------
    float
        Above 0, at most 1: 1 for a closed box, (6 n^2) / (6 n^2 + 4) for one with sides of n and a pit one cell deep
        in one of them; 0 without walls.
    """
    around = symbiosis.surroundings
    walls = np.flatnonzero(around.walls)
    if not walls.size:
        return 0.0
    lattice = symbiosis.lattice
    sides = lattice.offsets[lattice.contacts == FACE]
    cells = np.stack(np.unravel_index(walls, around.grid.shape), axis=1)
    faces = lines = 0
    for side, step in zip(sides, around.grid.steps(sides), strict=True):
        faces += int(np.count_nonzero(around.outside[walls + step]))
        lines += _lines(cells, side)
    return float(lines / faces)


def _lines(
    cells: np.ndarray[tuple[int, ...], np.dtype[np.int64]], side: np.ndarray[tuple[int], np.dtype[np.int64]]
) -> int:
    """Count the lines along an offset that go through cells."""
    axis = int(np.flatnonzero(side)[0])
    on = cells - (cells[:, axis] * side[axis])[:, np.newaxis] * side  # each offset's entries are -1, 0 or 1
    return len(np.unique(on, axis=0))
