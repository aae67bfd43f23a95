"""The torus: rows and columns, each of them closed to a ring."""

from __future__ import annotations

from typing import final

from genome.settings import Settings
from orchestrator.topology.lattice import Side, laid
from orchestrator.topology.protocol import Ground, Link


@final
class Torus(Settings):
    """Each island exchanges with the next and the one before in its row and in its column.

    Of two rows (or columns) these are the same, so an island has one neighbour there.

    Attributes
    ----------
    rows, columns
        Of the lattice, filled row by row; what is not given is chosen nearest to square.
    """

    rows: Side | None = None
    columns: Side | None = None

    def links(self, ground: Ground) -> list[Link]:
        """Give the edges, both ways; none for a single island."""
        return laid(ground, self.rows, self.columns, "bidirectional_ring", closed=True)
