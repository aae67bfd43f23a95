"""Span: how far a body reaches along a horizontal axis."""

from __future__ import annotations

from evaluators.blocks.structure import Structure


def span_x(structure: Structure) -> float:
    """Give how many cells the internal blocks reach over along x (Senatore 2009, bridge structures).

    Parameters
    ----------
    structure
        Envelope and boundary do not count.

    Returns
    -------
    float
        In units of the lattice: n for a row of n blocks, 1 for a column; 0 without blocks.
    """
    return _reach(structure, 0)


def span_y(structure: Structure) -> float:
    """Give how many cells the internal blocks reach over along y; as :func:`span_x` otherwise.

    Returns
    -------
    float
        In units of the lattice.
    """
    return _reach(structure, 1)


def _reach(structure: Structure, axis: int) -> float:
    at = structure.body.internal[:, axis]
    return float(at.max() - at.min() + 1) if at.size else 0.0
