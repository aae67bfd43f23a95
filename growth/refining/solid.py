"""A watertight solid for printing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from growth.protocol import Failure
from growth.refining.clean import clean
from growth.refining.lab import filtered, length
from growth.refining.mesh import Mesh, edge_uses, joined_at_places, quality
from growth.refining.union import THIN, touching, united

if TYPE_CHECKING:
    from growth.refining.recipe import RefineSettings

THICK: Final = 0.02
"""Of the diagonal: how thick surfaces become where no thickness is asked for."""

THINNEST: Final = 0.002
"""Of the diagonal: thinner solids would have millions of triangles."""

OPENING: Final = 1.5
"""Of the thickness: wraps pass through openings that are wider."""


def solid(mesh: Mesh, settings: RefineSettings) -> Mesh | Failure:
    """Give a form a volume that nothing is missing of.

    A form that is one watertight body stays as it is. Several closed bodies become their union; where that fails, since
    fronts do not agree, they are wrapped closely. Any other form is thickened: a wrap runs round it at half of
    ``settings.thickness`` on either side. Wraps are alpha wraps (Portaneri 2022): watertight and manifold whatever they
    go round; hollows that nothing leads into are filled.

    Returns
    -------
    Mesh or Failure
        Watertight, fronts outward. A failure has the reason ``refining``: the form has no extent, or the wrap is not
        watertight.
    """
    if not mesh.diagonal > 0.0:
        return Failure("refining", "solid: the form has no extent")
    mended = clean(mesh, settings)
    sound = mended if isinstance(mended, Mesh) and quality(mended).watertight else None
    if sound is not None and _is_one(sound):
        return sound
    closed = _closed(mesh)
    if closed:
        # Where cleaning could not mend the form, it has taken faces that two bodies shared: as it came it has them.
        whole = united(mesh if sound is None else sound)
        if isinstance(whole, Mesh):
            return whole
    if sound is not None and quality(joined_at_places(sound)).watertight:
        return sound
    thickness = 2.0 * THIN * mesh.diagonal if closed else settings.thickness or THICK * mesh.diagonal
    if not closed and thickness < THINNEST * mesh.diagonal:
        least = f"{THINNEST * mesh.diagonal:.4g}, {THINNEST:g} of the form's diagonal"
        return Failure("refining", f"solid: a thickness of {thickness:.4g} is less than can be wrapped ({least})")
    opening = THICK * mesh.diagonal if closed else OPENING * thickness
    wrap = filtered(mesh, ("generate_alpha_wrap", {"alpha": length(opening), "offset": length(0.5 * thickness)}))
    if isinstance(wrap, Failure):
        return wrap
    found = quality(wrap)
    if not found.watertight or found.volume <= 0.0:
        return Failure("refining", f"solid: the wrap has {found.open_edges} open edges and {found.crossings} crossings")
    return wrap


def _is_one(mesh: Mesh) -> bool:
    """Tell whether it is a single body, which touches itself nowhere."""
    return quality(mesh).parts == 1 and not any(map(len, touching(joined_at_places(mesh))))


def _closed(mesh: Mesh) -> bool:
    """Tell whether every edge has an even number of triangles, corners at one place being one."""
    uses, _ = edge_uses(joined_at_places(mesh).triangles)
    return not bool((uses % 2).any())
