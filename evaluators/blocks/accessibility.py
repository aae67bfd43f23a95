"""Accessibility: how well each block is reached from its neighbours."""

from __future__ import annotations

from typing import Final

import numpy as np

from evaluators.blocks import _kernels as kernels
from evaluators.blocks.structure import Structure
from growth.blocks.body import BOUNDARY

WEIGHTS: Final = (1.0, 0.5, 0.25)
"""Of a neighbour over a face, an edge and a vertex."""


def accessibility(structure: Structure) -> float:
    """Weigh the contacts of each block, as a share of a block's that is enclosed all round (Senatore 2009, chapter 3).

    The thesis wants more neighbours over faces to count for more, and finds slender towers badly integrated: so it is
    the sum of the contacts' weights that counts, not their mean, and a whole neighbourhood is the norm (6 faces, 12
    edges and 8 vertices weigh 14 on the cubic lattice, 12 faces 12 on the iso-spatial one).

    Parameters
    ----------
    structure
        Internal blocks and envelope; contacts with the boundary do not count.

    Returns
    -------
    float
        The mean over all blocks, 0 to 1; 0 for a single block or none.
    """
    body = structure.body
    cells = np.ascontiguousarray(body.cells[body.systems != BOUNDARY])
    if not len(cells):
        return 0.0
    weights = np.array(WEIGHTS)
    _, kinds = kernels.touching(cells, body.lattice.offsets, body.lattice.contacts)
    return float(2.0 * weights[kinds].sum() / (len(cells) * weights[body.lattice.contacts].sum()))
