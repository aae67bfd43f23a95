"""Pictures of drawings: round where parts are round, each in its colour, on a pale ground."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from genome.errors import InputError
from growth.bodies import smooth_body
from growth.pictures import render_bodies
from growth.timed.drawing import Drawing
from growth.timed.tables import Floats

if TYPE_CHECKING:
    from PIL.Image import Image

LINE: Final = 0.25
"""How dark the lines at creases are; parts are many."""

AZIMUTH: Final = -62.0
ELEVATION: Final = 14.0
"""Where the viewer stands, in degrees."""


def picture(
    drawing: Drawing,
    size: tuple[int, int] = (1000, 750),
    window: Floats | None = None,
    *,
    azimuth: float = AZIMUTH,
    elevation: float = ELEVATION,
) -> Image:
    """Draw a drawing.

    Parameters
    ----------
    drawing
        Of one part at least.
    size
        Width and height in pixels.
    window
        (2, 3) float64, the lowest and highest coordinates of what the picture frames (:func:`bounds`); the drawing's
        own where not given. Frames of an animation share one, and so have one camera and ground.
    azimuth, elevation
        Where the viewer stands, in degrees; azimuth from x towards y.

    Returns
    -------
    An RGB image; the same input gives the same picture.

    Raises
    ------
    InputError
        When nothing is drawn.
    """
    if not len(drawing):
        raise InputError("picture", "a drawing with a part", "none", "the word draws nothing at this time")
    surface = drawing.surface()
    counts = np.array([len(shape.triangles) for shape in drawing.shapes], dtype=np.int64)[drawing.which]
    colours = np.repeat(drawing.colours, counts, axis=0)
    bodies = smooth_body(surface.vertices, surface.face_vertices.reshape(-1, 3), colours, LINE)
    return render_bodies(bodies, size, azimuth=azimuth, elevation=elevation, window=window)


def bounds(*drawings: Drawing) -> Floats | None:
    """Give the lowest and highest coordinates (2, 3) of drawings; ``None`` where none has a part."""
    corners = [drawing.corners(part) for drawing in drawings for part in range(len(drawing))]
    if not corners:
        return None
    return np.stack([np.min([part.min(axis=0) for part in corners], axis=0),
                     np.max([part.max(axis=0) for part in corners], axis=0)])  # fmt: skip
