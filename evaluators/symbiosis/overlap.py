"""Overlap: how much of the space lies in the enclosure's own cells."""

from __future__ import annotations

import numpy as np

from evaluators.symbiosis.symbiosis import Symbiosis


def overlap(symbiosis: Symbiosis) -> float:
    """Give the share of the space's cells that are cells of the enclosure too, and carve it.

    Parameters
    ----------
    symbiosis
        Routes do not count.

    Returns
    -------
    float
        0 to 1; 0 without space.
    """
    around = symbiosis.surroundings
    return float(np.isin(around.space, around.enclosure).mean()) if around.space.size else 0.0
