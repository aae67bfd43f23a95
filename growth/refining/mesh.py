"""A form as triangles, and how sound it is."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from growth.surface import Indices, Points

CLOSE: Final = 1e-7
"""Corners nearer to each other than this share of the diagonal are one."""


class Mesh(NamedTuple):
    """Triangles in the form's unit, z up.

    Attributes
    ----------
    vertices
        (v, 3) float64, finite.
    triangles
        (t, 3) int32, places in ``vertices``; no corner twice.
    """

    vertices: Points
    triangles: Indices

    @property
    def diagonal(self) -> float:
        """The length of the bounding box's diagonal; 0 without vertices."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0))) if len(self.vertices) else 0.0


class Quality(NamedTuple):
    """How sound a mesh is.

    Attributes
    ----------
    watertight
        Whether every edge has two triangles, which run along it in opposite directions.
    manifold
        Whether no edge has more than two triangles.
    oriented
        Whether no edge has two triangles that run along it in the same direction.
    open_edges
        How many edges have one triangle.
    crossings
        How many edges have more than two.
    parts
        How many pieces the triangles are, joined by edges' ends.
    volume
        By the divergence theorem, in cubic units; only of a watertight mesh more than a number.
    """

    watertight: bool
    manifold: bool
    oriented: bool
    open_edges: int
    crossings: int
    parts: int
    volume: float


def quality(mesh: Mesh) -> Quality:
    """Measure how sound a mesh is; an empty one is not watertight."""
    uses, balance = edge_uses(mesh.triangles)
    open_edges, crossings = int((uses == 1).sum()), int((uses > 2).sum())
    oriented = not bool(((uses == 2) & (balance != 0)).any())
    watertight = len(mesh.triangles) > 0 and open_edges == crossings == 0 and oriented
    return Quality(
        watertight, crossings == 0, oriented, open_edges, crossings, _parts(mesh), float(volumes(mesh).sum())
    )


def sides(triangles: Indices) -> NDArray[np.int64]:
    """Give where the sides of triangles start and end (3t, 2): all first sides, all second ones, all third ones."""
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)


def edge_uses(triangles: Indices) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Count how often each edge is used (e,), and how much more often in one direction than in the other (e,)."""
    ends = sides(triangles)
    way = np.where(ends[:, 0] < ends[:, 1], 1, -1)
    keys = ends.min(axis=1) * (int(triangles.max(initial=0)) + 1) + ends.max(axis=1)
    _, edge = np.unique(keys, return_inverse=True)
    return np.bincount(edge), np.bincount(edge, weights=way).astype(np.int64)


def joined_at_places(mesh: Mesh) -> Mesh:
    """Join corners at one place, as programs must that read STL files; triangles that lose a corner go.

    One place is what lies within :data:`CLOSE` of the diagonal.
    """
    _, first, places = np.unique(
        np.round(mesh.vertices / (CLOSE * mesh.diagonal)), axis=0, return_index=True, return_inverse=True
    )
    triangles = places.reshape(-1)[mesh.triangles].astype(np.int32)
    apart = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return Mesh(mesh.vertices[first], triangles[apart])


def volumes(mesh: Mesh) -> Points:
    """Give each triangle's part of the volume, (t,) float64: of the tetrahedron with the vertices' mean."""
    if not len(mesh.triangles):
        return np.zeros(0)
    corners = mesh.vertices[mesh.triangles] - mesh.vertices.mean(axis=0)
    return np.asarray(np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0)


def area(mesh: Mesh) -> float:
    """Give the area of all triangles."""
    corners = mesh.vertices[mesh.triangles]
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(0.5 * np.linalg.norm(crossed, axis=1).sum())


def pieces(triangles: Indices, count: int) -> NDArray[np.int32]:
    """Give the piece of each triangle (t,), pieces being joined by vertices, of which there are ``count``."""
    if not len(triangles):
        return np.zeros(0, dtype=np.int32)
    rows = triangles.reshape(-1)
    columns = np.roll(triangles, -1, axis=1).reshape(-1)
    graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(count, count))
    _, labels = connected_components(graph, directed=False)
    _, found = np.unique(labels[triangles[:, 0]], return_inverse=True)
    return found.astype(np.int32)


def _parts(mesh: Mesh) -> int:
    return int(pieces(mesh.triangles, len(mesh.vertices)).max(initial=-1)) + 1
