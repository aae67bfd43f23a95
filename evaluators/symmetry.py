"""Symmetry: whether as many vertices lie on one side of the form's middle as on the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from evaluators.extent import extents
from growth.surface import Surface

if TYPE_CHECKING:
    from growth.environment import Environment

ON_THE_LINE = 1e-9
"""How near a vertex must be to the line to count on both sides, as a share of the form's largest extent."""


def symmetry(surface: Surface, environment: Environment) -> float:  # noqa: ARG001 - every criterion takes both
    """Average the balance about a line parallel to x and about one parallel to y (Hemberg 2006, section 5.3).

    Both lines run through the mean of all vertices, seen from above. A line's balance is the smaller over the larger
    number of vertices on its two sides; the paper leaves open which is divided by which, and where the centre is.

    Parameters
    ----------
    surface
        A form.
    environment
        Not looked at.

    Returns
    -------
    float
        From 0 to 1; 1 where both lines have as many vertices on either side, and for a single vertex. Vertices on a
        line count on both sides of it.

    Raises
    ------
    ValueError
        For a form without vertices.
    """
    tolerance = ON_THE_LINE * float(extents(surface).max())
    x, y, _ = surface.vertices.T
    return (_balance(y, tolerance) + _balance(x, tolerance)) / 2


def _balance(values: NDArray[np.float64], tolerance: float) -> float:
    """Give the smaller over the larger count of values on either side of their mean."""
    if tolerance == 0:
        return 1.0
    from_first = values - values[0]  # far from the origin a plain mean would be rounded by more than the tolerance
    offset = from_first - from_first.mean()
    below, above = int((offset <= tolerance).sum()), int((offset >= -tolerance).sum())
    return min(below, above) / max(below, above)
