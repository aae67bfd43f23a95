"""The turtle of the reference for HEMLS growth: vectors as triples, and successors drawn and fitted to an edge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, radians, sin

from growth.hemls.rules import Segment, Symbol

Vector = tuple[float, float, float]
Frame = tuple[Vector, Vector, Vector]
TINY = 1e-9


def plus(a: Vector, b: Vector, factor: float = 1.0) -> Vector:
    return (a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2])


def times(a: Vector, factor: float) -> Vector:
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a: Vector) -> Vector:
    return times(a, 1 / hypot(*a))


def angle_between(a: Vector, b: Vector) -> float:
    return degrees(atan2(hypot(*cross(a, b)), dot(a, b)))


def turned(a: Vector, axis: Vector, cosine: float, sine: float) -> Vector:
    """Rotate ``a`` about the unit vector ``axis`` by the right-hand rule."""
    return plus(plus(times(a, cosine), cross(axis, a), sine), axis, dot(axis, a) * (1 - cosine))


def placed(local: Vector, frame: Frame) -> Vector:
    """Give the vector that has the components ``local`` along heading, left and up."""
    return plus(plus(times(frame[0], local[0]), frame[1], local[1]), frame[2], local[2])


@dataclass
class Stroke:
    """A drawn segment: from one anchor (a place where the turtle has been) to a new one."""

    segment: Segment
    origin: int
    end: int
    heading: Vector
    bracketed: bool


@dataclass
class Drawing:
    strokes: list[Stroke]
    places: list[Vector]
    """The anchors, in units of the old edge, along its heading, left and up, from its start."""

    @property
    def path(self) -> list[Stroke]:
        return [stroke for stroke in self.strokes if not stroke.bracketed]

    def is_branch(self, stroke: Stroke) -> bool:
        return stroke.bracketed and all(other.origin != stroke.end for other in self.strokes)


def draw(successor: Sequence[Symbol], angle: float) -> Drawing:
    """Follow a successor with unit steps, then fit it to an edge from (0, 0, 0) to (1, 0, 0)."""
    heading, left, up = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    here, places, strokes = 0, [(0.0, 0.0, 0.0)], []
    stack: list[tuple[int, Vector, Vector, Vector]] = []
    for symbol in successor:
        if isinstance(symbol, Segment):
            places.append(plus(places[here], heading))
            strokes.append(Stroke(symbol, here, len(places) - 1, heading, bool(stack)))
            here = len(places) - 1
        elif symbol == "[":
            stack.append((here, heading, left, up))
        elif symbol == "]":
            here, heading, left, up = stack.pop()
        else:
            axis = {"+": up, "-": up, "&": left, "^": left, "\\": heading, "/": heading}[symbol]
            way = radians(angle if symbol in "+&\\" else -angle)
            heading, left, up = (turned(a, axis, cos(way), sin(way)) for a in (heading, left, up))
    return fitted(Drawing(strokes, places))


def fitted(drawing: Drawing) -> Drawing:
    path = drawing.path
    if not path:
        return drawing
    reach = drawing.places[path[-1].end]
    length = hypot(*reach)
    if length < TINY:
        return divided(drawing)
    to = unit(reach)
    axis, sine, cosine = cross(to, (1.0, 0.0, 0.0)), hypot(to[1], to[2]), to[0]
    if sine < TINY:
        axis, sine = (0.0, 0.0, 1.0), 0.0
    for stroke in drawing.strokes:
        stroke.heading = turned(stroke.heading, unit(axis), cosine, sine)
    drawing.places = [times(turned(place, unit(axis), cosine, sine), 1 / length) for place in drawing.places]
    return drawing


def divided(drawing: Drawing) -> Drawing:
    """Lay a path that comes back to its start evenly along the edge; brackets keep their turns."""
    count = len(drawing.path)
    places = {0: (0.0, 0.0, 0.0)}
    done = 0
    for stroke in drawing.strokes:
        if stroke.bracketed:
            places[stroke.end] = plus(places[stroke.origin], stroke.heading, 1 / count)
        else:
            done += 1
            places[stroke.end] = (done / count, 0.0, 0.0)
    drawing.places = [places[index] for index in range(len(places))]
    return drawing
