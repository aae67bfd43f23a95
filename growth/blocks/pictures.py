"""Pictures of block bodies: clay on stone, the envelope as thin glass, or cells coloured by their forces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from growth.blocks.body import BOUNDARY, ENVELOPE, INTERNAL, Body
from growth.blocks.lattice import Floats
from growth.blocks.parts import ramp
from growth.blocks.skin import body_surface, skin
from growth.bodies import Colour
from growth.pictures import FRONTS, STONE, render

if TYPE_CHECKING:
    from PIL.Image import Image

COLOURS: Final[tuple[Colour, Colour]] = (FRONTS[0], STONE)
"""Of the skeleton and of the foundation."""


def body_picture(
    body: Body,
    forces: Floats | None = None,
    size: tuple[int, int] = (1000, 750),
    *,
    azimuth: float = -62.0,
    elevation: float = 18.0,
) -> Image:
    """Draw a body.

    Parameters
    ----------
    body
        With a skeleton or a foundation of one cell at least.
    forces
        (n,) float64 from 0 to 1, one for each of the body's cells, pale to red; the systems' colours where not given.
    size
        Width and height in pixels.
    azimuth, elevation
        Where the viewer stands, in degrees.

    Raises
    ------
    InputError
        When there is no cell to draw.
    """
    surfaces, colours = [], []
    for system, colour in zip((INTERNAL, BOUNDARY), COLOURS, strict=True):
        if (body.systems == system).any():
            part = skin(body, [system])
            surfaces.append(part.surface)
            shades = np.tile(colour, (len(part.owners), 1)) if forces is None else ramp(forces[part.owners])
            colours.append(shades)
    wrap = [body_surface(body, [ENVELOPE])] if (body.systems == ENVELOPE).any() else []
    return render(surfaces, size=size, azimuth=azimuth, elevation=elevation, colours=colours, glass=wrap)
