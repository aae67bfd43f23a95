"""The wheel: a ring, both ways, around island 0, which exchanges with all of it."""

from __future__ import annotations

from typing import Final

from orchestrator.topology.protocol import Pairs, both_ways, misfit

LEAST: Final = 4
"""A hub and the smallest rim that is a ring."""


def wheel(count: int) -> Pairs:
    """Give the edges of a wheel, both ways; none for a single island.

    Raises
    ------
    InputError
        For two or three islands.
    """
    if count == 1:
        return []
    if count < LEAST:
        raise misfit("4 or more", count, "a hub and a rim of three; or take topology: complete")
    rim = count - 1
    return both_ways([*((0, place + 1) for place in range(rim)), *((p + 1, (p + 1) % rim + 1) for p in range(rim))])
