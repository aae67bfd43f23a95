"""The star: island 0 is the hub, all others exchange with it alone."""

from __future__ import annotations

from orchestrator.topology.protocol import Pairs, both_ways


def star(count: int) -> Pairs:
    """Give the edges of a star, both ways."""
    return both_ways((0, place) for place in range(1, count))
