"""Undulation: how far the form reaches in height, taken over the whole of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from evaluators.extent import extents
from growth.surface import Surface

if TYPE_CHECKING:
    from growth.environment import Environment


def undulation(surface: Surface, environment: Environment) -> float:  # noqa: ARG001 - every criterion takes both
    """Give the extent along z (Hemberg 2006, section 5.3).

    Parameters
    ----------
    surface
        A form.
    environment
        Not looked at.

    Returns
    -------
    float
        In the environment's unit, 0 or more; 0 for a form that lies level.

    Raises
    ------
    ValueError
        For a form without vertices.
    """
    return float(extents(surface)[2])
