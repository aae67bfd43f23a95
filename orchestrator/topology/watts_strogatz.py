"""Small worlds: a ring of neighbours with some edges laid elsewhere (Watts and Strogatz 1998)."""

from __future__ import annotations

from typing import Annotated, final

from pydantic import Field

from genome.errors import InputError
from genome.settings import Settings
from islands.settings import Probability
from orchestrator.topology.drawn import Seed, drawn
from orchestrator.topology.protocol import Ground, Link


@final
class WattsStrogatz(Settings):
    """A ring in which each island exchanges with its nearest, half of them on each side, and edges are rewired.

    Attributes
    ----------
    neighbours
        Of each island in the ring; an even number, less than there are islands.
    rewiring
        The probability that an edge's far end is laid to an island drawn at random.
    seed
        Of the drawing; without, it follows from the run's seed and the channel.
    """

    neighbours: Annotated[int, Field(ge=2, le=1_000_000)] = 4
    rewiring: Probability = 0.1
    seed: Seed | None = None

    def links(self, ground: Ground) -> list[Link]:
        """Draw the edges, both ways; none for a single island."""
        if ground.count == 1:
            return []
        if self.neighbours % 2 or self.neighbours >= ground.count:
            most = (ground.count - 1) // 2 * 2
            if most < 2:
                raise InputError("", "3 or more islands", str(ground.count), "or take topology: line")
            expected = f"an even number, at most {most} for {ground.count} islands"
            raise InputError("neighbours", expected, str(self.neighbours))
        import networkx as nx

        def draw(seed: int) -> nx.Graph[int]:
            return nx.watts_strogatz_graph(ground.count, self.neighbours, self.rewiring, seed)

        return drawn(ground, self.seed, draw, "take more neighbours or less rewiring")
