"""Asymmetry: how deep a space lies in its graph, less what the graph's size alone makes of it.

Formulas after Hillier and Hanson 1984, as semantics.md section 3 has them; k is the number of spaces in the component.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluators.space_syntax.missing import Values, masked

Ints = NDArray[np.int64]


def ra(mean: Values, sizes: Ints) -> Values:
    """Give the relative asymmetry RA = 2 (MD - 1) / (k - 2), 0 for the shallowest space and 1 for the deepest.

    Parameters
    ----------
    mean
        (n,), MD of each space.
    sizes
        (n,), k of its component; without a value for k of 2 or less.
    """
    return masked(2.0 * (mean.filled(1.0) - 1.0) / np.maximum(sizes - 2, 1), sizes <= 2)


def d_value(size: int) -> float | None:
    """Give D_k = 2 (k (log2((k + 2) / 3) - 1) + 1) / ((k - 1)(k - 2)), the RA of a diamond-shaped graph at its root.

    Returns
    -------
    float or None
        .3520 for k = 5, .3056 for k = 10; None for k of 2 or less.
    """
    return None if size <= 2 else float(_d(np.array([size], dtype=np.int64))[0])


def rra(relative: Values, sizes: Ints) -> Values:
    """Give the real relative asymmetry RRA = RA / D_k; 1 where a space is as deep as the root of a diamond.

    Parameters
    ----------
    relative, sizes
        (n,), RA and k, as for :func:`ra`.
    """
    return masked(relative.filled(0.0) / _d(np.maximum(sizes, 3)), sizes <= 2)


def integration(real: Values) -> Values:
    """Give 1 / RRA, infinite for a space that is next to all others (a star's centre): (n,) masked float64."""
    missing = np.ma.getmaskarray(real)
    asymmetry = real.filled(1.0)
    inverse = np.full(asymmetry.shape, np.inf)
    np.divide(1.0, asymmetry, out=inverse, where=asymmetry > 0.0)
    return masked(inverse, missing)


def _d(sizes: Ints) -> NDArray[np.float64]:
    k = sizes.astype(np.float64)
    return np.asarray(2.0 * (k * (np.log2((k + 2.0) / 3.0) - 1.0) + 1.0) / ((k - 1.0) * (k - 2.0)))
