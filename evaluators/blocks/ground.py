"""Ground: on how many blocks a body stands."""

from __future__ import annotations

import numpy as np

from evaluators.blocks.load.layers import layers
from evaluators.blocks.structure import Structure
from growth.blocks.body import INTERNAL


def ground(structure: Structure) -> float:
    """Count the internal blocks that touch the boundary (Senatore 2009, bridge structures: 'contacts with the ground').

    Parameters
    ----------
    structure
        Whatever the joint is over: a face, an edge or a vertex.

    Returns
    -------
    float
        A whole number; 0 for a body that touches no boundary.
    """
    body = structure.body
    return float(np.count_nonzero((layers(body).depth == 1) & (body.systems == INTERNAL)))
