"""What a space has to do with its neighbours alone: how many there are, and how much it controls the way to them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluators.space_syntax.graph import Graph


def connectivity(graph: Graph) -> NDArray[np.int64]:
    """Give the number of each space's neighbours: (n,) int64."""
    return np.diff(graph.starts)


def control(graph: Graph) -> NDArray[np.float64]:
    """Give what each space is given when every space shares 1 equally among its neighbours (Hillier and Hanson 1984).

    Returns
    -------
    (n,) float64
        The sum over the neighbours of 1 / their connectivity; 0 without any. All add up to the number of spaces that
        have neighbours.
    """
    degree = connectivity(graph)
    owner = np.repeat(np.arange(graph.count), degree)
    given = np.bincount(owner, weights=1.0 / degree[graph.neighbours], minlength=graph.count)
    return given.astype(np.float64)
