"""Scale-free graphs by preferential attachment (Barabasi and Albert 1999)."""

from __future__ import annotations

from typing import Annotated, final

from pydantic import Field

from genome.errors import InputError
from genome.settings import Settings
from orchestrator.topology.drawn import Seed, drawn
from orchestrator.topology.protocol import Ground, Link


@final
class BarabasiAlbert(Settings):
    """Islands come one by one and join those that have many neighbours the more likely.

    Attributes
    ----------
    attach
        Neighbours that each new island takes; it begins with a star of one island more than that.
    seed
        Of the drawing; without, it follows from the run's seed and the channel.
    """

    attach: Annotated[int, Field(ge=1, le=1_000_000)] = 1
    seed: Seed | None = None

    def links(self, ground: Ground) -> list[Link]:
        """Draw the edges, both ways; none for a single island."""
        if ground.count == 1:
            return []
        if self.attach >= ground.count:
            raise InputError("attach", f"at most {ground.count - 1} for {ground.count} islands", str(self.attach))
        import networkx as nx

        return drawn(ground, self.seed, lambda seed: nx.barabasi_albert_graph(ground.count, self.attach, seed), "")
