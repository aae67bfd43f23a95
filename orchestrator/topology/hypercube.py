"""The hypercube: islands whose places differ in one binary digit exchange."""

from __future__ import annotations

from orchestrator.topology.protocol import Pairs, misfit


def hypercube(count: int) -> Pairs:
    """Give the edges of a hypercube, both ways; none for a single island.

    Raises
    ------
    InputError
        When the number of islands is no power of two.
    """
    if count & (count - 1) or count < 1:
        below = 1 << (count.bit_length() - 1)
        raise misfit(f"{below} or {2 * below}", count, "a hypercube has a power of two")
    digits = [1 << digit for digit in range(count.bit_length() - 1)]
    return [(place, target) for place in range(count) for target in sorted(place ^ digit for digit in digits)]
