"""Parts: how many connected parts the space has."""

from __future__ import annotations

from evaluators.symbiosis.symbiosis import Symbiosis


def parts(symbiosis: Symbiosis) -> float:
    """Count the connected parts of the space.

    Parameters
    ----------
    symbiosis
        All of the lattice's neighbours are connected, those that share a corner alone too.

    Returns
    -------
    float
        A whole number; 0 without space.
    """
    _, sizes = symbiosis.surroundings.parts
    return float(sizes.size)
