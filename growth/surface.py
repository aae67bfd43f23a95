"""The phenotype of the surface engines: a mesh of polygons with labelled, directed edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Indices = NDArray[np.int32]


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """A grown surface.

    Attributes
    ----------
    vertices
        (V, 3) float64, positions in the environment's unit, z up.
    edges
        (E, 2) int32, start and end vertex of each edge.
    labels
        (E,) int32, the label of each edge, an index into ``label_names``.
    label_names
        The labels as the rules write them, such as ``Edge0`` or ``A``.
    face_starts
        (F + 1,) int32, where each face's ring begins in ``face_vertices``; the exterior is not among the faces.
    face_vertices
        (sum of ring lengths,) int32, the rings one after the other, counter-clockwise seen from the seed's normal.
        A ring of two vertices (two edges that join the same pair) has no area.
    """

    vertices: Points
    edges: Indices
    labels: Indices
    label_names: tuple[str, ...]
    face_starts: Indices
    face_vertices: Indices

    @property
    def counts(self) -> tuple[int, int, int]:
        """The numbers of vertices, edges and faces."""
        return len(self.vertices), len(self.edges), len(self.face_starts) - 1

    def face(self, index: int) -> Indices:
        """Give the vertex ring of one face."""
        return self.face_vertices[self.face_starts[index] : self.face_starts[index + 1]]


def surface_of(vertices: Points, triangles: NDArray[np.integer[Any]]) -> Surface:
    """Give triangles as a surface; its edges are those of the triangles, each once, in ascending order.

    Parameters
    ----------
    vertices
        (v, 3) float64.
    triangles
        (t, 3), places in ``vertices``.
    """
    sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    # One number a pair: to sort rows takes ten times as long.
    keys = np.unique(sides[:, 0].astype(np.int64) * len(vertices) + sides[:, 1])
    edges = np.stack(np.divmod(keys, max(len(vertices), 1)), axis=1).astype(np.int32)
    starts = np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int32)
    labels = np.zeros(len(edges), dtype=np.int32)
    return Surface(vertices, edges, labels, ("Edge0",), starts, triangles.reshape(-1).astype(np.int32))
