"""Height: how many levels a body has above its ground."""

from __future__ import annotations

from evaluators.blocks.structure import Structure


def height(structure: Structure) -> float:
    """Count the levels of the internal blocks, from the lowest to the highest (Senatore 2009, chapter 3).

    The thesis divides by the most that could be, the number of symbols of the longest word. What that is, the body does
    not know: give it as the ``scale`` of the goal.

    Parameters
    ----------
    structure
        Envelope and boundary do not count.

    Returns
    -------
    float
        In units of the lattice: n for a column of n blocks, 1 for a row; 0 without blocks.
    """
    z = structure.body.internal[:, 2]
    return float(z.max() - z.min() + 1) if z.size else 0.0
