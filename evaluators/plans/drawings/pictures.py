"""Plans of cubes as pictures, through the pictures of surfaces."""

from __future__ import annotations

import io

import numpy as np

from evaluators.plans.drawings.glb import cube_parts
from evaluators.plans.layout import Layout
from growth.pictures import render
from growth.surface import Surface


def cubes_png(layout: Layout) -> bytes:
    """Draw the rooms of a plan of cubes, each in a colour, from the south-west above."""
    parts = cube_parts(layout)
    colours = [np.tile(np.array(part.colour) / 255.0, (len(part.solid.triangles), 1)) for part in parts]
    image = render([_surface(part.solid.vertices, part.solid.triangles) for part in parts], colours=colours)
    stream = io.BytesIO()
    image.save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def _surface(vertices: np.ndarray, triangles: np.ndarray) -> Surface:  # type: ignore[type-arg]
    none = np.empty((0, 2), dtype=np.int32)
    starts = np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int32)
    return Surface(vertices, none, none[:, 0], (), starts, triangles.reshape(-1).astype(np.int32))
