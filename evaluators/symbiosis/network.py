"""The part of a route on which one gets about: what it joins, whether it leads out, and through which doors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from evaluators.space_syntax import components
from evaluators.symbiosis.grid import Grid, graph_of

Ints = NDArray[np.int64]
Bytes = NDArray[np.uint8]


class Network(NamedTuple):
    """The main walkable part of a network.

    Attributes
    ----------
    places
        (m,) int64, where its cells are on the grid.
    touched
        (s,) bool, the cells of the space that it shares or that are a walkable step away.
    reaches
        Whether it holds, or touches by a walkable step, a cell outside.
    doors
        How many of its cells lie in walls.
    """

    places: Ints
    touched: NDArray[np.bool_]
    reaches: bool
    doors: int


def network(grid: Grid, walked: Ints, space: Ints, outside: Bytes, walls: Bytes) -> Network:
    """Find the walkable part that touches most cells of the space; of equals, the one that grew first.

    One walks between neighbours that are not straight above each other; doors are open to those who walk.

    Parameters
    ----------
    grid
        Around all.
    walked
        (w,) int64, at least one, the places of the cells that may be walked, in the order in which they grew.
    space
        (s,) int64, the places of the space's cells.
    outside, walls
        (n,) uint8, over the grid's places.
    """
    level = grid.lattice.offsets[grid.lattice.offsets[:, :2].any(axis=1)]
    labels, _ = components(graph_of(grid, walked, level))
    reach = np.concatenate([[0], grid.steps(level)])
    owner = np.zeros(grid.inner.size, dtype=np.int32)
    owner[walked] = labels + 1
    near = np.sort(owner[space[:, np.newaxis] + reach], axis=1)  # (s, steps + 1), 0 for no part
    new = np.diff(near, axis=1, prepend=0) != 0
    main = int(np.bincount(near[new], minlength=labels.max() + 2)[1:].argmax())
    own = walked[labels == main]
    return Network(
        own,
        (near == main + 1).any(axis=1),
        bool(outside[own[:, np.newaxis] + reach].any()),
        int(walls[own].sum()),
    )
