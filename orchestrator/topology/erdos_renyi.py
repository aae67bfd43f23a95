"""Random graphs in which each two islands exchange with one probability (Gilbert 1959; Erdos and Renyi 1959)."""

from __future__ import annotations

import math
from typing import Annotated, final

from pydantic import Field

from genome.settings import Settings
from orchestrator.topology.drawn import Seed, drawn
from orchestrator.topology.protocol import Ground, Link


@final
class ErdosRenyi(Settings):
    """Each pair of islands exchanges or does not, whatever the others do.

    Attributes
    ----------
    probability
        That a pair exchanges.
    seed
        Of the drawing; without, it follows from the run's seed and the channel.
    """

    probability: Annotated[float, Field(gt=0, le=1)] = 0.5
    seed: Seed | None = None

    def links(self, ground: Ground) -> list[Link]:
        """Draw the edges, both ways; none for a single island."""
        if ground.count == 1:
            return []
        import networkx as nx

        def draw(seed: int) -> nx.Graph[int]:
            return nx.fast_gnp_random_graph(ground.count, self.probability, seed)

        # Graphs of that probability are connected about as often as not (Erdos and Renyi 1959).
        enough = min(1.0, math.log(ground.count) / ground.count)
        return drawn(ground, self.seed, draw, f"take a probability of {enough:.2g} or more, or unreached: allow")
