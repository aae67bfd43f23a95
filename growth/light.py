"""Light on bodies and on the ground beneath them, by rays: a soft sun, and a sky that corners see less of.

Every place is lit from the same few fixed directions, so that shading is smooth, equal on every machine that has the
same embree, and small as a PNG; the samples of one pixel take turns at the directions.
"""

from __future__ import annotations

from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from growth.environment.boundaries.directions import spiral

Floats = NDArray[np.float64]

TURNS: Final = 4
"""Sets of directions that a pixel's samples take turns at."""

SUNS: Final = 20
SKIES: Final = 32
SUN_RADIUS: Final = 0.045
"""The sun's radius at distance one: a softer edge than the real one's."""


@final
class Rays:
    """Rays against a set of triangles, through embree."""

    def __init__(self, corners: Floats) -> None:
        """Take triangles (t, 3, 3)."""
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self.extent = (float(np.ptp(corners.reshape(-1, 3), axis=0).max()) if len(corners) else 0.0) or 1.0
        self.centre = corners.reshape(-1, 3).mean(axis=0) if len(corners) else np.zeros(3)
        self._scene = EmbreeScene()
        self._any = len(corners) > 0
        if self._any:  # embree counts in float32: about the middle it has the most digits
            local = np.ascontiguousarray((corners - self.centre).reshape(-1, 3), dtype=np.float32)
            TriangleMesh(self._scene, local, np.arange(len(local), dtype=np.int32).reshape(-1, 3))

    def first(self, origins: Floats, ways: Floats) -> tuple[NDArray[np.int32], Floats, Floats]:
        """Give the first triangle on each ray (-1: none), its distance, and the (n, 2) place on it."""
        if not self._any or not len(origins):
            count = len(origins)
            return np.full(count, -1, dtype=np.int32), np.full(count, np.inf), np.zeros((count, 2))
        got = self._scene.run(self._local(origins), ways.astype(np.float32), output=1)
        which = np.asarray(got["primID"], dtype=np.int32)
        return which, np.where(which < 0, np.inf, got["tfar"]), np.stack([got["u"], got["v"]], axis=1).astype(float)

    def open(self, origins: Floats, ways: Floats) -> NDArray[np.float32]:
        """Say 1 of each ray that meets nothing, 0 of the others."""
        if not self._any or not len(origins):
            return np.ones(len(origins), dtype=np.float32)
        got = self._scene.run(self._local(origins), ways.astype(np.float32), query="OCCLUDED")
        return (np.asarray(got) < 0).astype(np.float32)

    def _local(self, origins: Floats) -> NDArray[np.float32]:
        return (origins - self.centre).astype(np.float32)


def sun_towards(azimuth: float, elevation: float) -> Floats:
    """Give unit directions (SUNS, 3) over the sun's disc, from angles in degrees."""
    a, e = np.radians(azimuth), np.radians(elevation)
    middle = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    x = np.array([-np.sin(a), np.cos(a), 0.0])
    y = np.cross(middle, x)
    index = np.arange(SUNS)
    radius, turn = SUN_RADIUS * np.sqrt((index + 0.5) / SUNS), index * np.pi * (3.0 - np.sqrt(5.0))
    ways = middle + np.outer(radius * np.cos(turn), x) + np.outer(radius * np.sin(turn), y)
    return np.asarray(ways / np.linalg.norm(ways, axis=1, keepdims=True))


def lit(rays: Rays, places: Floats, normals: Floats, turn: int, suns: Floats) -> tuple[Floats, Floats]:
    """Give the shares of the sun and of the sky that reach places.

    Parameters
    ----------
    rays
        What stands in the light.
    places, normals
        (n, 3) float64; the normals on the lit side.
    turn
        Which set of directions to take.
    suns
        Directions over the sun's disc, (SUNS, 3).

    Returns
    -------
    Two (n,) float64 from 0 to 1. Sky directions are spread by the cosine to the normal.
    """
    sky = spiral(SKIES) * 0.985  # a unit normal plus a unit vector is spread by the cosine; never quite zero
    mine_suns, mine_sky = suns[turn::TURNS], sky[turn::TURNS]
    sunny, open_sky = np.zeros(len(places)), np.zeros(len(places))
    facing = normals @ suns.mean(axis=0) > -0.05
    for way in mine_suns:
        sunny[facing] += rays.open(places[facing], np.broadcast_to(way, (int(facing.sum()), 3)))
    for way in mine_sky:
        open_sky += rays.open(places, normals + way)
    return sunny / len(mine_suns), open_sky / len(mine_sky)


SMALL: Final = 320
"""Pixels; a picture that is no wider is a thumbnail."""


@final
class Ground:
    """The light on a level ground: tables of it around the bodies, read between their points.

    Sun shadows have edges and get a fine table; what the sky leaves in the dark is soft, and gets a coarse one from
    many more directions.
    """

    def __init__(self, rays: Rays, level: float, suns: Floats, pixels: int) -> None:
        """Light the ground at ``level`` under what ``rays`` know, for a picture so many pixels wide."""
        self.level = level
        self._centre = rays.centre[:2]
        self._sun_reach, self._sky_reach = 1.9 * rays.extent, 3.2 * rays.extent
        # Small pictures show less than the fine tables tell, which would take most of their time.
        sun_cells, sky_cells = (416, 112) if pixels > SMALL else (176, 64)
        places = self._grid(self._sun_reach, sun_cells)
        sunny = sum(rays.open(places, np.broadcast_to(way, places.shape)) for way in suns) / len(suns)
        self._sunny = np.asarray(sunny, dtype=np.float64).reshape(sun_cells, sun_cells)
        places = self._grid(self._sky_reach, sky_cells)
        ways = spiral(160) * 0.985 + [0.0, 0.0, 1.0]
        sky = sum(rays.open(places, np.broadcast_to(way, places.shape)) for way in ways) / len(ways)
        self._sky = np.asarray(sky, dtype=np.float64).reshape(sky_cells, sky_cells)

    def _grid(self, reach: float, cells: int) -> Floats:
        axis = np.linspace(-reach, reach, cells)
        x, y = np.meshgrid(self._centre[0] + axis, self._centre[1] + axis, indexing="ij")
        return np.stack([x, y, np.full_like(x, self.level)], axis=-1).reshape(-1, 3)

    def at(self, places: Floats) -> Floats:
        """Give the light at places (n, 2), 1 in the open."""
        away = places - self._centre
        sunny = _between(self._sunny, away, self._sun_reach)
        return np.asarray(0.46 * sunny + 0.54 * _between(self._sky, away, self._sky_reach))


def _between(table: Floats, away: Floats, reach: float) -> Floats:
    """Read a square table between its points, fading to 1 at its border."""
    cells = len(table)
    border = np.clip((1.0 - np.abs(away).max(axis=1) / reach) / 0.25, 0.0, 1.0)
    spot = np.clip((away / reach + 1.0) * 0.5 * (cells - 1), 0.0, cells - 1.000001)
    low = spot.astype(np.int64)
    share = spot - low
    i, j = low[:, 0], low[:, 1]
    first = table[i, j] * (1.0 - share[:, 1]) + table[i, j + 1] * share[:, 1]
    second = table[i + 1, j] * (1.0 - share[:, 1]) + table[i + 1, j + 1] * share[:, 1]
    light = first * (1.0 - share[:, 0]) + second * share[:, 0]
    return np.asarray(1.0 - (1.0 - light) * border * border * (3.0 - 2.0 * border))
