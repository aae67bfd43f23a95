"""The grid: rows and columns with borders."""

from __future__ import annotations

from typing import final

from genome.settings import Settings
from orchestrator.topology.lattice import Side, laid
from orchestrator.topology.protocol import Ground, Link


@final
class Grid(Settings):
    """Each island exchanges with its neighbours to the left, right, above and below.

    Attributes
    ----------
    rows, columns
        Of the lattice, filled row by row; what is not given is chosen nearest to square.
    """

    rows: Side | None = None
    columns: Side | None = None

    def links(self, ground: Ground) -> list[Link]:
        """Give the edges, both ways; none for a single island."""
        return laid(ground, self.rows, self.columns, "line", closed=False)
