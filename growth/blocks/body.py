"""The phenotype of the block engines: cells of a lattice in three systems (Senatore 2009, 'the hierarchy')."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from growth.blocks.lattice import Lattice

Cells = NDArray[np.int64]

INTERNAL: Final = 0
ENVELOPE: Final = 1
BOUNDARY: Final = 2
"""The systems: the skeleton that grew, what wraps it, and the foundation that it stands on."""

SYSTEMS: Final = ("internal", "envelope", "boundary")


@final
@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A body of blocks; no two share a cell.

    Attributes
    ----------
    lattice
        Where its cells are.
    cells
        (n, 3) int64: internal blocks in the order in which they were placed, then those of the envelope, then those of
        the boundary, both in ascending order of their coordinates.
    systems
        (n,) uint8: :data:`INTERNAL`, :data:`ENVELOPE` or :data:`BOUNDARY`.
    """

    lattice: Lattice
    cells: Cells
    systems: NDArray[np.uint8]

    @property
    def internal(self) -> Cells:
        """The skeleton, in the order in which it grew."""
        return np.asarray(self.cells[self.systems == INTERNAL])

    @property
    def envelope(self) -> Cells:
        """What wraps it."""
        return np.asarray(self.cells[self.systems == ENVELOPE])

    @property
    def boundary(self) -> Cells:
        """What it stands on; empty for a body that touches no ground."""
        return np.asarray(self.cells[self.systems == BOUNDARY])
