"""The ring in both directions: each island sends to both of its neighbours."""

from __future__ import annotations

from orchestrator.topology.protocol import Pairs, both_ways
from orchestrator.topology.ring import ring


def bidirectional_ring(count: int) -> Pairs:
    """Give the edges of a ring, both ways; two islands have one edge each way."""
    return both_ways(ring(count))
