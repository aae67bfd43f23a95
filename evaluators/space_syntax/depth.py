"""Depth: how many steps away a space's others are (Hillier and Hanson 1984)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluators.space_syntax import _kernels as kernels
from evaluators.space_syntax.graph import Graph
from evaluators.space_syntax.missing import Values, masked

Ints = NDArray[np.int64]


def total_depth(graph: Graph) -> Ints:
    """Give the sum TD of the least numbers of steps from each space to all others of its component: (n,) int64."""
    return kernels.depths(graph.starts, graph.neighbours)


def mean_depth(total: Ints, sizes: Ints) -> Values:
    """Give MD = TD / (k - 1): (n,) masked float64.

    Parameters
    ----------
    total
        (n,), TD of each space.
    sizes
        (n,), the number k of spaces in its component, itself among them; without a value for k = 1.
    """
    return masked(total / np.maximum(sizes - 1, 1), sizes < 2)
