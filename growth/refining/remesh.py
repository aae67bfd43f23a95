"""Isotropic remeshing: triangles of nearly equal sides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from growth.protocol import Failure
from growth.refining.lab import filtered, length
from growth.refining.mesh import Mesh

if TYPE_CHECKING:
    from growth.refining.recipe import RefineSettings

SHARE: Final = 0.02
"""Of the diagonal: how long edges become where no length is asked for."""

FINEST: Final = 0.001
"""Of the diagonal: shorter edges would make millions of triangles."""

ROUNDS: Final = 6


def remesh(mesh: Mesh, settings: RefineSettings) -> Mesh | Failure:
    """Give a form triangles whose edges are about ``settings.length`` long; creases over 30 degrees stay."""
    target = settings.length or SHARE * mesh.diagonal
    if target < FINEST * mesh.diagonal:
        least = f"{FINEST * mesh.diagonal:.4g}, {FINEST:g} of the form's diagonal"
        return Failure("refining", f"remesh: edges of {target:.4g} are shorter than can be made ({least})")
    return filtered(
        mesh,
        (
            "meshing_isotropic_explicit_remeshing",
            {"iterations": ROUNDS, "targetlen": length(target), "featuredeg": 30.0},
        ),
    )
