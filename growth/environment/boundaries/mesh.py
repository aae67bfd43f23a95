"""A closed triangle mesh from a file."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Final, final

import numpy as np
from pydantic import Field

from genome.errors import InputError
from genome.settings import Vector3
from growth.environment.boundaries import _tree as tree
from growth.environment.boundaries.convex import frame_turned
from growth.environment.boundaries.directions import spiral
from growth.environment.boundaries.files import read_mesh
from growth.environment.boundaries.protocol import BoundarySettings, Flags, Floats, Triangles, skin_for

RAYS: Final = np.array(
    [
        [0.5377397, 0.3713907, 0.7569025],
        [-0.6180340, 0.7071068, 0.3434407],
        [0.4142136, -0.8660254, -0.2807764],
        [-0.2360680, -0.3819660, 0.8935065],
        [0.7320508, 0.1622777, -0.6616475],
    ]
)
"""Directions in which a point looks for its winding number; none lies along a plane that people draw in."""


class PlacedSettings(BoundarySettings):
    """A mesh, scaled, turned about the fixed x, then y, then z axis (degrees), then moved."""

    at: Vector3 = (0.0, 0.0, 0.0)
    rotation: Vector3 = (0.0, 0.0, 0.0)
    scale: Annotated[float, Field(gt=0)] = 1.0


class MeshSettings(PlacedSettings):
    """A mesh file, placed.

    ``contents`` is the hash that a run's own copy of its settings holds: where it is given, the file must still match.
    """

    mesh: Annotated[str, Field(min_length=1)]
    contents: str | None = None


@final
@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """A closed mesh, of which the inside or the outside is solid.

    Attributes
    ----------
    vertices, triangles
        (v, 3) float64 and (t, 3) int32, fronts outward.
    outside
        Whether the solid side is outside the mesh.
    soft, skin
        See :class:`~growth.environment.boundaries.protocol.Boundary`.
    """

    vertices: Floats
    triangles: Triangles
    outside: bool
    soft: bool
    skin: float
    _corners: Floats = field(repr=False)
    _boxes: Floats = field(repr=False)
    _first: Triangles = field(repr=False)
    _count: Triangles = field(repr=False)

    def first_hit(self, start: Floats, end: Floats) -> Floats:
        """Give the fraction of each way at which it enters the solid side."""
        return tree.first_hit(self._corners, self._boxes, self._first, self._count, self.skin, start, end)

    def inside(self, points: Floats) -> Flags:
        """Say of each point whether it is within the solid side."""
        solid = self.surrounds(points)
        return ~solid if self.outside else solid

    def surrounds(self, points: Floats) -> Flags:
        """Say of each point whether the mesh surrounds it, whichever side is solid."""
        sign = -1 if self.outside else 1
        turns = tree.windings(self._corners, self._boxes, self._first, self._count, RAYS, points)
        return np.asarray(sign * turns > 0)

    def nearest_free(self, points: Floats, clearance: float = 1.0) -> Floats:
        """Move points of the solid side to the nearest place of the free side."""
        place, which = tree.nearest(self._corners, self._boxes, self._first, self._count, points)
        away = place - points
        depth = np.linalg.norm(away, axis=1)
        corners = self._corners[which]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        shallow = depth <= self.skin
        away[shallow] = normal[shallow]
        length = np.linalg.norm(away, axis=1)
        length[length == 0.0] = 1.0
        away /= length[:, None]
        out = place + clearance * self.skin * away
        for index in np.flatnonzero(self.inside(out)):
            out[index] = self._beside(place[index], away[index], clearance * self.skin, out[index])
        return out

    def _beside(self, place: Floats, away: Floats, gap: float, otherwise: Floats) -> Floats:
        """Step off a place on the surface where straight on is no way out: in the tip of a narrow free wedge."""
        directions = spiral(64)
        ways = directions[np.argsort(-(directions @ away), kind="stable")]
        candidates = np.ascontiguousarray(place + gap * ways)
        free = np.flatnonzero(~self.inside(candidates))
        return candidates[free[0]] if len(free) else otherwise

    def outline(self, extent: float) -> tuple[Floats, Triangles]:
        """Give the mesh itself."""
        del extent
        return self.vertices, self.triangles


def mesh(settings: MeshSettings, source: str, base: Path) -> tuple[Mesh, str]:
    """Build a mesh boundary, and give the hash of its file's geometry.

    Parameters
    ----------
    settings
        The boundary's settings.
    source
        Where it is asked for, for messages.
    base
        The folder that the path is relative to.

    Raises
    ------
    InputError
        When the file is missing, unreadable, empty, not finite or not closed, or is not the one that it was.
    """
    path = base / settings.mesh
    vertices, triangles = read_mesh(path, source)
    contents = contents_of(vertices, triangles)
    if settings.contents not in (None, contents):
        raise InputError(source, f"the mesh {path} as it was ({settings.contents})", contents, "restore the file")
    return placed_mesh(vertices, triangles, settings), contents


def contents_of(vertices: Floats, triangles: Triangles) -> str:
    """Hash a mesh's geometry."""
    return hashlib.blake2b(vertices.tobytes() + triangles.tobytes(), digest_size=16).hexdigest()


def placed_mesh(vertices: Floats, triangles: Triangles, settings: PlacedSettings) -> Mesh:
    """Build a mesh boundary from vertices (v, 3) and triangles (t, 3) that are known to be closed, and place it."""
    turn = frame_turned(settings.rotation)
    placed = np.ascontiguousarray((vertices * settings.scale) @ turn + np.array(settings.at))
    return closed_mesh(placed, triangles, settings)


def closed_mesh(vertices: Floats, triangles: Triangles, settings: BoundarySettings) -> Mesh:
    """Build a mesh boundary from vertices (v, 3) and triangles (t, 3) that are known to be closed, fronts outward."""
    outside = settings.solid == "outside"
    facing = triangles[:, ::-1] if outside else triangles
    corners = np.ascontiguousarray(vertices[facing])
    order, boxes, first, count = tree.build(corners.min(axis=1), corners.max(axis=1))
    measure = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    skin = skin_for(measure, float(np.abs(vertices).max()))
    return Mesh(
        vertices, triangles, outside, settings.soft, skin, np.ascontiguousarray(corners[order]), boxes, first, count
    )
