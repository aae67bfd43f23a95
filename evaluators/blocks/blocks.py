"""Blocks: how many a body is made of; few of them for its height make it slender."""

from __future__ import annotations

from evaluators.blocks.structure import Structure


def blocks(structure: Structure) -> float:
    """Count the internal blocks.

    Parameters
    ----------
    structure
        Envelope and boundary do not count.

    Returns
    -------
    float
        A whole number.
    """
    return float(len(structure.body.internal))
