"""Partners of enclosure and space for tests: shells and rings with known answers, and random ones."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import strategies as st

from evaluators.symbiosis import Symbiosis, SymbiosisSettings
from growth.blocks.lattice import ALL_LATTICES, CUBIC, ISOSPATIAL, SQUARE


def cells(found):
    return np.array(list(found), dtype=np.int64).reshape(-1, 3)


def ball(lattice, radius):
    """The cells within so many steps of the origin."""
    found = {(0, 0, 0): None}
    for _ in range(radius):
        for cell in list(found):
            found.update({tuple(int(v) for v in np.add(cell, offset)): None for offset in lattice.offsets})
    return list(found)


def shell(lattice, radius):
    """The cells at exactly so many steps."""
    inner = ball(lattice, radius - 1)
    return [cell for cell in ball(lattice, radius) if cell not in inner]


def without(found, *gone):
    return [cell for cell in found if cell not in gone]


def partners(enclosure=(), space=(), route=(), lattice=CUBIC, **how):
    return Symbiosis(lattice, cells(enclosure), cells(space), cells(route), SymbiosisSettings(**how))


def mapped(one, change):
    """The same partners with every array of cells changed."""
    return Symbiosis(one.lattice, change(one.enclosure), change(one.space), change(one.route), one.settings)


def symmetries(upright):
    """Rotations and mirrors that map lattices onto themselves: (3, 3) matrices; upright ones keep z's axis."""
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            if not upright or order[2] == 2:
                yield np.diag(signs)[list(order)]


@st.composite
def random_partners(draw):
    """Partners in a box of at most five a side, walls few to many."""
    lattice = draw(st.sampled_from(list(ALL_LATTICES.values())))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    side = draw(st.integers(1, 5))
    depth = 1 if lattice is SQUARE else side
    box = [
        c for c in itertools.product(range(side), range(side), range(depth)) if sum(c) % 2 == 0 or not lattice.parity
    ]

    def some(share):
        chosen = [cell for cell in box if rng.random() < share]
        return [chosen[i] for i in rng.permutation(len(chosen))]

    how = {
        "surrounded": draw(st.sampled_from(["flood", "visibility"])),
        "passage": draw(st.sampled_from(["neighbours", "faces"])),
        "profile": draw(st.sampled_from(["default", "default", "paper"])),
    }
    walls = some(draw(st.sampled_from([0.0, 0.3, 0.7, 0.95])))
    space, route = some(draw(st.sampled_from([0.0, 0.1, 0.4]))), some(draw(st.sampled_from([0.0, 0.0, 0.2])))
    return partners(walls, space, route, lattice, **how)


__all__ = [
    "CUBIC", "ISOSPATIAL", "SQUARE", "ball", "cells", "mapped", "partners", "random_partners", "shell", "symmetries",
    "without",
]  # fmt: skip
