"""How far a form reaches along each axis, which several criteria and the symmetry's tolerance are made of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from growth.surface import Surface


def extents(surface: Surface) -> NDArray[np.float64]:
    """Give the largest minus the smallest coordinate along x, y and z.

    Parameters
    ----------
    surface
        A form.

    Returns
    -------
    (3,) float64
        In the environment's unit; zeros for a single vertex.

    Raises
    ------
    ValueError
        For a form without vertices.
    """
    if not len(surface.vertices):
        raise ValueError("the form has no vertices")
    reach: NDArray[np.float64] = np.ptp(surface.vertices, axis=0)
    return reach
