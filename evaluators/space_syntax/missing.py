"""Figures that some spaces have no value of: masked arrays, never NaN."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Values: TypeAlias = "np.ma.MaskedArray[tuple[Any, ...], np.dtype[np.float64]]"
"""(n,) float64, masked where a space has no value; ``filled(x)`` and ``tolist()``, which gives None, are ways out."""


def masked(values: NDArray[np.float64], missing: NDArray[np.bool_]) -> Values:
    """Mask values, 0 beneath the mask."""
    return np.ma.MaskedArray(np.where(missing, 0.0, values), mask=missing)
