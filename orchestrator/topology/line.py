"""The line: neighbours in a row, both ways; island 0 is one end."""

from __future__ import annotations

from orchestrator.topology.protocol import Pairs, both_ways


def line(count: int) -> Pairs:
    """Give the edges of a line."""
    return both_ways((place, place + 1) for place in range(count - 1))
