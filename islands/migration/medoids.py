"""k medoids: so many members that stand for all, each other one being near to one of them (PAM).

Kaufman and Rousseeuw 1990, "Finding groups in data": medoids are first built up one by one, then swapped with others as
long as the sum of the distances falls.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SWAPS: Final = 100
"""Swaps at most; far more than demes of some hundred members need."""

GAIN: Final = 1e-9
"""A swap has to lower the sum by more than this share of it: sums of equal terms may differ by some bits."""


def medoids(apart: Floats, count: int) -> list[int]:
    """Choose medoids.

    Parameters
    ----------
    apart
        (n, n) float64, symmetric distances from 0.
    count
        How many, from 0 to n.

    Returns
    -------
    Their places, ascending; of equal choices the first.
    """
    if count <= 0:
        return []
    chosen = [int(apart.sum(axis=1).argmin())]
    nearest = apart[chosen[0]].copy()
    while len(chosen) < count:
        gain = np.maximum(nearest[:, None] - apart, 0.0).sum(axis=0)
        gain[chosen] = -1.0
        chosen.append(int(gain.argmax()))
        np.minimum(nearest, apart[chosen[-1]], out=nearest)
    for _ in range(SWAPS):
        total = float(apart[chosen].min(axis=0).sum())
        best, place, other = _best_swap(apart, chosen)
        if best >= total * (1.0 - GAIN):
            break
        chosen[place] = other
    return sorted(chosen)


def _best_swap(apart: Floats, chosen: list[int]) -> tuple[float, int, int]:
    """Give the least sum that a swap of one medoid for another member makes, which medoid, and which member."""
    found = (np.inf, 0, chosen[0])
    for place in range(len(chosen)):
        rest = [one for k, one in enumerate(chosen) if k != place]
        left = apart[rest].min(axis=0) if rest else np.full(len(apart), np.inf)
        sums = np.minimum(left, apart).sum(axis=1)
        sums[chosen] = np.inf
        other = int(sums.argmin())
        if sums[other] < found[0]:
            found = (float(sums[other]), place, other)
    return found
