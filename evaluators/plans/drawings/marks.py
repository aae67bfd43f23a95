"""A drawing as marks on paper, which the writers of SVG and PNG, and sheets of several plans, share.

Paper is measured in millimetres, x to the right and y down.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, final

from evaluators.plans.brief import Side
from evaluators.plans.drawings.draw import plain
from evaluators.plans.drawings.drawing import Drawing, DrawnRoom, Opening, Point
from evaluators.plans.drawings.poche import poche

INK: Final = "#1d1d1f"
PALE: Final = "#8a8a8e"
SITE: Final = "#5f7f5a"
PAPER: Final = "#ffffff"
TINTS: Final = ("#f6ecd9", "#e6eef4", "#eaf1e2", "#f5e3de", "#eae5f2", "#f3f0d6", "#dfeeea", "#f0e4ea")
"""Of rooms in turn."""

HAIR: Final = 0.13
FINE: Final = 0.18
LINE: Final = 0.25
"""Widths of lines in millimetres."""

SCALES: Final = (20, 50, 100, 200, 500, 1000, 2000, 5000, 10000)
PAGE: Final = (390.0, 267.0)
"""What of an A3 page is drawn on, in millimetres."""

Rings = tuple[tuple[Point, ...], ...]


@final
@dataclass(frozen=True, slots=True)
class Fill:
    """Polygons, of which the inner ones are holes."""

    kind: str
    rings: Rings
    colour: str
    name: str = ""


@final
@dataclass(frozen=True, slots=True)
class Stroke:
    """A line of several points, or a closed one."""

    kind: str
    points: tuple[Point, ...]
    width: float = FINE
    colour: str = INK
    closed: bool = False
    dashes: tuple[float, ...] = ()


@final
@dataclass(frozen=True, slots=True)
class Words:
    """A line of text; ``at`` is its middle, or where it begins, on the base line; ``turn`` in degrees to the left."""

    kind: str
    text: str
    at: Point
    size: float
    anchor: str = "middle"
    turn: int = 0
    bold: bool = False
    colour: str = INK


Mark = Fill | Stroke | Words


@final
@dataclass(frozen=True, slots=True)
class Paper:
    """Marks on a page of so many millimetres."""

    title: str
    width: float
    height: float
    marks: tuple[Mark, ...]


class Pen:
    """Puts metres on paper.

    Parameters
    ----------
    scale
        Millimetres of a metre.
    origin
        Where on paper the drawing's origin lies.
    """

    def __init__(self, scale: float, origin: Point) -> None:
        self.scale: Final = scale
        self._origin: Final = origin

    def __call__(self, point: Point) -> Point:
        """Give a point on paper."""
        return self._origin[0] + self.scale * point[0], self._origin[1] - self.scale * point[1]

    def ring(self, points: Sequence[Point]) -> tuple[Point, ...]:
        """Give points on paper."""
        return tuple(self(point) for point in points)


def page(drawing: Drawing) -> Paper:
    """Lay a drawing on a page of its own: dimensions, site, scale bar, north and title around the plan."""
    low, high = extent(drawing, dimensioned=True)
    ratio = next((s for s in SCALES if _fits(low, high, 1000 / s)), SCALES[-1])
    scale, margin, foot = 1000 / ratio, 8.0, 22.0
    width = max((high[0] - low[0]) * scale, 110.0) + 2 * margin
    height = (high[1] - low[1]) * scale + 2 * margin + foot
    left = (width - (high[0] - low[0]) * scale) / 2
    pen = Pen(scale, (left - low[0] * scale, margin + high[1] * scale))
    marks = [
        Fill("paper", (((0.0, 0.0), (width, 0.0), (width, height), (0.0, height)),), PAPER),
        *site(drawing, pen),
        *plan(drawing, pen),
        *_dimensions(drawing, pen),
        *_legend(drawing, ratio, margin, width - margin, height - margin),
    ]
    return Paper(drawing.title, width, height, tuple(marks))


def extent(drawing: Drawing, *, dimensioned: bool) -> tuple[Point, Point]:
    """Give the box around a drawing, in metres."""
    points = list(drawing.hull)
    if dimensioned:
        points += [point for one in drawing.dimensions for point in (one.first, one.last)]
        points += [point for one in drawing.doors for point in drawing.leaf(one)]
        points += drawing.ground.outline or ()
    xs, ys = zip(*points, strict=True)
    more = 0.8 if dimensioned else 0.0
    return (min(xs) - more, min(ys) - more), (max(xs) + more, max(ys) + more)


def _fits(low: Point, high: Point, scale: float) -> bool:
    return (high[0] - low[0]) * scale <= PAGE[0] and (high[1] - low[1]) * scale <= PAGE[1]


def plan(drawing: Drawing, pen: Pen, short: Mapping[str, str] | None = None) -> Iterator[Mark]:
    """Draw rooms, walls, doors and windows, and the rooms' names and areas, or what stands for them in short."""
    for number, room in enumerate(drawing.rooms):
        yield Fill("room", (pen.ring(room.outline),), TINTS[number % len(TINTS)], room.name)
    bodies = tuple(pen.ring(ring) for ring in poche(drawing, ("door", "window")))
    yield Fill("walls", bodies, INK)
    for opening in drawing.openings:
        yield from _door(drawing, opening, pen) if opening.kind == "door" else _window(drawing, opening, pen)
    for room in drawing.rooms:
        yield from _name(room, pen) if short is None else _abbreviated(room, short[room.name], pen)


def _door(drawing: Drawing, door: Opening, pen: Pen) -> Iterator[Mark]:
    """Draw a threshold, the leaf as it stands open, and the way of its tip."""
    wall, leaf = drawing.walls[door.wall], drawing.leaf(door)
    half = wall.thickness / 2
    for face in (half, -half):
        ends = (wall.at(door.start, face), wall.at(door.start + door.width, face))
        yield Stroke("threshold", pen.ring(ends), HAIR, PALE)
    yield Stroke("door", pen.ring((leaf.hinge, leaf.tip)), 2 * LINE)
    yield Stroke("swing", pen.ring(arc(leaf.hinge, leaf.tip, leaf.jamb)), HAIR)


def arc(middle: Point, first: Point, last: Point, pieces: int = 16) -> list[Point]:
    """Give points on the quarter circle between two points that are as far from its middle."""
    turns = [math.pi / 2 * k / pieces for k in range(pieces + 1)]
    a, b = ((point[0] - middle[0], point[1] - middle[1]) for point in (first, last))
    return [
        (middle[0] + math.cos(t) * a[0] + math.sin(t) * b[0], middle[1] + math.cos(t) * a[1] + math.sin(t) * b[1])
        for t in turns
    ]


def _window(drawing: Drawing, window: Opening, pen: Pen) -> Iterator[Mark]:
    """Draw the sills, and the glass between them."""
    wall = drawing.walls[window.wall]
    half = wall.thickness / 2
    ends = (window.start, window.start + window.width)
    ring = (wall.at(ends[0], half), wall.at(ends[0], -half), wall.at(ends[1], -half), wall.at(ends[1], half))
    yield Fill("window", (pen.ring(ring),), PAPER)
    yield Stroke("sill", pen.ring(ring), FINE, closed=True)
    for aside in (-half / 5, half / 5):
        yield Stroke("glass", pen.ring((wall.at(ends[0], aside), wall.at(ends[1], aside))), HAIR)


def _name(room: DrawnRoom, pen: Pen) -> Iterator[Mark]:
    x, y = pen(room.label.at)
    size = pen.scale * room.label.size
    for line, (text, bold) in enumerate(((plain(room.name), True), (f"{room.area:.1f} m²", False))):
        down = (-0.22 if line == 0 else 1.0) * size
        at = (x + down, y) if room.label.upright else (x, y + down)
        yield Words("name" if bold else "area", text, at, size * (1.0 if bold else 0.88), "middle",
                    90 if room.label.upright else 0, bold)  # fmt: skip


def _abbreviated(room: DrawnRoom, text: str, pen: Pen) -> Iterator[Mark]:
    x, y = pen(room.label.at)
    size = max(1.25 * pen.scale * room.label.size, 1.5)
    yield Words("name", text, (x, y + 0.36 * size), size)


def abbreviations(names: Sequence[str]) -> dict[str, str]:
    """Give short names, each its own: initials, and of those that share them as many letters as tell them apart."""
    found: dict[str, str] = {}
    for name in names:
        parts = [word for word in name.split("_") if word] or [name]
        found[name] = "".join(word[0].upper() for word in parts)
    letters = 2
    while len(set(found.values())) < len(found) and letters <= max(map(len, names)):
        taken = list(found.values())
        for name, short in list(found.items()):
            if taken.count(short) > 1:
                first, *rest = [word for word in name.split("_") if word] or [name]
                found[name] = first[:letters].capitalize() + "".join(word[0].upper() for word in rest)
        letters += 1
    return found


def _dimensions(drawing: Drawing, pen: Pen) -> Iterator[Mark]:
    """Draw dimension lines with oblique ticks, and the figures above them, or left of them."""
    size = min([2.0, *(0.3 * one.length * pen.scale for one in drawing.dimensions)])
    for one in drawing.dimensions:
        first, last = pen(one.first), pen(one.last)
        level = one.side in ("south", "north")
        over = 1.2
        ends = ((first[0] - over, first[1]), (last[0] + over, last[1])) if level else (
            (first[0], first[1] + over), (last[0], last[1] - over))  # fmt: skip
        yield Stroke("dimension", ends, HAIR)
        for x, y in (first, last):
            yield Stroke("tick", ((x - 0.8, y + 0.8), (x + 0.8, y - 0.8)), LINE)
            yield Stroke("reach", ((x, y - 1.6), (x, y + 1.6)) if level else ((x - 1.6, y), (x + 1.6, y)), HAIR)
        middle = ((first[0] + last[0]) / 2, (first[1] + last[1]) / 2)
        at = (middle[0], middle[1] - 0.8) if level else (middle[0] - 0.8, middle[1])
        yield Words("figure", f"{one.length:.2f}", at, size, turn=0 if level else 90)


def site(drawing: Drawing, pen: Pen) -> Iterator[Mark]:
    """Draw the site's outline, and where street and view lie."""
    ground = drawing.ground
    if ground.outline is not None:
        yield Stroke("site", pen.ring(ground.outline), LINE, SITE, closed=True, dashes=(4.0, 1.2, 0.8, 1.2))
    low, high = extent(drawing, dimensioned=True)
    for side, text in ((ground.street, "STREET"), (ground.view, "VIEW")):
        if side is not None:
            at, turn = _beside(side, pen(low), pen(high))
            yield Words("side", text, at, 2.4, "middle", turn, colour=SITE)


def _beside(side: Side, low: Point, high: Point) -> tuple[Point, int]:
    (left, bottom), (right, top) = low, high
    x, y = (left + right) / 2, (top + bottom) / 2
    return {
        "north": ((x, top + 2.0), 0), "south": ((x, bottom + 0.5), 0),
        "east": ((right - 0.5, y), 90), "west": ((left + 2.0, y), 90),
    }[side]  # fmt: skip


def _legend(drawing: Drawing, ratio: int, left: float, right: float, bottom: float) -> Iterator[Mark]:
    """Draw the title, the scale with a bar of whole metres, and the north arrow."""
    top = bottom - 14.0
    yield Stroke("rule", ((left, top - 3.0), (right, top - 3.0)), HAIR, PALE)
    yield Words("title", drawing.title, (left, top + 3.2), 3.6, "start", bold=True)
    told = f"{len(drawing.rooms)} rooms, {drawing.area:.1f} m² to the walls' axes; lengths in metres"
    yield Words("note", told, (left, top + 8.0), 2.3, "start", colour=PALE)
    step = next(s for s in (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200) if 1000 / ratio * s >= 7.0)
    pen = Pen(1000 / ratio, (left, bottom))
    for k, (a, b) in enumerate(itertools.pairwise(range(4))):
        ring = ((a * step, 0.0), (b * step, 0.0), (b * step, 1.2 * ratio / 1000), (a * step, 1.2 * ratio / 1000))
        yield Fill("scale", (pen.ring(ring),), INK if k % 2 == 0 else PAPER)
        yield Stroke("scale", pen.ring(ring), HAIR, closed=True)
    end = left + 3 * step * pen.scale
    yield Words("note", f"{3 * step:g} m, scale 1:{ratio}", (end + 2.0, bottom), 2.3, "start")
    x, y = right - 5.0, top + 7.0
    yield Fill("north", (((x, y - 6.0), (x + 2.2, y + 3.0), (x, y + 1.2)),), INK)
    yield Stroke("north", ((x, y - 6.0), (x + 2.2, y + 3.0), (x, y + 1.2), (x - 2.2, y + 3.0)), FINE, closed=True)
    yield Words("note", "N", (x, y + 7.0), 3.0, bold=True)


def moved(mark: Mark, right: float, down: float) -> Mark:
    """Give a mark elsewhere on its page."""
    if isinstance(mark, Fill):
        return replace(mark, rings=tuple(tuple((x + right, y + down) for x, y in ring) for ring in mark.rings))
    if isinstance(mark, Stroke):
        return replace(mark, points=tuple((x + right, y + down) for x, y in mark.points))
    return replace(mark, at=(mark.at[0] + right, mark.at[1] + down))
