"""Flood fill and visibility on a grid of 64 x 64 x 64 cells, against SciPy's labelling of it over 26 neighbours.

Walls are drawn at several densities, or are a real shell, three cells thick, within the grid. Limit: either takes at
most twice the time of `scipy.ndimage.label`.
"""

from __future__ import annotations

import itertools

import numpy as np
from scipy import ndimage

from benchmarks.timing import best_of
from evaluators.symbiosis import Symbiosis, SymbiosisSettings, surroundings
from evaluators.symbiosis._kernels import reached, sights
from growth.blocks.lattice import CUBIC

SIDE = 64
DENSITIES = (0.01, 0.05, 0.2, 0.5, 0.8, 0.95)
LIMIT = 2.0
NOBODY = np.empty((0, 3), dtype=np.int64)


def walls() -> dict[str, np.ndarray]:
    """Give the cells of each enclosure; the corners of the grid are always among them."""
    everywhere = np.array(list(itertools.product(range(SIDE), repeat=3)))
    rng = np.random.default_rng(6)
    corners = ((everywhere == 0) | (everywhere == SIDE - 1)).all(axis=1)
    drawn = {f"{share:g} walls": everywhere[(rng.random(len(everywhere)) < share) | corners] for share in DENSITIES}
    away = np.linalg.norm(everywhere - (SIDE - 1) / 2.0, axis=1)
    return {**drawn, "a shell": everywhere[((away > 22.0) & (away < 25.0)) | corners]}


def ratios(cells: np.ndarray) -> tuple[float, float, float]:
    """Give SciPy's time in seconds, and those of flood and visibility as multiples of it."""
    around = surroundings(Symbiosis(CUBIC, cells, NOBODY, NOBODY, SymbiosisSettings()))
    grid, free = around.grid, around.free
    steps = grid.steps(CUBIC.offsets)
    inside = np.ascontiguousarray(free.reshape(grid.shape)[1:-1, 1:-1, 1:-1])
    assert inside.shape == (SIDE, SIDE, SIDE)
    every = np.ones((3, 3, 3))
    theirs, flood, seen = best_of(
        lambda: ndimage.label(inside, every),
        lambda: reached(free, grid.inner, steps),
        lambda: sights(around.walls, grid.inner, steps),
    )
    return theirs, flood / theirs, seen / theirs


def main() -> bool:
    """Print times and ratios; tell whether all are within their limits."""
    worst = 0.0
    for name, cells in walls().items():
        theirs, flood, seen = ratios(cells)
        worst = max(worst, flood, seen)
        print(
            f"symbiosis_measures: {name}: label {theirs * 1e3:.2f} ms, flood {flood:.2f}, visibility {seen:.2f} of it"
        )
    print(f"symbiosis_measures: at most {worst:.2f} times SciPy's labelling (limit {LIMIT:g})")
    return worst <= LIMIT


if __name__ == "__main__":
    raise SystemExit(not main())
