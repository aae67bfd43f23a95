"""Size: how far the form reaches in plan."""

from __future__ import annotations

from typing import TYPE_CHECKING

from evaluators.extent import extents
from growth.surface import Surface

if TYPE_CHECKING:
    from growth.environment import Environment


def size(surface: Surface, environment: Environment) -> float:  # noqa: ARG001 - every criterion takes both
    """Add the extents along x and y (Hemberg 2006, section 5.3).

    Parameters
    ----------
    surface
        A form; its height does not count.
    environment
        Not looked at.

    Returns
    -------
    float
        In the environment's unit, 0 or more; 0 for a single vertex.

    Raises
    ------
    ValueError
        For a form without vertices.
    """
    x, y, _ = extents(surface)
    return float(x + y)
