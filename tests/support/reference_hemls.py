"""HEMLS growth once more, from the specification alone: what the compiled engine must equal.

Plain lists, dictionaries and floats, and another picture of the map than the engine's: a region is a cyclic list of
darts (an edge and which way it is walked, the region on its left), and a branch is held by a corner of its region,
which is named by the dart that leaves the corner. No forces, no boundaries.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import atan2, cos, degrees, hypot, pi, radians, sin

from growth.hemls.rules import Rule, Segment, Symbol, System

Vector = tuple[float, float, float]
Frame = tuple[Vector, Vector, Vector]
Dart = tuple[int, bool]
OUTSIDE = 0
TINY = 1e-9
ALONG = 1e-6
"""Degrees under which two directions are one."""


def plus(a: Vector, b: Vector, times: float = 1.0) -> Vector:
    return (a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2])


def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a: Vector) -> Vector:
    return plus((0.0, 0.0, 0.0), a, 1 / hypot(*a))


def angle_between(a: Vector, b: Vector) -> float:
    return degrees(atan2(hypot(*cross(a, b)), dot(a, b)))


def turned(a: Vector, axis: Vector, cosine: float, sine: float) -> Vector:
    """Rotate ``a`` about the unit vector ``axis`` by the right-hand rule."""
    return plus(
        plus((a[0] * cosine, a[1] * cosine, a[2] * cosine), cross(axis, a), sine), axis, dot(axis, a) * (1 - cosine)
    )


def placed(local: Vector, frame: Frame) -> Vector:
    """Give the vector that has the components ``local`` along heading, left and up."""
    return plus(plus(plus((0.0, 0.0, 0.0), frame[0], local[0]), frame[1], local[1]), frame[2], local[2])


# --- The turtle ------------------------------------------------------------------------------------------------------


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
    drawing.places = [
        plus((0.0, 0.0, 0.0), turned(place, unit(axis), cosine, sine), 1 / length) for place in drawing.places
    ]
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


# --- The map ---------------------------------------------------------------------------------------------------------


@dataclass
class Edge:
    start: int
    end: int
    label: int


@dataclass
class Branch:
    vertex: int
    heading: Vector
    label: int
    frame: Frame
    corner: Dart
    """The dart that leaves the corner which the branch points into."""


@dataclass
class Bracketed:
    """A segment drawn inside brackets; one that is a branch has no vertex at its end."""

    segment: Segment
    origin: int
    end: int | None
    first: Dart | None
    """A dart that leaves the origin; not known yet where that is in a bracket itself."""
    heading: Vector
    frame: Frame


def near(angle: float, middle: float) -> float:
    """Give an angle that is the same but for full turns, within half a turn of ``middle``."""
    return middle + (angle - middle + 180) % 360 - 180


def back(dart: Dart) -> Dart:
    return dart[0], not dart[1]


class Map:
    def __init__(self, axiom: Sequence[Segment]) -> None:
        count = len(axiom)
        radius = 0.5 / sin(pi / count)
        self.points: dict[int, Vector] = {}
        self.edges: dict[int, Edge] = {}
        self.regions: dict[int, list[Dart]] = {OUTSIDE: [], 1: []}
        self.side: dict[Dart, int] = {}
        self.leaving: dict[int, list[Dart]] = {}
        self.branches: list[Branch] = []
        self.next_vertex = self.next_edge = 0
        self.next_region = 2
        for corner in range(count):
            way = -pi / 2 - pi / count + 2 * pi * corner / count
            self.new_vertex((radius * cos(way), radius * sin(way), 0.0))
        for number, segment in enumerate(axiom):
            self.new_edge(number, (number + 1) % count, segment)
            dart = (number, not segment.reversed)
            self.regions[1].append(dart)
            self.regions[OUTSIDE].insert(0, back(dart))
        self.settle(OUTSIDE, 1)

    def new_vertex(self, point: Vector) -> int:
        self.points[self.next_vertex] = point
        self.leaving[self.next_vertex] = []
        self.next_vertex += 1
        return self.next_vertex - 1

    def new_edge(self, first: int, last: int, segment: Segment, number: int | None = None) -> Dart:
        """Add an edge and give the dart that walks it from ``first`` to ``last``; no region knows it yet."""
        if number is None:
            number, self.next_edge = self.next_edge, self.next_edge + 1
        start, end = (last, first) if segment.reversed else (first, last)
        self.edges[number] = Edge(start, end, segment.label)
        self.leaving[start].append((number, True))
        self.leaving[end].append((number, False))
        return number, not segment.reversed

    def drop_edge(self, number: int) -> None:
        edge = self.edges.pop(number)
        self.leaving[edge.start].remove((number, True))
        self.leaving[edge.end].remove((number, False))
        del self.side[number, True], self.side[number, False]

    def settle(self, *regions: int) -> None:
        for region in regions:
            self.side.update(dict.fromkeys(self.regions[region], region))

    def ends(self, dart: Dart) -> tuple[int, int]:
        edge = self.edges[dart[0]]
        return (edge.start, edge.end) if dart[1] else (edge.end, edge.start)

    def direction(self, dart: Dart) -> Vector:
        first, last = self.ends(dart)
        return plus(self.points[last], self.points[first], -1)

    def before(self, dart: Dart) -> Dart:
        boundary = self.regions[self.side[dart]]
        return boundary[boundary.index(dart) - 1]

    def normal(self, region: int) -> Vector:
        """Give the unit normal of a region, or zero for the exterior and for one without area."""
        total, size = (0.0, 0.0, 0.0), 0.0
        if region != OUTSIDE:
            anchor = self.points[self.ends(self.regions[region][0])[0]]
            for dart in self.regions[region]:
                first, last = (plus(self.points[vertex], anchor, -1) for vertex in self.ends(dart))
                total = plus(total, cross(first, last))
                size += dot(self.direction(dart), self.direction(dart))
        return unit(total) if hypot(*total) > TINY * size else (0.0, 0.0, 0.0)

    def extent(self) -> float:
        return max(max(axis) - min(axis) for axis in zip(*self.points.values(), strict=True))

    def frame(self, number: int) -> Frame:
        heading = unit(self.direction((number, True)))
        normals = [self.normal(self.side[dart]) for dart in ((number, True), (number, False))]
        mean = plus(normals[0], normals[1])
        if hypot(*mean) < TINY:  # opposite normals: that on the left counts
            mean = normals[0] if hypot(*normals[0]) else normals[1]
        across = plus(mean, heading, -dot(mean, heading))
        if hypot(*across) < TINY:  # no region tells where up is
            guess = (0.0, 0.0, 1.0) if abs(heading[2]) < 0.9 else (0.0, 1.0, 0.0)
            across = plus(guess, heading, -dot(guess, heading))
        return heading, cross(unit(across), heading), unit(across)

    def counts(self) -> tuple[int, int, int]:
        return len(self.points), len(self.edges), len(self.regions) - 1

    # Corners: where does a direction point?

    def bearing(self, direction: Vector, frame: Frame) -> float | None:
        """Give degrees from the frame's heading towards its left, ``None`` for a direction straight up or down."""
        x, y = dot(direction, frame[0]), dot(direction, frame[1])
        return degrees(atan2(y, x)) if hypot(x, y) > TINY * hypot(*direction) else None

    def corner(self, first: Dart, heading: Vector, frame: Frame) -> Dart | str:
        """Find the corner at the start of ``first`` that a heading points into, or say why there is none.

        On a folded surface several corners may hold it: the first one counter-clockwise from ``first`` counts. One
        beside an edge that goes straight up or down holds nothing.
        """
        found: Dart | str = "nowhere"
        dart = first
        while True:
            following = back(self.before(dart))
            way, left, right = (
                self.bearing(direction, frame)
                for direction in (heading, self.direction(following), self.direction(dart))
            )
            if way is not None and right is not None:
                turn = (way - right) % 360
                if turn < ALONG or turn > 360 - ALONG:
                    return "along"
                if found == "nowhere" and turn < self.span(dart, left, right):
                    found = dart
            dart = following
            if dart == first:
                return found

    def span(self, dart: Dart, left: float | None, right: float) -> float:
        """Give the degrees of the corner between two bearings; none between two edges that lie on each other."""
        if back(self.before(dart)) == dart:
            return 360.0
        span = -1.0 if left is None else (left - right) % 360
        return 0.0 if span > 360 - ALONG else span

    def part(self, corner: Dart, new: Dart) -> None:
        """Share the branches of a corner out between it and that of a new edge that leaves from within it.

        The new edge bends away from its headings and can leave the corner on either side: the nearer one.
        """
        staying = []
        for branch in self.branches:
            if branch.corner == corner:
                beyond = back(self.before(new))
                base, last, cut, way = (
                    self.bearing(direction, branch.frame)
                    for direction in (*(self.direction(dart) for dart in (corner, beyond, new)), branch.heading)
                )
                if base is None or last is None or cut is None or way is None:
                    continue
                span = 360.0 if beyond == corner else (last - base) % 360
                span = 0.0 if span > 360 - ALONG and beyond != corner else span
                cut, way = near(cut - base, span / 2), near(way - base, span / 2)
                if abs(cut - way) < ALONG:
                    continue
                branch.corner = corner if way < cut else new
            staying.append(branch)
        self.branches = staying

    def look_again(self) -> None:
        """Find the corners of older branches in what is drawn now; they keep their regions."""
        staying = []
        for branch in self.branches:
            found = self.corner(branch.corner, branch.heading, branch.frame)
            if found != "along":
                staying.append(branch)
            if isinstance(found, tuple) and self.side[found] == self.side[branch.corner]:
                branch.corner = found
        self.branches = staying

    # Rewriting

    def rewrite(self, number: int, drawing: Drawing, frame: Frame) -> list[Bracketed]:
        """Replace an edge by a path, and number all that is drawn; brackets are placed later."""
        edge = self.edges[number]
        origin, length = self.points[edge.start], hypot(*self.direction((number, True)))
        path = drawing.path
        vertices, first = {0: edge.start}, {0: (number, True)}
        if path:
            vertices[path[-1].end] = edge.end
        chains = [stroke for stroke in drawing.strokes if stroke.bracketed and not drawing.is_branch(stroke)]
        for stroke in path[:-1] + chains:
            vertices[stroke.end] = self.new_vertex(plus(origin, placed(drawing.places[stroke.end], frame), length))
        if path:
            darts = self.replace(number, [(vertices[s.origin], vertices[s.end], s.segment) for s in path])
            first = {stroke.origin: dart for stroke, dart in zip(path, darts, strict=True)}
            first[path[-1].end] = back(darts[-1])
        return [
            Bracketed(
                s.segment, vertices[s.origin], vertices.get(s.end), first.get(s.origin), placed(s.heading, frame), frame
            )
            for s in drawing.strokes
            if s.bracketed
        ]

    def replace(self, number: int, pieces: list[tuple[int, int, Segment]]) -> list[Dart]:
        along, against = (number, True), (number, False)
        left, right = self.side[along], self.side[against]
        self.drop_edge(number)
        darts = [self.new_edge(*piece, None if index else number) for index, piece in enumerate(pieces)]
        others = [back(dart) for dart in reversed(darts)]
        for region, old, new in ((left, along, darts), (right, against, others)):
            place = self.regions[region].index(old)
            self.regions[region][place : place + 1] = new
        self.settle(left, right)
        for branch in self.branches:
            if branch.corner == along:
                branch.corner = darts[0]
            elif branch.corner == against:
                branch.corner = others[0]
        return darts

    def place(self, bracketed: Sequence[Bracketed]) -> None:
        """Put bracketed edges into the regions that they point into, then the branches; drop what is outside."""
        first: dict[int, Dart] = {}
        for drawn in bracketed:
            if drawn.end is None:
                continue
            corner = self.held(drawn, first)
            if corner is None:
                self.drop_vertex(drawn.end)
                continue
            new = self.new_edge(drawn.origin, drawn.end, drawn.segment)
            boundary = self.regions[self.side[corner]]
            turn = boundary.index(corner)
            boundary[turn:turn] = [new, back(new)]
            self.settle(self.side[corner])
            first[drawn.end] = back(new)
        self.look_again()
        for drawn in bracketed:
            corner = self.held(drawn, first) if drawn.end is None else None
            if corner is not None:
                self.branches.append(Branch(drawn.origin, drawn.heading, drawn.segment.label, drawn.frame, corner))

    def held(self, drawn: Bracketed, first: dict[int, Dart]) -> Dart | None:
        start = drawn.first or first.get(drawn.origin)
        corner = self.corner(start, drawn.heading, drawn.frame) if start else None
        return corner if isinstance(corner, tuple) and self.side[corner] != OUTSIDE else None

    def drop_vertex(self, vertex: int) -> None:
        del self.points[vertex], self.leaving[vertex]

    # Joining

    def join_all(self, branch_angle: float) -> None:
        """Join pairs of branches, best first; a pair that a join has parted is passed over."""
        least = TINY * self.extent()
        waiting: list[tuple[tuple[float, float, int, int, int], Branch, Branch]] = []
        for one, two in combinations(self.branches, 2):
            if one.label != two.label or self.side[one.corner] != self.side[two.corner]:
                continue
            low, high = (one, two) if one.vertex < two.vertex else (two, one)
            across = plus(self.points[high.vertex], self.points[low.vertex], -1)
            if low.vertex == high.vertex or hypot(*across) <= least:
                continue
            angles = (
                angle_between(low.heading, across),
                angle_between(high.heading, plus((0.0, 0.0, 0.0), across, -1)),
            )
            if max(angles) < branch_angle - ALONG:
                key = (round(sum(angles), 6), round(hypot(*across) / least), low.vertex, high.vertex, low.label)
                waiting.append((key, low, high))
        for _, low, high in sorted(waiting, key=lambda found: found[0]):
            held = [any(branch is other for other in self.branches) for branch in (low, high)]
            if all(held) and self.side[low.corner] == self.side[high.corner]:
                self.join(low, high)

    def join(self, low: Branch, high: Branch) -> None:
        self.branches = [branch for branch in self.branches if branch is not low and branch is not high]
        new = self.new_edge(low.vertex, high.vertex, Segment(low.label))
        region, other = self.side[low.corner], self.next_region
        self.next_region += 1
        boundary = self.regions[region]
        turn = boundary.index(low.corner)
        boundary = boundary[turn:] + boundary[:turn]
        cut = boundary.index(high.corner)
        self.regions[region] = [*boundary[:cut], back(new)]
        self.regions[other] = [*boundary[cut:], new]
        self.settle(region, other)
        self.part(low.corner, new)
        self.part(high.corner, back(new))

    def prune(self) -> None:
        """Take away what never joined: all branches, and the edges that lead to nothing."""
        self.branches = []
        loose = [vertex for vertex in self.points if len(self.leaving[vertex]) == 1]
        while loose:
            vertex = loose.pop()
            dart = self.leaving[vertex][0]
            region, other = self.side[dart], self.ends(dart)[1]
            self.regions[region] = [kept for kept in self.regions[region] if kept[0] != dart[0]]
            self.drop_edge(dart[0])
            self.drop_vertex(vertex)
            if len(self.leaving[other]) == 1:
                loose.append(other)


# --- Growth ----------------------------------------------------------------------------------------------------------


class Growth:
    def __init__(self, system: System, scale: float) -> None:
        self.system, self.scale = system, scale
        self.map = Map(system.axiom)
        self.drawings = {rule: draw(rule.successor, system.angle) for rule in system.rules}

    def choose(self, number: int, rules: Sequence[Rule]) -> Rule | None:
        """Choose the rule with most matching context, of equal ones the first."""
        edge = self.map.edges[number]
        best, most = None, -1
        for rule in rules:
            known = 0
            for wanted, vertex in ((rule.before, edge.start), (rule.after, edge.end)):
                near = [self.map.edges[other].label for other, _ in self.map.leaving[vertex] if other != number]
                known += 0 if wanted is None else 1 if wanted in near else -9
            if known > most:
                best, most = rule, known
        return best

    def step(self) -> None:
        m = self.map
        count = len(m.points)
        centre = tuple(sum(point[axis] for point in m.points.values()) / count for axis in range(3))
        m.points = {
            vertex: tuple(x + (self.scale - 1) * (x - c) for x, c in zip(point, centre, strict=True))  # type: ignore[misc]
            for vertex, point in m.points.items()
        }
        present = sorted(m.edges)
        labels = list(dict.fromkeys(rule.label for rule in self.system.rules))
        made: set[int] = set()
        if self.system.sync:
            plans = [plan for label in labels for plan in self.plan(label, present)]
            self.apply(plans)
            m.join_all(self.system.branch_angle)
        else:
            for label in labels:
                plans = self.plan(label, [number for number in sorted(m.edges) if number not in made])
                made.update(self.apply(plans))
                m.join_all(self.system.branch_angle)
        m.prune()

    def plan(self, label: int, numbers: Sequence[int]) -> list[tuple[int, Drawing, Frame]]:
        rules = [rule for rule in self.system.rules if rule.label == label]
        plans = []
        for number in numbers:
            rule = self.choose(number, rules) if self.map.edges[number].label == label else None
            if rule is not None:
                plans.append((number, self.drawings[rule], self.map.frame(number)))
        return plans

    def apply(self, plans: Sequence[tuple[int, Drawing, Frame]]) -> list[int]:
        """Rewrite all planned edges, then place their brackets; give the edges that rewriting made."""
        first = self.map.next_edge
        bracketed = [drawn for plan in plans for drawn in self.map.rewrite(*plan)]
        self.map.place(bracketed)
        return [number for number, _, _ in plans] + list(range(first, self.map.next_edge))


def reference_maps(system: System, steps: int, scale: float) -> Iterator[Map]:
    """Give the map after each step, the seed first; it is one map that changes as the next is asked for."""
    growth = Growth(system, scale)
    yield growth.map
    for _ in range(steps):
        growth.step()
        yield growth.map


def reference_counts(system: System, steps: int, scale: float = 1.5) -> list[tuple[int, int, int]]:
    """Count vertices, edges and regions after each step, the seed first."""
    return [m.counts() for m in reference_maps(system, steps, scale)]
