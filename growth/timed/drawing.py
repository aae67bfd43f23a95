"""What the turtle draws of a word: parts, each a shape of its own and the place where it stands.

Shapes are few and parts are many: all straight cylinders are one shape, scaled. An animation therefore moves parts, and
need not send meshes, where only places change.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, final

import numpy as np

from growth.surface import Indices, Surface, surface_of
from growth.timed.tables import Floats, Ints

__all__ = ["Drawing", "Shape", "surface_of"]


class Shape(NamedTuple):
    """A shape in coordinates of its own.

    Attributes
    ----------
    name
        ``cylinder``, ``sphere``, ``disc``, ``carrier`` (a generalised cylinder), ``polygon`` or ``surface``.
    vertices
        (v, 3) float64.
    triangles
        (t, 3) int32, counter-clockwise seen from outside.
    closed
        Whether it bounds a volume.
    """

    name: str
    vertices: Floats
    triangles: Indices
    closed: bool


@final
@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """The form of a word at one time: p parts, k tips.

    Attributes
    ----------
    time
        The word's time.
    shapes
        Those that the parts have.
    which
        (p,) int64, places in ``shapes``.
    frames
        (p, 4, 4) float64, from the shape's coordinates to the world's, z up, scale included; last rows 0 0 0 1.
    colours
        (p, 3) float64, red, green and blue of sRGB, from 0 to 1.
    lineages
        (p,) int64, of the module that drew the part (a carrier's, polygon's: of the module that began it).
    tips
        (k, 3) float64, where branches end: the turtle's places before each closing bracket, and at the word's end.
    tip_lineages
        (k,) int64, of the module that moved the turtle there last; equal at two times for tips that are the same.
    """

    time: float
    shapes: tuple[Shape, ...]
    which: Ints
    frames: Floats
    colours: Floats
    lineages: Ints
    tips: Floats
    tip_lineages: Ints

    def __len__(self) -> int:
        return len(self.which)

    def corners(self, part: int) -> Floats:
        """Give the vertices of a part in the world, (v, 3) float64."""
        frame = self.frames[part]
        return np.asarray(self.shapes[self.which[part]].vertices @ frame[:3, :3].T + frame[:3, 3])

    def surface(self) -> Surface:
        """Give all parts as one surface of triangles, in their order; a vertex belongs to one part alone."""
        corners = [np.empty((0, 3))]
        triangles = [np.empty((0, 3), dtype=np.int64)]
        count = 0
        for part, which in enumerate(self.which.tolist()):
            corners.append(self.corners(part))
            triangles.append(self.shapes[which].triangles.astype(np.int64) + count)
            count += len(corners[-1])
        return surface_of(np.concatenate(corners), np.concatenate(triangles))
