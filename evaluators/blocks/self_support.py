"""Self-support: how much of their strength a body leaves its joints at the worst moment of its growth."""

from __future__ import annotations

from evaluators.blocks.structure import Structure


def self_support(structure: Structure) -> float:
    """Give the smallest margin over the stages of growth (Senatore 2009, 'morphogenesis under load').

    Parameters
    ----------
    structure
        A body and its load, from :func:`evaluators.blocks.load.grown_under_load` with several stages.

    Returns
    -------
    float
        As :func:`evaluators.blocks.stability.stability`, which it equals with one stage.
    """
    return float(min(structure.load.margins))
