"""Taubin's smoothing: what is uneven is levelled, and the form does not shrink."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from growth.protocol import Failure
from growth.refining.lab import filtered
from growth.refining.mesh import Mesh

if TYPE_CHECKING:
    from growth.refining.recipe import RefineSettings

FORTH: Final = 0.5
BACK: Final = -0.53
"""How far a vertex goes towards its neighbours' mean, and then away from it (Taubin 1995)."""


def smooth(mesh: Mesh, settings: RefineSettings) -> Mesh | Failure:
    """Move the vertices ``settings.rounds`` times forth and back; the triangles stay as they are."""
    moves = {"lambda_": FORTH, "mu": BACK, "stepsmoothnum": settings.rounds}
    return filtered(mesh, ("apply_coord_taubin_smoothing", moves))
