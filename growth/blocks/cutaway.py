"""Pictures of species that live in one space: the walls cut open so that the space in them is seen, or a plan."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from growth.blocks.cohabitants import Cohabitants, body_of, without
from growth.blocks.lattice import Floats, Ints
from growth.blocks.skin import Skin, skin
from growth.bodies import Colour
from growth.pictures import FRONTS, render

if TYPE_CHECKING:
    from PIL.Image import Image

WALL: Final[Colour] = (0.84, 0.83, 0.80)
CUT: Final[Colour] = (0.24, 0.24, 0.26)
COLOURS: Final = {"space": FRONTS[0], "route": FRONTS[1]}
"""Plaster, the faces where walls are cut, and the colours of what lives between them."""

AZIMUTH: Final = -62.0
"""Where the viewer stands, in degrees from x towards y: before the plane y = const."""


def cutaway(company: Cohabitants, size: tuple[int, int] = (1000, 750)) -> Image:
    """Draw species in one space.

    The cells of the walls before the middle of the space, in y, are taken away, and the faces that this lays bare are
    dark; space and route are whole. Without space or route the walls are cut through their own middle, without walls
    nothing is. On a lattice in the plane it is a plan from above, and nothing is cut but the walls' tops are dark.

    Parameters
    ----------
    company
        One cell at least.
    size
        Width and height in pixels.

    Raises
    ------
    InputError
        When there is no cell to draw.
    """
    flat = not company.lattice.offsets[:, 2].any()
    shown = company.shown()
    surfaces, colours = [], []
    for species, cells in shown.items():
        if species == "enclosure":
            part, shades = _walls(cells, company, flat=flat)
        else:
            part = skin(body_of(cells, company.lattice))
            shades = np.tile(COLOURS[species], (len(part.owners), 1))
        if len(part.owners):
            surfaces.append(part.surface)
            colours.append(shades)
    azimuth, elevation = (-90.0, 90.0) if flat else (AZIMUTH, 24.0)
    return render(surfaces, size=size, azimuth=azimuth, elevation=elevation, colours=colours)


def _walls(cells: Ints, company: Cohabitants, *, flat: bool) -> tuple[Skin, Floats]:
    """Give the faces of what is left of the walls, and their colours (F, 3)."""
    if flat:
        part = skin(body_of(cells, company.lattice))
        return part, np.tile(CUT, (len(part.owners), 1))
    middle = _middle(cells, company)
    kept = np.ascontiguousarray(cells[cells[:, 1] >= middle])
    gone = without(cells, kept)
    part = skin(body_of(kept, company.lattice))
    shades = np.tile(WALL, (len(part.owners), 1))
    shades[_laid_bare(part, kept, gone)] = CUT
    return part, shades


def _middle(cells: Ints, company: Cohabitants) -> float:
    """Give the y of the plane that walls are cut at: the middle of the space, never before all of the walls."""
    inner = next((one for one in (company.space, company.route) if len(one)), cells)[:, 1]
    return float(min(0.5 * (inner.min() + inner.max()), cells[:, 1].max()))


def _laid_bare(part: Skin, kept: Ints, gone: Ints) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Say of each face whether a cell that was taken away lies behind it."""
    if not len(gone):
        return np.zeros(len(part.owners), dtype=np.bool_)
    centres = part.surface.vertices[part.surface.face_vertices.reshape(-1, 4)].mean(axis=1)
    behind = np.rint(2.0 * centres).astype(np.int64) - kept[part.owners]
    _, names = np.unique(np.concatenate([behind, gone]), axis=0, return_inverse=True)
    names = names.reshape(-1)
    return np.asarray(np.isin(names[: len(behind)], names[len(behind) :]))
