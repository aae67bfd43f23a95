"""The part of a route on which one gets about: what it joins, whether it leads out, and through which doors."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from evaluators.symbiosis.parts import labelled

if TYPE_CHECKING:
    from evaluators.symbiosis.surroundings import Surroundings
    from evaluators.symbiosis.symbiosis import Symbiosis

Ints = NDArray[np.int64]


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


def network(symbiosis: Symbiosis, around: Surroundings) -> Network | None:
    """Find the walkable part that touches most cells of the space; of equals, the one that grew first.

    One walks between neighbours that are not straight above each other. The network is the route species' cells, or
    the space's own where there is no route. Doors are open to those who walk.

    Returns
    -------
    Network or None
        None where there is neither route nor space.
    """
    cells = symbiosis.route if len(symbiosis.route) else symbiosis.space
    if not len(cells):
        return None
    lattice, grid = symbiosis.lattice, around.grid
    level = lattice.offsets[:, :2].any(axis=1)
    places = grid.places(cells)
    labels = labelled(cells, lattice.offsets[level], lattice.contacts[level])
    reach = np.concatenate([[0], grid.steps(lattice.offsets[level])])
    owner = np.zeros(grid.inner.size, dtype=np.int32)
    owner[places] = labels + 1
    near = np.sort(owner[around.space[:, np.newaxis] + reach], axis=1)  # (s, steps + 1), 0 for no part
    new = np.diff(near, axis=1, prepend=0) != 0
    main = int(np.bincount(near[new], minlength=labels.max() + 2)[1:].argmax())
    own = places[labels == main]
    return Network(
        own,
        (near == main + 1).any(axis=1),
        bool(around.outside[own[:, np.newaxis] + reach].any()),
        int(around.walls[own].sum()),
    )
