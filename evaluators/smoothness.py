"""Smoothness: how much height changes from vertex to neighbouring vertex. A small value is a smooth form."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from growth.surface import Surface

if TYPE_CHECKING:
    from growth.environment import Environment


def smoothness(surface: Surface, environment: Environment) -> float:  # noqa: ARG001 - every criterion takes both
    """Add the differences in height over all pairs of neighbours (Hemberg 2006, section 5.3).

    The paper sums over each vertex's neighbours and halves the sum, which counts each pair once.

    Parameters
    ----------
    surface
        A form. Edges that join the same two vertices make one pair; an edge from a vertex to itself makes none.
    environment
        Not looked at.

    Returns
    -------
    float
        In the environment's unit, 0 or more; 0 for a level form and for one without edges. The sum is exactly rounded,
        so that it does not depend on the order of vertices or edges.
    """
    low, high = np.sort(surface.edges.astype(np.int64), axis=1).T
    pairs = np.unique(low * len(surface.vertices) + high)
    a, b = np.divmod(pairs, max(len(surface.vertices), 1))
    z = surface.vertices[:, 2]
    return math.fsum(np.abs(z[a] - z[b]).tolist())
