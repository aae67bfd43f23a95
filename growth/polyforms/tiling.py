"""Cells that forms are conjoined of, and the vectors of their edges: squares, triangles, hexagons, cubes.

A cell is three integers. Of squares and hexagons the third is 0, of triangles it says which way the cell points (0 up,
1 down), of cubes it is the height. Two cells conjoin where an edge of one is the negative of an edge of the other
(Rosenman 1997, section 3.2, rule R1); of cubes what conjoins are faces, which the same words serve for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

NO_SIDE: Final = -(2**20)
"""Stands in a step of an edge that a cell of this type does not have."""

HALF: Final = 3**0.5 / 2


@final
@dataclass(frozen=True, eq=False)
class Tiling:
    """Cells that fill the plane, or space; edges have length 1.

    Attributes
    ----------
    name
        As briefs write it.
    letters
        The names of the D edge vectors; ``E2`` is the second free edge of this vector.
    steps
        (T, D, 3) int64, from a cell of each type to the one beyond each edge; :data:`NO_SIDE` where it has no such
        edge.
    opposite
        (D,) int64, the negative of each vector.
    around
        (T, m) int64, the vectors of a cell's edges in order around it, edge k from corner k to corner k + 1. Of cubes
        the order means nothing.
    corners
        (T, c, 3) int64, the corners of the cell at the origin, on the lattice of corners.
    lattice
        (3, 3) int64, from a cell to the place of its origin on the lattice of corners: ``lattice @ cell``.
    positions
        (3, 3) float64, from the lattice of corners to the plane or space: ``positions @ corner``.
    straight
        How many cells meet at a corner where a boundary goes straight on; -1 where it never does.
    area
        Of a cell: its area, of a cube its volume.
    """

    name: str
    letters: str
    steps: Ints
    opposite: Ints
    around: Ints
    corners: Ints
    lattice: Ints
    positions: Floats
    straight: int
    area: float

    @property
    def solid(self) -> bool:
        """Whether its cells fill space."""
        return bool(self.corners.shape[1] == 8)

    @property
    def types(self) -> int:
        """Types of cells: 2 of triangles."""
        return len(self.steps)

    def vertices(self, cells: Ints) -> Ints:
        """Give the corners of cells (n, 3) on the lattice of corners: (n, c, 3) int64."""
        kinds = cells[:, 2] if self.types > 1 else np.zeros(len(cells), dtype=np.int64)
        return np.asarray((cells @ self.lattice.T)[:, None, :] + self.corners[kinds])


def _tiling(
    name: str,
    letters: str,
    steps: list[list[tuple[int, int, int]]],
    opposite: list[int],
    around: list[list[int]],
    corners: list[list[tuple[int, int, int]]],
    lattice: list[list[int]],
    positions: list[list[float]],
    straight: int,
    area: float,
) -> Tiling:
    return Tiling(
        name, letters, _table(steps), _table(opposite), _table(around), _table(corners), _table(lattice),
        np.array(positions), straight, area,
    )  # fmt: skip


def _table(rows: Sequence[object]) -> Ints:
    table = np.array(rows, dtype=np.int64)
    table.flags.writeable = False
    return table


def _square() -> Tiling:
    # Clockwise from the lower side, as the paper writes a cell: (W1, N1, E1, S1); a new cell at an edge E lies north.
    return _tiling(
        "square", "WNES", [[(0, -1, 0), (-1, 0, 0), (0, 1, 0), (1, 0, 0)]], [2, 3, 0, 1], [[0, 1, 2, 3]],
        [[(1, 0, 0), (0, 0, 0), (0, 1, 0), (1, 1, 0)]],
        [[1, 0, 0], [0, 1, 0], [0, 0, 0]], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]], 2, 1.0,
    )  # fmt: skip


def _triangle() -> Tiling:
    none = (NO_SIDE, NO_SIDE, NO_SIDE)
    return _tiling(
        "triangle", "ABCDEF",
        [[(0, -1, 1), (0, 0, 1), (-1, 0, 1), none, none, none], [none, none, none, (0, 1, -1), (0, 0, -1), (1, 0, -1)]],
        [3, 4, 5, 0, 1, 2], [[0, 1, 2], [5, 3, 4]],
        [[(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0), (0, 1, 0)]],
        [[1, 0, 0], [0, 1, 0], [0, 0, 0]], [[1.0, 0.5, 0.0], [0.0, HALF, 0.0], [0.0, 0.0, 0.0]], 3, HALF / 2,
    )  # fmt: skip


def _hexagon() -> Tiling:
    return _tiling(
        "hexagon", "ABCDEF",
        [[(1, 0, 0), (0, 1, 0), (-1, 1, 0), (-1, 0, 0), (0, -1, 0), (1, -1, 0)]],
        [3, 4, 5, 0, 1, 2], [[0, 1, 2, 3, 4, 5]],
        [[(1, 0, 0), (0, 1, 0), (-1, 1, 0), (-1, 0, 0), (0, -1, 0), (1, -1, 0)]],
        [[1, -1, 0], [1, 2, 0], [0, 0, 0]], [[1.0, 0.5, 0.0], [0.0, HALF, 0.0], [0.0, 0.0, 0.0]], -1, 3 * HALF,
    )  # fmt: skip


def _cube() -> Tiling:
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    return _tiling(
        "cube", "WNESDU", [[(-1, 0, 0), (0, 1, 0), (1, 0, 0), (0, -1, 0), (0, 0, -1), (0, 0, 1)]],
        [2, 3, 0, 1, 5, 4], [[0, 1, 2, 3, 4, 5]], [corners],
        [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], -1, 1.0,
    )  # fmt: skip


SQUARE: Final = _square()
"""Unit squares, with the paper's four vectors W, N, E, S."""

TRIANGLE: Final = _triangle()
"""Equilateral triangles that point up or down."""

HEXAGON: Final = _hexagon()
"""Regular hexagons."""

CUBE: Final = _cube()
"""Unit cubes, conjoined over faces: towards west, north, east, south, down, up."""

TILINGS: Final[Mapping[str, Tiling]] = MappingProxyType({one.name: one for one in (SQUARE, TRIANGLE, HEXAGON, CUBE)})
