"""The complete graph: every island exchanges with every other."""

from __future__ import annotations

from orchestrator.topology.protocol import Pairs


def complete(count: int) -> Pairs:
    """Give the edges from each island to each other."""
    return [(source, target) for source in range(count) for target in range(count) if source != target]
