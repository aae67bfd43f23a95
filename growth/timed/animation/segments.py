"""From drawings to what moves: parts that are the same from one time to the next.

A part is followed by the module that drew it. As long as its shape has the same triangles it can be one node of a
scene: it moves, and its vertices may move within it. Where the colour or the triangles change, or it is not there for a
while, another segment of its life begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from growth.timed.drawing import Drawing, Shape
from growth.timed.tables import Floats

STILL: Final = 1e-9
"""Vertices that move less than this share of the shape's extent stand still: rounding moves them too."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Segment:
    """A part, for as long as it can be one node: k drawings one after the other.

    Attributes
    ----------
    name
        Of its shape.
    first
        The number of the drawing in which it appears; it is in the next k - 1, too.
    shapes
        Its shapes; one where its vertices stand still in its own coordinates, else k.
    frames
        (k, 4, 4) float64, where it stands.
    colour
        (3,) float64, sRGB from 0 to 1.
    """

    name: str
    first: int
    shapes: tuple[Shape, ...]
    frames: Floats
    colour: Floats

    @property
    def last(self) -> int:
        """The number of the last drawing that it is in."""
        return self.first + len(self.frames) - 1


def segments(drawings: Sequence[Drawing]) -> list[Segment]:
    """Follow parts through drawings of ascending times.

    A module that draws several parts of one shape has them in the same order each time.

    Returns
    -------
    By the drawing in which they appear, in that drawing's order.
    """
    going: dict[tuple[int, str, int], _Life] = {}
    ended: list[_Life] = []
    for number, drawing in enumerate(drawings):
        seen: dict[tuple[int, str, int], _Life] = {}
        told: dict[tuple[int, str], int] = {}
        for part, (which, lineage) in enumerate(zip(drawing.which.tolist(), drawing.lineages.tolist(), strict=True)):
            shape = drawing.shapes[which]
            turn = told.get((lineage, shape.name), 0)
            told[lineage, shape.name] = turn + 1
            life = going.pop((lineage, shape.name, turn), None)
            if life is not None and not life.takes(shape, drawing.colours[part]):
                ended.append(life)
                life = None
            if life is None:
                life = _Life(number, part, drawing.colours[part])
            life.shapes.append(shape)
            life.frames.append(drawing.frames[part])
            seen[lineage, shape.name, turn] = life
        ended += going.values()
        going = seen
    ended += going.values()
    return [life.segment() for life in sorted(ended, key=lambda life: (life.first, life.place))]


@final
class _Life:
    """A segment that may go on."""

    def __init__(self, first: int, place: int, colour: Floats) -> None:
        self.first: Final = first
        self.place: Final = place
        self.colour: Final = colour
        self.shapes: Final[list[Shape]] = []
        self.frames: Final[list[Floats]] = []

    def takes(self, shape: Shape, colour: Floats) -> bool:
        """Tell whether it goes on in this shape and colour."""
        last = self.shapes[-1]
        same = last is shape or (
            len(last.vertices) == len(shape.vertices) and np.array_equal(last.triangles, shape.triangles)
        )
        return bool(same and (self.colour == colour).all())

    def segment(self) -> Segment:
        """End it."""
        first = self.shapes[0]
        extent = float(np.ptp(first.vertices, axis=0).max(initial=0.0))
        still = all(
            shape is first or np.allclose(shape.vertices, first.vertices, rtol=0.0, atol=STILL * extent)
            for shape in self.shapes
        )
        shapes = (first,) if still else tuple(self.shapes)
        return Segment(first.name, self.first, shapes, np.stack(self.frames), self.colour)
