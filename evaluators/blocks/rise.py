"""Rise: the height of every block, the thesis' second reading of height."""

from __future__ import annotations

from evaluators.blocks.structure import Structure


def rise(structure: Structure) -> float:
    """Add up the levels of all internal blocks (Senatore 2009, chapter 3).

    Parameters
    ----------
    structure
        Envelope and boundary do not count.

    Returns
    -------
    float
        The lowest level counts 1, the next 2: n (n + 1) / 2 for a column of n blocks, n for a row; 0 without blocks.
    """
    z = structure.body.internal[:, 2]
    return float((z - z.min() + 1).sum()) if z.size else 0.0
