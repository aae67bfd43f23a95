"""Parts: how many connected parts the space has."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks._kernels import touching

if TYPE_CHECKING:
    from evaluators.symbiosis.symbiosis import Symbiosis

Ints = NDArray[np.int64]


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
    labels = labelled(symbiosis.space, symbiosis.lattice.offsets, symbiosis.lattice.contacts)
    return float(labels.max(initial=-1) + 1)


def labelled(cells: Ints, offsets: Ints, contacts: NDArray[np.uint8]) -> Ints:
    """Give the connected part that each cell belongs to: (n,) int64, numbered in the order of their first cells.

    Parameters
    ----------
    cells
        (n, 3) int64, no two alike.
    offsets, contacts
        (k, 3) int64 and (k,) uint8, those of a lattice that connect.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    pairs, _ = touching(cells, offsets, contacts)
    joined = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(cells), len(cells)))
    if not len(cells):
        return np.empty(0, dtype=np.int64)
    _, found = connected_components(joined, directed=False)
    _, first, labels = np.unique(found, return_index=True, return_inverse=True)
    rank = np.empty(first.size, dtype=np.int64)
    rank[np.argsort(first)] = np.arange(first.size)
    return np.asarray(rank[labels])
