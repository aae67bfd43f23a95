"""Subdivisions: how little inner structure the form has; 1 for a bare ring, lower for a web."""

from __future__ import annotations

from typing import TYPE_CHECKING

from growth.surface import Surface

if TYPE_CHECKING:
    from growth.environment import Environment


def subdivisions(surface: Surface, environment: Environment) -> float:  # noqa: ARG001 - every criterion takes both
    """Divide the number of vertices by the number of edges (Hemberg 2006, section 5.3).

    Parameters
    ----------
    surface
        A form. Every edge counts, those that join the same two vertices too.
    environment
        Not looked at.

    Returns
    -------
    float
        Above 0; 1 for a ring, towards 1/2 for a large mesh of squares and 1/3 for one of triangles.

    Raises
    ------
    ValueError
        For a form without edges.
    """
    vertices, edges, _ = surface.counts
    if edges == 0:
        raise ValueError("the form has no edges")
    return vertices / edges
