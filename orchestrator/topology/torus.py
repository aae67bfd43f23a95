"""The torus: rows and columns, each of them closed to a ring."""

from __future__ import annotations

from typing import final

from genome.settings import Settings
from orchestrator.topology.lattice import Side, sides
from orchestrator.topology.protocol import Ground, Link, as_links, both_ways


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
        if ground.count == 1:
            return []
        rows, columns = sides(ground.count, self.rows, self.columns, "bidirectional_ring")
        right = ((r * columns + c, r * columns + (c + 1) % columns) for r in range(rows) for c in range(columns))
        down = ((r * columns + c, (r + 1) % rows * columns + c) for r in range(rows) for c in range(columns))
        return as_links(both_ways([*right, *down]))
