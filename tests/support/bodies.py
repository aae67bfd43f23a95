"""Bodies of blocks for tests: shapes with known loads, and random ones."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import strategies as st

from growth.blocks.body import BOUNDARY, ENVELOPE, INTERNAL, Body
from growth.blocks.lattice import CUBIC


def body(internal, boundary=None, envelope=(), lattice=CUBIC):
    """Make a body; without a boundary it stands on the cells beneath its lowest blocks."""
    inner = [tuple(cell) for cell in internal]
    if boundary is None:
        lowest = min((z for _, _, z in inner), default=0)
        below = {
            tuple(np.add(cell, lattice.offsets[k])) for cell in inner if cell[2] == lowest for k in lattice.beneath
        }
        boundary = sorted(tuple(int(v) for v in cell) for cell in below)
    cells = [*inner, *sorted(envelope), *sorted(boundary)]
    systems = [INTERNAL] * len(inner) + [ENVELOPE] * len(envelope) + [BOUNDARY] * len(boundary)
    return Body(lattice, np.array(cells, np.int64).reshape(-1, 3), np.array(systems, np.uint8))


def column(n, x=0, y=0):
    return [(x, y, z) for z in range(n)]


def cantilever(n):
    """A row of blocks out of a wall at x = -1."""
    return body([(x, 0, 0) for x in range(n)], boundary=[(-1, 0, 0)])


def mirrored(one, axis=0):
    """The mirror image of a body in a plane through the origin."""
    cells = one.cells.copy()
    cells[:, axis] *= -1
    return Body(one.lattice, cells, one.systems)


def walk(rng, count, lattice=CUBIC, branch=0.15, straight=0.6):
    """Grow internal cells by a random walk that goes straight on, turns, or starts anew from an earlier block."""
    cells = [(0, 0, 0)]
    seen = {cells[0]}
    at, way = cells[0], lattice.heading
    while len(cells) < count:
        if rng.random() < branch:
            at = cells[rng.integers(len(cells))]
        if rng.random() > straight:
            way = int(rng.integers(len(lattice.offsets)))
        at = tuple(int(v) for v in np.add(at, lattice.offsets[way]))
        if at not in seen:
            seen.add(at)
            cells.append(at)
    return cells


@st.composite
def bodies(draw, most=40, lattice=CUBIC):
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return body(walk(rng, draw(st.integers(1, most)), lattice), lattice=lattice)


def grid(nx, ny, nz):
    return list(itertools.product(range(nx), range(ny), range(nz)))
