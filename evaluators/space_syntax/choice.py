"""Choice: how much of the way between others leads through a space (Hillier et al. 1987; Freeman's betweenness)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluators.space_syntax import _kernels as kernels
from evaluators.space_syntax.graph import Graph
from evaluators.space_syntax.missing import Values, masked


def choice(graph: Graph) -> NDArray[np.float64]:
    """Give, over all unordered pairs of other spaces, the sum of the shares of their shortest paths through each space.

    Returns
    -------
    (n,) float64
        Not normalised: (k - 1)(k - 2) / 2 for the centre of a star of k spaces, 0 at the ends.
    """
    return kernels.between(graph.starts, graph.neighbours)


def choice_share(through: NDArray[np.float64], sizes: NDArray[np.int64]) -> Values:
    """Give choice over the number (k - 1)(k - 2) / 2 of pairs of others in the component: 0 to 1, (n,) masked float64.

    Parameters
    ----------
    through, sizes
        (n,), choice and k; without a value for k of 2 or less.
    """
    pairs = (sizes - 1) * (sizes - 2) / 2.0
    return masked(through / np.maximum(pairs, 1.0), sizes <= 2)
