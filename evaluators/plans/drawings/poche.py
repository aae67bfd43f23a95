"""Walls cut by openings: pieces along each wall, and the rings around all that is solid at one height."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

from evaluators.plans.drawings.drawing import Drawing, Point, Ring

Kind = Literal["door", "window"]


class Piece(NamedTuple):
    """A stretch of a wall.

    Attributes
    ----------
    ring
        As seen from above, counter-clockwise; neighbours share their corners.
    middle
        On the axis; all corners are seen from it.
    opening
        What is in the wall here.
    """

    ring: Ring
    middle: Point
    opening: Kind | None


def pieces(drawing: Drawing) -> list[Piece]:
    """Cut each wall before and behind its openings."""
    found = []
    for number, wall in enumerate(drawing.walls):
        half = wall.thickness / 2
        start, seam = 0.0, wall.before
        for one in drawing.of_wall(number):
            end = one.start + one.width
            cuts = [(wall.at(far, -half), wall.at(far, half)) for far in (one.start, end)]
            found.append(Piece(seam + cuts[0], wall.at((start + one.start) / 2), None))
            found.append(Piece((*cuts[0][::-1], *cuts[1]), wall.at((one.start + end) / 2), one.kind))
            start, seam = end, cuts[1][::-1]
        found.append(Piece(seam + wall.after, wall.at((start + wall.length) / 2), None))
    return found


def poche(drawing: Drawing, cut: Sequence[Kind]) -> list[Ring]:
    """Give the rings around the walls, without openings of some kinds: solid matter lies left of each."""
    after: dict[Point, list[Point]] = {}
    for piece in pieces(drawing):
        if piece.opening in cut:
            continue
        corners = [rounded(point) for point in piece.ring]
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            if a in after.get(b, ()):
                after[b].remove(a)
            elif a != b:
                after.setdefault(a, []).append(b)
    rings = []
    for first in sorted(after):
        while after[first]:
            ring, at = [first], after[first].pop()
            while at != first:
                ring.append(at)
                at = after[at].pop()
            rings.append(tuple(ring))
    return rings


def rounded(point: Point) -> Point:
    """Give a point by which equal corners of neighbours are known, to a tenth of a micrometre."""
    return round(point[0], 7) + 0.0, round(point[1], 7) + 0.0
