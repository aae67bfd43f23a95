"""What is measured once of partners in one space, and used by several criteria."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import NDArray

from evaluators.space_syntax import Graph, components
from evaluators.symbiosis import _kernels as kernels
from evaluators.symbiosis.grid import Grid, graph_of, lay_out
from evaluators.symbiosis.network import Network, network
from evaluators.symbiosis.settings import SymbiosisSettings
from growth.blocks.lattice import FACE

if TYPE_CHECKING:
    from evaluators.symbiosis.symbiosis import Symbiosis

Ints = NDArray[np.int64]
Bytes = NDArray[np.uint8]


@final
@dataclass(frozen=True, eq=False)
class Surroundings:
    """Partners on a grid. What is not yet here is measured when it is first asked for.

    It holds nothing that holds it, so that its grids are given back as soon as nobody asks for them.

    Attributes
    ----------
    grid
        Around all of them; arrays of (n,) below are over its places.
    walls
        (n,) uint8, 1 at cells of the enclosure that the space does not carve.
    enclosure, space, route
        (e,), (s,) and (r,) int64, their cells' places, in the order in which they grew.
    settings
        How they are measured.
    """

    grid: Grid
    walls: Bytes
    enclosure: Ints
    space: Ints
    route: Ints
    settings: SymbiosisSettings

    @cached_property
    def free(self) -> Bytes:
        """Give the cells that are no walls: (n,) uint8."""
        return self.grid.cells_only() & (1 - self.walls)

    @cached_property
    def outside(self) -> Bytes:
        """Give the cells that a path from outside reaches, over cells that are no walls: (n,) uint8 (semantics 5)."""
        lattice = self.grid.lattice
        faces = self.settings.passage == "faces"
        offsets = lattice.offsets[lattice.contacts == FACE] if faces else lattice.offsets
        return kernels.reached(self.free, self.grid.inner, self.grid.steps(offsets))

    @cached_property
    def dry(self) -> Bytes:
        """Give the cells that are neither walls nor outside: (n,) uint8."""
        return self.free & (1 - self.outside)

    @cached_property
    def sights(self) -> Bytes:
        """Give the number of the lattice's directions in which a ray from each cell meets a wall: (n,) uint8."""
        return kernels.sights(self.walls, self.grid.inner, self.grid.steps(self.grid.lattice.offsets))

    @property
    def directions(self) -> int:
        """The number of the lattice's directions."""
        return len(self.grid.lattice.offsets)

    @cached_property
    def neighbours(self) -> Graph:
        """Give the space's cells as a graph of the lattice's neighbours."""
        return graph_of(self.grid, self.space, self.grid.lattice.offsets)

    @cached_property
    def parts(self) -> tuple[Ints, Ints]:
        """Give the connected part of each cell of the space, (s,) int64, and how many each has, (p,) int64."""
        return components(self.neighbours)

    @cached_property
    def network(self) -> Network | None:
        """Give the main walkable part of the routes, or of the space where there are none; None without either."""
        walked = self.route if self.route.size else self.space
        return network(self.grid, walked, self.space, self.outside, self.walls) if walked.size else None


def surroundings(symbiosis: Symbiosis) -> Surroundings:
    """Lay partners out on a grid; cells that enclosure and space share are carved out of the walls.

    A :class:`~evaluators.symbiosis.symbiosis.Symbiosis` keeps the result as its own ``surroundings``.

    Raises
    ------
    ValueError
        For partners that are so far apart, or so large, that no grid can be laid around them.
    """
    grid = lay_out(symbiosis.lattice, np.concatenate([symbiosis.enclosure, symbiosis.space, symbiosis.route]))
    enclosure, space, route = map(grid.places, (symbiosis.enclosure, symbiosis.space, symbiosis.route))
    walls = grid.mask(enclosure)
    walls[space] = 0
    return Surroundings(grid, walls, enclosure, space, route, symbiosis.settings)
