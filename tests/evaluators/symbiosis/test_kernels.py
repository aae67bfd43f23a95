"""Kernels over grids larger than what partners of tests fill, against NumPy and SciPy."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from partners import ISOSPATIAL, partners, shell
from scipy import ndimage

from evaluators.symbiosis._kernels import reached, sights
from growth.blocks.lattice import ALL_LATTICES, FACE


@st.composite
def grids(draw):
    """A lattice, walls in a box with its margin, and the shape."""
    lattice = draw(st.sampled_from(list(ALL_LATTICES.values())))
    margin = np.abs(lattice.offsets).max(axis=0)
    inner = [draw(st.integers(1, 30)) if m else 1 for m in margin]
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    walls = np.pad(rng.random(inner) < draw(st.floats(0, 1)), [(m, m) for m in margin]).astype(np.uint8)
    within = np.pad(np.ones(inner, np.uint8), [(m, m) for m in margin])
    return lattice, walls, within


def steps(shape, offsets):
    return offsets @ np.array([shape[1] * shape[2], shape[2], 1])


def moved(grid, offset):
    """What stands an offset further on; nothing beyond the grid."""
    wide = np.pad(grid, 1)
    return wide[tuple(slice(1 + o, 1 + o + size) for o, size in zip(offset, grid.shape, strict=True))]


class TestKernels:
    @settings(max_examples=60)
    @given(grid=grids())
    def test_sights_are_what_shifted_walls_add_up_to(self, grid):
        lattice, walls, within = grid
        expected = np.zeros(walls.shape, np.int64)
        for offset in lattice.offsets.tolist():
            seen = np.zeros_like(walls)
            ahead = walls
            for _ in range(max(walls.shape)):
                ahead = moved(ahead, offset)
                seen |= ahead
            expected += seen
        found = sights(walls.ravel(), within.ravel(), steps(walls.shape, lattice.offsets))
        assert (found.reshape(walls.shape) == expected * within).all()

    @settings(max_examples=60)
    @given(grid=grids(), faces=st.booleans())
    def test_floods_reach_what_is_labelled_with_the_margin(self, grid, faces):
        lattice, walls, within = grid
        offsets = lattice.offsets[lattice.contacts == FACE] if faces else lattice.offsets
        around = np.zeros((3, 3, 3), int)
        around[tuple(offsets.T + 1)] = around[1, 1, 1] = 1
        labels, _ = ndimage.label(1 - walls, around)
        found = reached((1 - walls).ravel(), within.ravel(), steps(walls.shape, offsets)).reshape(walls.shape)
        assert (found == np.isin(labels, labels[within == 0]) * (walls == 0)).all()

    @pytest.mark.parametrize("at", [(0, 0, 0), (5, 4, 3)])
    def test_only_cells_of_the_lattice_are_free(self, at):
        one = partners([tuple(np.add(cell, at)) for cell in shell(ISOSPATIAL, 1)], lattice=ISOSPATIAL).surroundings
        free = one.grid.cells(np.flatnonzero(one.free))
        assert (free.sum(axis=1) % 2 == 0).all()
        low, high = one.grid.low, one.grid.low + one.grid.shape
        box = itertools.product(*map(range, low.tolist(), high.tolist()))
        assert len(free) == sum(sum(cell) % 2 == 0 for cell in box) - 12
