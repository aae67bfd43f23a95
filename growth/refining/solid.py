"""A watertight solid for printing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from growth.protocol import Failure
from growth.refining.clean import clean
from growth.refining.lab import filtered, length
from growth.refining.mesh import Mesh, edge_uses, quality

if TYPE_CHECKING:
    from growth.refining.recipe import RefineSettings

THICK: Final = 0.02
"""Of the diagonal: how thick surfaces become where no thickness is asked for."""

THINNEST: Final = 0.002
"""Of the diagonal: thinner solids would have millions of triangles."""

THIN: Final = 0.001
"""Of the diagonal: how far a body that is closed already is widened where its parts touch."""

OPENING: Final = 1.5
"""Of the thickness: wraps pass through openings that are wider."""


def solid(mesh: Mesh, settings: RefineSettings) -> Mesh | Failure:
    """Give a form a volume that nothing is missing of.

    A form that is watertight stays as it is. One that is closed, but whose bodies share edges or corners, is wrapped
    closely. Any other is thickened: a wrap runs round it at half of ``settings.thickness`` on either side. Wraps are
    alpha wraps (Portaneri 2022): watertight and manifold whatever they go round; hollows that nothing leads into are
    filled.

    Returns
    -------
    Mesh or Failure
        Watertight, fronts outward. A failure has the reason ``refining``: the form has no extent, or the wrap is not
        watertight.
    """
    if not mesh.diagonal > 0.0:
        return Failure("refining", "solid: the form has no extent")
    mended = clean(mesh, settings)
    if isinstance(mended, Mesh) and quality(mended).watertight and _stays_watertight(mended):
        return mended
    touching = _closed(mesh)
    thickness = 2.0 * THIN * mesh.diagonal if touching else settings.thickness or THICK * mesh.diagonal
    if not touching and thickness < THINNEST * mesh.diagonal:
        least = f"{THINNEST * mesh.diagonal:.4g}, {THINNEST:g} of the form's diagonal"
        return Failure("refining", f"solid: a thickness of {thickness:.4g} is less than can be wrapped ({least})")
    opening = THICK * mesh.diagonal if touching else OPENING * thickness
    wrap = filtered(mesh, ("generate_alpha_wrap", {"alpha": length(opening), "offset": length(0.5 * thickness)}))
    if isinstance(wrap, Failure):
        return wrap
    found = quality(wrap)
    if not found.watertight or found.volume <= 0.0:
        return Failure("refining", f"solid: the wrap has {found.open_edges} open edges and {found.crossings} crossings")
    return wrap


def _closed(mesh: Mesh) -> bool:
    """Tell whether every edge has an even number of triangles, corners at one place being one."""
    _, places = np.unique(_rounded(mesh), axis=0, return_inverse=True)
    uses, _ = edge_uses(places.reshape(-1)[mesh.triangles].astype(np.int32))
    return not bool((uses % 2).any())


def _stays_watertight(mesh: Mesh) -> bool:
    """Tell whether it is watertight also for programs that join corners at one place, as they must for STL files."""
    _, places = np.unique(_rounded(mesh), axis=0, return_inverse=True)
    return quality(Mesh(mesh.vertices, places.reshape(-1)[mesh.triangles].astype(np.int32))).watertight


def _rounded(mesh: Mesh) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.round(mesh.vertices / (1e-7 * mesh.diagonal))
