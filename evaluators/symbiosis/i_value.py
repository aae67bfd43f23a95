"""Jackson's I: how deep the space's cells lie among each other; the lower, the better integrated (Jackson 2002)."""

from __future__ import annotations

from evaluators.space_syntax import mean_rra
from evaluators.symbiosis.symbiosis import Symbiosis


def i_value(symbiosis: Symbiosis) -> float:
    """Give the mean real relative asymmetry of the space's cells, as a graph of neighbours.

    Parameters
    ----------
    symbiosis
        All of the lattice's neighbours are connected.

    Returns
    -------
    float
        As of :func:`~evaluators.space_syntax.mean_rra.mean_rra`: 0 where all cells of each part touch each other, 1
        without space.
    """
    return mean_rra(symbiosis.surroundings.neighbours)
