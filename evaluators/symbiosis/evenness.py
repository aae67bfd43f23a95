"""Evenness: how nearly the envelope's outer skin has no folds, notches or pits, for the look of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluators.symbiosis.symbiosis import Symbiosis
from growth.blocks.lattice import FACE

Ints = NDArray[np.int64]


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
    cells = around.grid.cells(walls)
    faces = lines = 0
    for side, step in zip(sides, around.grid.steps(sides), strict=True):
        faces += int(np.count_nonzero(around.outside[walls + step]))
        lines += _lines(cells, side)
    return float(lines / faces)


def _lines(cells: Ints, side: Ints) -> int:
    """Count the lines along an offset that go through cells, by where they pass the offset's first axis."""
    axis = int(np.flatnonzero(side)[0])
    through = cells - (cells[:, axis] * side[axis])[:, np.newaxis] * side  # each offset's entries are -1, 0 or 1
    one, other = np.delete(through, axis, axis=1).T
    return len(np.unique(one * (int(np.ptp(other)) + 1) + other))
