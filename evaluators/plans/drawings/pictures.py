"""Plans as pictures of a size that is asked for; those of cubes through the pictures of surfaces."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np

from evaluators.plans.drawings.draw import drawing
from evaluators.plans.drawings.glb import cube_parts
from evaluators.plans.drawings.solids import Floats, Indices
from evaluators.plans.layout import Layout
from growth.pictures import render
from growth.surface import Surface

if TYPE_CHECKING:
    from PIL.Image import Image


def plan_picture(layout: Layout, size: tuple[int, int]) -> Image:
    """Draw a plan within so many pixels, white around it."""
    from PIL import Image

    from evaluators.plans.drawings.png import picture
    from evaluators.plans.drawings.sheet import bare

    if layout.plan.tiling.solid:
        return cubes_picture(layout, size)
    drawn = picture(bare(drawing(layout, "")))
    drawn.thumbnail(size)
    sheet = Image.new("RGB", size, "#ffffff")
    sheet.paste(drawn, ((size[0] - drawn.width) // 2, (size[1] - drawn.height) // 2))
    return sheet


def cubes_picture(layout: Layout, size: tuple[int, int] = (1000, 750)) -> Image:
    """Draw the rooms of a plan of cubes, each in a colour, from the south-west above, so many pixels wide and high."""
    parts = cube_parts(layout)
    colours = [np.tile(np.array(part.colour) / 255.0, (len(part.solid.triangles) // 2, 1)) for part in parts]
    return render([_surface(part.solid.vertices, part.solid.triangles) for part in parts], colours=colours, size=size)


def cubes_png(layout: Layout, size: tuple[int, int] = (1000, 750)) -> bytes:
    """Draw the rooms of a plan of cubes as a PNG file; see :func:`cubes_picture`."""
    stream = io.BytesIO()
    cubes_picture(layout, size).save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def _surface(vertices: Floats, triangles: Indices) -> Surface:
    """Give faces of cubes as squares: their first halves come before all second ones."""
    one, other = triangles[: len(triangles) // 2], triangles[len(triangles) // 2 :]
    rings = np.column_stack([one, other[:, 2]])
    none = np.empty((0, 2), dtype=np.int32)
    starts = np.arange(0, rings.size + 1, 4, dtype=np.int32)
    return Surface(vertices, none, none[:, 0], (), starts, rings.reshape(-1).astype(np.int32))
