"""A dense grid around the cells of all partners, on which they are measured together."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks._kernels import touching
from evaluators.space_syntax import Graph, of_edges
from growth.blocks.lattice import Lattice

Ints = NDArray[np.int64]
Bytes = NDArray[np.uint8]

LARGEST: Final = 2**26
"""The most places of a grid: some 400 a side."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Places around cells, laid out flat, the last axis fastest.

    Attributes
    ----------
    lattice
        Whose cells they are.
    low
        (3,) int64, the cell of the first place.
    shape
        How many places there are along x, y and z: a margin of one lies around on each axis that has neighbours.
    inner
        (n,) uint8, 0 in the margin.
    """

    lattice: Lattice
    low: Ints
    shape: tuple[int, int, int]
    inner: Bytes

    def steps(self, offsets: Ints) -> Ints:
        """Give what steps by offsets, (..., 3) int64, add to a place: (...) int64."""
        return np.asarray(offsets @ np.array([self.shape[1] * self.shape[2], self.shape[2], 1], dtype=np.int64))

    def places(self, cells: Ints) -> Ints:
        """Give the places of cells, (n, 3) int64, that the grid was laid around: (n,) int64."""
        return self.steps(cells - self.low)

    def cells(self, places: Ints) -> Ints:
        """Give the cells at places, (n,) int64: (n, 3) int64."""
        return np.asarray(np.stack(np.unravel_index(places, self.shape), axis=-1) + self.low, dtype=np.int64)

    def mask(self, places: Ints) -> Bytes:
        """Give 1 at some places and 0 elsewhere: (n,) uint8."""
        marked = np.zeros(self.inner.size, dtype=np.uint8)
        marked[places] = 1
        return marked

    def cells_only(self) -> Bytes:
        """Give 1 at places that are cells of the lattice: (n,) uint8."""
        if not self.lattice.parity:
            return np.ones(self.inner.size, dtype=np.uint8)
        x, y, z = (np.arange(size) + start for size, start in zip(self.shape, self.low.tolist(), strict=True))
        odd = (x[:, np.newaxis, np.newaxis] + y[:, np.newaxis] + z) & 1
        return np.asarray(1 - odd, dtype=np.uint8).ravel()


def lay_out(lattice: Lattice, cells: Ints) -> Grid:
    """Lay a grid around cells, (n, 3) int64; without cells around the origin.

    Raises
    ------
    ValueError
        Where it would have more than :data:`LARGEST` places; partners are far apart, or one of them is huge.
    """
    margin = np.abs(lattice.offsets).max(axis=0)
    around = cells if len(cells) else np.zeros((1, 3), dtype=np.int64)
    low, high = around.min(axis=0) - margin, around.max(axis=0) + margin
    sides = [last - first + 1 for first, last in zip(low.tolist(), high.tolist(), strict=True)]
    if math.prod(sides) > LARGEST:
        box = " x ".join(str(side) for side in sides)
        raise ValueError(f"a box of {box} cells around the partners has more than the {LARGEST} that are measured")
    inner = np.zeros(sides, dtype=np.uint8)
    inner[tuple(slice(int(m), side - int(m)) for m, side in zip(margin, sides, strict=True))] = 1
    return Grid(lattice, low, (sides[0], sides[1], sides[2]), inner.ravel())


def graph_of(grid: Grid, places: Ints, offsets: Ints) -> Graph:
    """Connect the cells at places, (n,) int64, with those of them that are an offset, (k, 3) int64, away."""
    pairs, _ = touching(grid.cells(places), offsets, np.zeros(len(offsets), dtype=np.uint8))
    return of_edges(pairs, places.size)
