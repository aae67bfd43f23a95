"""One figure for a whole graph: its mean real relative asymmetry, Jackson's I (Jackson 2002; Hillier 1996)."""

from __future__ import annotations

from typing import Final

from evaluators.space_syntax.asymmetry import ra, rra
from evaluators.space_syntax.depth import mean_depth, total_depth
from evaluators.space_syntax.graph import Graph, components

UNMEASURED: Final = 1.0
"""What a space without RRA counts: as deep as the root of the diamond that RRA compares with."""


def mean_rra(graph: Graph) -> float:
    """Give the mean RRA of all spaces; the lower, the better integrated.

    Parameters
    ----------
    graph
        Each connected part is measured by itself, and counts by its spaces. In parts of one or two spaces there is no
        RRA, and :data:`UNMEASURED` stands in for it.

    Returns
    -------
    float
        0 or more; 0 where all spaces of each part touch each other, 1 without spaces.
    """
    part, sizes = components(graph)
    if not part.size:
        return UNMEASURED
    own = sizes[part]
    real = rra(ra(mean_depth(total_depth(graph), own), own), own)
    return float(real.filled(UNMEASURED).mean())
