"""Shapes as meshes of a GLB file: round where they turn gently, their vertices parted at creases."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from growth.bodies import smooth_body
from growth.timed.drawing import Shape
from growth.timed.tables import Floats, Ints


class Parted(NamedTuple):
    """A shape whose vertices are parted at creases, n of them.

    Attributes
    ----------
    sources
        (n,) int64, the shape's own vertices.
    triangles
        (t, 3) int64, corners among the n.
    """

    sources: Ints
    triangles: Ints


def parted(shape: Shape) -> Parted:
    """Part the vertices of a shape where faces meet sharply; each part has one normal."""
    colours = np.zeros((len(shape.triangles), 3))
    normals = smooth_body(shape.vertices, shape.triangles, colours, 0.0).normals.reshape(-1, 3)
    corners = shape.triangles.reshape(-1).astype(np.int64)
    keys = np.column_stack([corners, np.round(normals * 1024.0)])
    rows, inverse = np.unique(keys, axis=0, return_inverse=True)
    return Parted(rows[:, 0].astype(np.int64), inverse.reshape(-1, 3).astype(np.int64))


def normals_of(vertices: Floats, shape: Parted) -> Floats:
    """Give the unit normals (n, 3) of parted vertices: of their triangles, weighted by area.

    Parameters
    ----------
    vertices
        (v, 3) float64, of the shape at any time.
    shape
        How it is parted.
    """
    a, b, c = vertices[shape.sources].T[:, shape.triangles.T].swapaxes(0, 1)
    (px, py, pz), (qx, qy, qz) = b - a, c - a
    flat = np.stack([py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx])
    corners, count = shape.triangles.reshape(-1), len(shape.sources)
    total = np.stack([np.bincount(corners, np.repeat(along, 3), count) for along in flat], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.asarray(np.where(length > 0.0, total / np.where(length > 0.0, length, 1.0), [0.0, 0.0, 1.0]))
