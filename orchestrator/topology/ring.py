"""The ring: each island sends to the next, the last to the first."""

from __future__ import annotations

from orchestrator.topology.protocol import Pairs


def ring(count: int) -> Pairs:
    """Give the edges of a ring; none for a single island.

    Parameters
    ----------
    count
        How many islands there are.

    Returns
    -------
    Pairs of source and target, from 0.
    """
    return [(place, (place + 1) % count) for place in range(count)] if count > 1 else []
