"""The map: vertices, edges and regions as a half-edge structure in arrays (Hemberg 2006, definition 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from growth.hemls import _whole
from growth.hemls.rules import Segment
from growth.surface import Surface

EXTERIOR = _whole.EXTERIOR
Scalar = TypeVar("Scalar", bound=np.generic)
_CORNERS = ("origin", "next", "prev", "face")


@dataclass(slots=True, eq=False)
class HalfEdgeMap:
    """A map under growth.

    Half-edge ``2 e`` runs from the start of edge ``e`` to its end, ``2 e + 1`` back. Arrays are longer than what is
    in use; ``vertices``, ``edges`` and ``faces`` count that.

    Attributes
    ----------
    points
        (>= vertices, 3) float64 positions.
    origin, next, prev, face
        (>= 2 edges,) int32, for each half-edge: its first vertex, its neighbours in the loop of its face, and the
        face to its left, -1 for the exterior.
    label
        (>= edges,) int32.
    made
        (>= edges,) bool, whether the edge was made by rewriting in the step under way.
    """

    points: NDArray[np.float64]
    origin: NDArray[np.int32]
    next: NDArray[np.int32]
    prev: NDArray[np.int32]
    face: NDArray[np.int32]
    label: NDArray[np.int32]
    made: NDArray[np.bool_] = field(repr=False)
    vertices: int
    edges: int
    faces: int

    def reserve(self, vertices: int, edges: int) -> None:
        """Make room for so many vertices and edges in all."""
        if vertices > len(self.points):
            self.points = _longer(self.points, max(vertices, 2 * len(self.points)))
        if edges > len(self.label):
            room = max(edges, 2 * len(self.label))
            used = len(self.made)
            self.label, self.made = _longer(self.label, room), _longer(self.made, room)
            self.made[used:] = False
            for name in _CORNERS:
                setattr(self, name, _longer(getattr(self, name), 2 * room))

    def surface(self, label_names: tuple[str, ...]) -> Surface:
        """Give the map as a phenotype, with arrays of its own."""
        starts, ring = _whole.rings(self.origin, self.next, self.face, self.edges, self.faces)
        return Surface(
            vertices=self.points[: self.vertices].copy(),
            edges=self.origin[: 2 * self.edges].reshape(-1, 2).copy(),
            labels=self.label[: self.edges].copy(),
            label_names=label_names,
            face_starts=starts,
            face_vertices=ring,
        )


def seed(axiom: tuple[Segment, ...], length: float, place: tuple[float, float, float]) -> HalfEdgeMap:
    """Make the seed: a regular polygon about ``place`` with normal +z and its first side parallel to x.

    Parameters
    ----------
    axiom
        The sides, counter-clockwise seen from +z.
    length
        Length of a side.
    place
        The polygon's centre.
    """
    n = len(axiom)
    radius = length / (2 * math.sin(math.pi / n))
    turns = -math.pi / 2 - math.pi / n + 2 * math.pi * np.arange(n) / n
    points = np.zeros((n, 3))
    points[:, 0], points[:, 1] = radius * np.cos(turns), radius * np.sin(turns)
    points += np.asarray(place, dtype=np.float64)
    inner = np.array([2 * i + segment.reversed for i, segment in enumerate(axiom)], dtype=np.int32)
    outer = inner ^ 1
    names = ("origin", "next", "prev", "face")
    corners = {name: np.zeros(2 * n, dtype=np.int32) for name in names}
    corners["origin"][inner], corners["origin"][outer] = np.arange(n), (np.arange(n) + 1) % n
    corners["next"][inner], corners["prev"][inner] = np.roll(inner, -1), np.roll(inner, 1)
    corners["next"][outer], corners["prev"][outer] = np.roll(outer, 1), np.roll(outer, -1)
    corners["face"][outer] = EXTERIOR
    label = np.array([segment.label for segment in axiom], dtype=np.int32)
    return HalfEdgeMap(points, **corners, label=label, made=np.zeros(n, dtype=np.bool_), vertices=n, edges=n, faces=1)


def _longer(array: NDArray[Scalar], length: int) -> NDArray[Scalar]:
    out = np.empty((length, *array.shape[1:]), dtype=array.dtype)
    out[: len(array)] = array
    return out
