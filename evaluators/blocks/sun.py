"""Sun: how much of a body the sun reaches, less the ground that the body shades (Coates' exposure, Senatore 2009)."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks.exposed_surface import face_area
from evaluators.blocks.rays import hits
from evaluators.blocks.structure import Structure
from growth.blocks.body import BOUNDARY, Body
from growth.blocks.lattice import FACE

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

HOURS: Final = (-60.0, -36.0, -12.0, 12.0, 36.0, 60.0)
"""Hour angles in degrees, from morning to afternoon."""

LATITUDE: Final = 50.0
"""In degrees north."""


def suns() -> Floats:
    """Give the unit vectors towards the sun on the day of an equinox: (6, 3) float64, x east, y north, z up."""
    hour, north = np.radians(HOURS), np.radians(LATITUDE)
    return np.stack([-np.sin(hour), -np.cos(hour) * np.sin(north), np.cos(hour) * np.cos(north)], axis=1)


def sun(structure: Structure) -> float:
    """Give the lit share of the exposed faces, less the shaded ground in proportion to the exposed surface.

    Both are means over :func:`suns`. A face is lit when it is turned to the sun and a ray from its middle meets no
    block. Lit faces seen from the sun make up the body's silhouette; divided by the sine of the sun's altitude that is
    its shadow on level ground (exactly so where no face is lit in part), less the ground that it stands on. Divided by
    the exposed surface, the shadow is in proportion to the body, and a large body is not worse than a small one.

    Parameters
    ----------
    structure
        Internal blocks and envelope; the boundary casts shadows on them, and none of its own counts.

    Returns
    -------
    float
        Below 1, and below 0 for bodies that shade much and are little lit; 0 without exposed faces.
    """
    return exposure(structure.body)


def exposure(body: Body) -> float:
    """Give the same of a body whose load does not matter."""
    centres, beyond, normals = open_faces(body)
    if not len(centres):
        return 0.0
    area = face_area(body.lattice)
    built = body.cells[body.systems != BOUNDARY]
    foot = np.count_nonzero(built[:, 2] == built[:, 2].min()) * body.lattice.volume
    lit = shade = 0.0
    for way in suns():
        facing = normals @ way
        turned = np.flatnonzero(facing > 0)
        open_to = turned[hits(body, centres[turned], beyond[turned], np.tile(way, (turned.size, 1))) < 0]
        lit += open_to.size / len(centres)
        shade += max(0.0, float(facing[open_to].sum()) * area / way[2] - foot)
    return float((lit - shade / (len(centres) * area)) / len(HOURS))


def open_faces(body: Body) -> tuple[Floats, Ints, Floats]:
    """Find the faces of internal and envelope blocks that no block covers.

    Returns
    -------
    centres : (f, 3) float64
    beyond : (f, 3) int64
        The empty cell that each faces.
    normals : (f, 3) float64
        Unit vectors out of the body.
    """
    sides = body.lattice.offsets[body.lattice.contacts == FACE]
    built = body.cells[body.systems != BOUNDARY]
    low = body.cells.min(axis=0, initial=0) - 1
    size = body.cells.max(axis=0, initial=0) + 2 - low

    def key(cells: Ints) -> Ints:
        at = cells - low
        return np.asarray((at[..., 0] * size[1] + at[..., 1]) * size[2] + at[..., 2])

    beyond = built[:, np.newaxis] + sides
    free = ~np.isin(key(beyond), key(body.cells))
    centres = (built[:, np.newaxis] + sides / 2.0)[free]
    normals = np.broadcast_to(sides / np.linalg.norm(sides, axis=1)[:, np.newaxis], beyond.shape)[free]
    return centres, np.ascontiguousarray(beyond[free]), normals
