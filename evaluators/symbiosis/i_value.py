"""Jackson's I: how deep the space's cells lie among each other; the lower, the better integrated (Jackson 2002)."""

from __future__ import annotations

from typing import Final

from evaluators.space_syntax import mean_depth, ra, rra, total_depth
from evaluators.symbiosis.symbiosis import Symbiosis

UNMEASURED: Final = 1.0
"""What a cell without RRA counts: as deep as the root of the diamond that RRA compares with."""


def i_value(symbiosis: Symbiosis) -> float:
    """Give the mean real relative asymmetry of the space's cells, as a graph of neighbours.

    Parameters
    ----------
    symbiosis
        All of the lattice's neighbours are connected. Each connected part is measured by itself, and counts by its
        cells. In parts of one or two cells there is no RRA, and :data:`UNMEASURED` stands in for it.

    Returns
    -------
    float
        0 or more; 0 where all cells of each part touch each other, 1 without space.
    """
    around = symbiosis.surroundings
    if not around.space.size:
        return UNMEASURED
    part, sizes = around.parts
    own = sizes[part]
    real = rra(ra(mean_depth(total_depth(around.neighbours), own), own), own)
    return float(real.filled(UNMEASURED).mean())
