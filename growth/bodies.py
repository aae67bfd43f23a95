"""What a picture shows: triangles with colours, shading normals and the lines drawn on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from growth.forms import face_triangles, newell_normals
from growth.surface import Surface

Floats = NDArray[np.float64]
Colour = tuple[float, float, float]

CREASE: Final = float(np.cos(np.radians(38.0)))
"""Faces that meet at a sharper angle show a line and share no shading."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """Triangles to draw; t of them.

    Attributes
    ----------
    corners
        (t, 3, 3) float64.
    normals
        (t, 3, 3) float64, the shading normal at each corner.
    front, back
        (t, 3) float64, sRGB colours of the two sides from 0 to 1.
    lines
        (t, 3) float64, how dark the line along each side (corner k to k + 1) is, from 0 to 1.
    """

    corners: Floats
    normals: Floats
    front: Floats
    back: Floats
    lines: Floats

    def __len__(self) -> int:
        return len(self.corners)


def joined(parts: Sequence[Bodies]) -> Bodies:
    """Put bodies together."""
    if not parts:
        none = np.empty((0, 3))
        return Bodies(none.reshape(0, 3, 3), none.reshape(0, 3, 3), none, none, none)
    return Bodies(
        np.concatenate([part.corners for part in parts]),
        np.concatenate([part.normals for part in parts]),
        np.concatenate([part.front for part in parts]),
        np.concatenate([part.back for part in parts]),
        np.concatenate([part.lines for part in parts]),
    )


def surface_body(surface: Surface, front: Colour | Floats, back: Colour | Floats, line: float) -> Bodies:
    """Give a surface: each face evenly shaded, its sides lines; one colour for all faces, or (F, 3) one for each."""
    triangles, faces = face_triangles(surface)
    corners = surface.vertices[triangles]
    starts, rings = surface.face_starts.astype(np.int64), surface.face_vertices.astype(np.int64)
    place = np.arange(len(rings))
    owner = np.searchsorted(starts, place, side="right") - 1
    after = np.where(place + 1 == starts[owner + 1], starts[owner], place + 1)
    sides = _side_keys(owner, rings, rings[after], len(surface.vertices))
    ends = np.roll(triangles, -1, axis=1).astype(np.int64)
    drawn = np.isin(
        _side_keys(faces.astype(np.int64)[:, None], triangles.astype(np.int64), ends, len(surface.vertices)), sides
    )
    normals = newell_normals(corners)
    whole = np.zeros((len(starts) - 1, 3))
    np.add.at(whole, faces, normals)
    shading = np.repeat(_unit(whole[faces])[:, None, :], 3, axis=1)
    fronts, backs = (np.broadcast_to(colour, (len(starts) - 1, 3))[faces] for colour in (front, back))
    return Bodies(corners, shading, fronts, backs, np.where(drawn, line, 0.0))


def _side_keys(face: NDArray[np.int64], a: NDArray[np.int64], b: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    return (face * count + np.minimum(a, b)) * count + np.maximum(a, b)


def solid_body(vertices: Floats, triangles: NDArray[np.int32], colour: Colour, line: float) -> Bodies:
    """Give a boundary's outline: round where its faces turn gently, lines where they crease."""
    once, vertex = np.unique(vertices, axis=0, return_inverse=True)
    shared = vertex.reshape(-1)[triangles].astype(np.int32)
    return smooth_body(once, shared, np.tile(colour, (len(triangles), 1)), line)


def smooth_body(vertices: Floats, triangles: NDArray[np.int32], colours: Floats, line: float) -> Bodies:
    """Give triangles that share vertices (v, 3), in colours (t, 3): round where they turn gently, lines at creases."""
    corners = vertices[triangles]
    flat = newell_normals(corners)
    unit = _unit(flat)
    normals = _rounded(triangles.reshape(-1).astype(np.int64), np.repeat(flat, 3, axis=0), np.repeat(unit, 3, axis=0))
    lines = np.where(_creased(triangles.astype(np.int64), unit), line, 0.0)
    return Bodies(corners, normals.reshape(-1, 3, 3), colours, colours, lines)


def _rounded(vertex: NDArray[np.int64], weighted: Floats, unit: Floats) -> Floats:
    """Average at each corner the normals of the faces around its vertex that turn gently from its own face."""
    order = np.argsort(vertex, kind="stable")
    count = np.bincount(vertex)
    first = np.cumsum(count) - count
    partners = count[vertex]
    mine = np.repeat(np.arange(len(vertex)), partners)
    offset = np.arange(len(mine)) - np.repeat(np.cumsum(partners) - partners, partners)
    other = order[first[vertex[mine]] + offset]
    gentle = np.einsum("ij,ij->i", unit[mine], unit[other]) > CREASE
    total = np.zeros_like(unit)
    np.add.at(total, mine[gentle], weighted[other[gentle]])
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.where(length > 0.0, total / np.where(length > 0.0, length, 1.0), unit)


def _creased(triangles: NDArray[np.int64], unit: Floats) -> NDArray[np.bool_]:
    """Say of each side (t, 3) whether the two faces along it meet sharply, or only one does."""
    ends = np.roll(triangles, -1, axis=1)
    key = (np.minimum(triangles, ends) * (int(triangles.max(initial=0)) + 1) + np.maximum(triangles, ends)).reshape(-1)
    _, edge = np.unique(key, return_inverse=True)
    face = np.repeat(np.arange(len(triangles)), 3)
    total = np.zeros((int(edge.max(initial=-1)) + 1, 3))
    np.add.at(total, edge, unit[face])
    sharp = np.linalg.norm(total, axis=1) < 2.0 * np.sqrt(0.5 * (1.0 + CREASE))
    return np.asarray(sharp[edge].reshape(-1, 3))


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(np.where(length > 0.0, vectors / np.where(length > 0.0, length, 1.0), [0.0, 0.0, 1.0]))
