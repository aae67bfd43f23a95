"""The grid: rows and columns with borders."""

from __future__ import annotations

from typing import final

from genome.settings import Settings
from orchestrator.topology.lattice import Side, sides
from orchestrator.topology.protocol import Ground, Link, as_links, both_ways


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
        if ground.count == 1:
            return []
        rows, columns = sides(ground.count, self.rows, self.columns, "line")
        right = ((r * columns + c, r * columns + c + 1) for r in range(rows) for c in range(columns - 1))
        down = ((r * columns + c, (r + 1) * columns + c) for r in range(rows - 1) for c in range(columns))
        return as_links(both_ways([*right, *down]))
