"""What criteria of symbiotic species see: the cells of all partners in one space."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, Literal, final

import numpy as np
from numpy.typing import NDArray

from evaluators.symbiosis.settings import SymbiosisSettings
from evaluators.symbiosis.surroundings import Surroundings, surroundings
from growth.blocks.lattice import Lattice

Cells = NDArray[np.int64]
Role = Literal["enclosure", "space", "route"]

ROLES: Final[tuple[Role, ...]] = ("enclosure", "space", "route")
"""The species: wall systems, the space that is used, and the way through it."""


@final
@dataclass(frozen=True, eq=False)
class Symbiosis:
    """Partners of several species in one space; each species' cells are distinct, two species may share a cell.

    Attributes
    ----------
    lattice
        Of all.
    enclosure, space, route
        (n, 3) int64, cells of the lattice, which is not checked, in the order in which they grew; empty for a species
        that has nobody here.
    settings
        How they are measured.
    """

    lattice: Lattice
    enclosure: Cells
    space: Cells
    route: Cells
    settings: SymbiosisSettings

    @cached_property
    def surroundings(self) -> Surroundings:
        """Give what is measured once and used by several criteria; ValueError where partners span too large a box."""
        return surroundings(self)
