"""Stability: how much of their strength a body leaves its joints."""

from __future__ import annotations

from evaluators.blocks.structure import Structure


def stability(structure: Structure) -> float:
    """Give the margin of the joint that is nearest to its strength: 1 - max(load / strength).

    Parameters
    ----------
    structure
        A body and its load.

    Returns
    -------
    float
        At most 1 (nothing carried, or nothing bounded); 0 at the limit, below 0 when unstable; -1 or less for a body of
        which a part floats.
    """
    return float(structure.load.margin)
