"""A drawing raised to solids: walls with their openings cut out, floors, a slab; closed triangle meshes, z up."""

from __future__ import annotations

import itertools
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from evaluators.plans.drawings.drawing import DOOR_HEAD, HEIGHT, SLAB, WINDOW_SILL, Drawing, Point, Ring
from evaluators.plans.drawings.poche import pieces, rounded

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]

LEVELS: Final = (0.0, WINDOW_SILL, DOOR_HEAD, HEIGHT)
"""Windows are open between the first and the second one, doors below the second; they have one head."""
OPEN: Final = {"door": (True, True, False), "window": (False, True, False), None: (False, False, False)}
FINISH: Final = 0.02
"""The thickness of a room's floor on the slab, in metres."""


class Solid(NamedTuple):
    """A closed mesh.

    Attributes
    ----------
    vertices
        (v, 3) float64, metres.
    triangles
        (t, 3) int32, fronts outward.
    """

    vertices: Floats
    triangles: Indices


def raised_walls(drawing: Drawing) -> Solid:
    """Raise all walls as one closed mesh: storeys high, doors and windows cut out.

    Pieces of walls stand next to each other with equal corners, and all are cut at the same levels: faces that two
    pieces, or two levels of one, share are left out, and what stays is closed.
    """
    mesh = _Mesh()
    parts = pieces(drawing)
    for level, (low, high) in enumerate(itertools.pairwise(LEVELS)):
        beside: dict[tuple[Point, Point], int] = {}
        rings = []
        for piece in parts:
            corners = [rounded(point) for point in piece.ring]
            rings.append([(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True) if a != b])
            if not OPEN[piece.opening][level]:
                beside.update(dict.fromkeys(rings[-1], 1))
        for piece, ring in zip(parts, rings, strict=True):
            state = OPEN[piece.opening]
            if state[level]:
                continue
            middle = rounded(piece.middle)
            for a, b in ring:
                if (b, a) not in beside:
                    mesh.quad((*a, low), (*b, low), (*b, high), (*a, high))
                if level == len(LEVELS) - 2 or state[level + 1]:
                    mesh.triangle((*a, high), (*b, high), (*middle, high))
                if level == 0 or state[level - 1]:
                    mesh.triangle((*b, low), (*a, low), (*middle, low))
    return mesh.solid()


def floors(drawing: Drawing) -> list[Solid]:
    """Give the floor of each room, on the slab between the faces of its walls."""
    return [prism(room.floor, 0.0, FINISH) for room in drawing.rooms]


def slab(drawing: Drawing) -> Solid:
    """Give the slab under the house."""
    return prism(drawing.hull, -SLAB, 0.0)


def prism(ring: Ring, low: float, high: float) -> Solid:
    """Raise a polygon without straight corners."""
    import mapbox_earcut

    count = len(ring)
    flat = np.array(ring, dtype=np.float64)
    ears = mapbox_earcut.triangulate_float64(flat, np.array([count], dtype=np.uint32)).astype(np.int64).reshape(-1, 3)
    a, b, c = flat[ears[:, 0]], flat[ears[:, 1]], flat[ears[:, 2]]
    turned = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) < (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    ears[turned] = ears[turned][:, ::-1]
    at = np.arange(count)
    on = np.roll(at, -1)
    sides = np.concatenate([np.stack([at, on, on + count], axis=1), np.stack([at, on + count, at + count], axis=1)])
    levels = [np.column_stack([flat, np.full(count, z)]) for z in (low, high)]
    return Solid(np.concatenate(levels), np.concatenate([ears[:, ::-1], ears + count, sides]).astype(np.int32))


class _Mesh:
    """Triangles whose corners are known by where they are."""

    def __init__(self) -> None:
        self._places: dict[tuple[float, float, float], int] = {}
        self._triangles: list[tuple[int, int, int]] = []

    def triangle(self, *corners: tuple[float, float, float]) -> None:
        """Add one."""
        a, b, c = (self._places.setdefault(corner, len(self._places)) for corner in corners)
        self._triangles.append((a, b, c))

    def quad(self, *corners: tuple[float, float, float]) -> None:
        """Add two."""
        self.triangle(*corners[:3])
        self.triangle(corners[0], corners[2], corners[3])

    def solid(self) -> Solid:
        """Give them all."""
        return Solid(np.array(list(self._places)), np.array(self._triangles, dtype=np.int32))
