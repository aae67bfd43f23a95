"""No edges at all: islands that are meant to be alone."""

from __future__ import annotations

from orchestrator.topology.protocol import Pairs


def unconnected(count: int) -> Pairs:
    """Give no edges, whatever the number of islands."""
    del count
    return []
