"""Soft boundaries: how many vertices have grown through boundaries that let them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from growth.surface import Surface

if TYPE_CHECKING:
    from growth.environment import Environment


def soft_boundaries(surface: Surface, environment: Environment) -> float:
    """Count the vertices on the wrong side of soft boundaries (Hemberg 2006, section 5.3).

    The paper calls it a penalty for each node; give it the goal ``minimise`` to make it one.

    Parameters
    ----------
    surface
        A form.
    environment
        Its soft boundaries are asked; a vertex on the wrong side of two of them counts twice.

    Returns
    -------
    float
        A whole number, 0 where there are no soft boundaries.
    """
    return float(environment.wrong_side(surface.vertices))
