"""The phenotypes: a room's cells, and a plan of rooms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from growth.polyforms.tiling import Tiling

Ints = NDArray[np.int64]


@final
@dataclass(frozen=True, slots=True, eq=False)
class Polyform:
    """A form of cells that is a disc, of cubes a ball.

    Attributes
    ----------
    tiling
        What its cells are.
    cells
        (n, 3) int64, distinct, in the order in which they were placed.
    """

    tiling: Tiling
    cells: Ints


@final
@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """Rooms conjoined to a zone, or to a house; the whole is a disc, and each room too.

    Attributes
    ----------
    tiling
        What its cells are.
    cells
        (n, 3) int64, distinct: the cells of the first room, of the second, ...
    rooms
        (n,) int64, the number of each cell's room, ascending from 0.
    """

    tiling: Tiling
    cells: Ints
    rooms: Ints

    @property
    def count(self) -> int:
        """How many rooms it has."""
        return int(self.rooms[-1]) + 1
