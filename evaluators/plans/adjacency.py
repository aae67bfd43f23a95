"""Whether the rooms that want to be adjacent are, and how far apart the others lie."""

from __future__ import annotations

import math

from evaluators.plans.layout import Layout


def adjacency(layout: Layout) -> float:
    """Sum the walls crossed between rooms that want to be adjacent, each times its weight (semantics.md, section 3).

    The least is the sum of the weights: an adjacent room is one wall away. 0 where nothing is wanted.
    """
    number = {name: k for k, name in enumerate(layout.brief.rooms)}
    return math.fsum(
        one.weight * float(layout.far[number[one.first], number[one.second]]) for one in layout.brief.adjacencies
    )


def met(layout: Layout) -> float:
    """Give the share of the wanted adjacencies that are met, by weight: 1 where all are, and where none is wanted."""
    wanted = layout.brief.adjacencies
    if not wanted:
        return 1.0
    number = {name: k for k, name in enumerate(layout.brief.rooms)}
    good = [one.weight for one in wanted if layout.far[number[one.first], number[one.second]] == 1]
    return math.fsum(good) / math.fsum(one.weight for one in wanted)
