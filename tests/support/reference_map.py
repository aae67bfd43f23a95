"""The map of the reference for HEMLS growth.

A region is a cyclic list of darts (an edge and which way it is walked, the region on its left), and a branch is held
by a corner of its region, which is named by the dart that leaves the corner.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from math import atan2, cos, degrees, hypot, pi, sin

from reference_turtle import TINY, Drawing, Frame, Vector, angle_between, cross, dot, placed, plus, times, unit

from growth.hemls.rules import Segment

Dart = tuple[int, bool]
OUTSIDE = 0
ALONG = degrees(1e-9)
"""Directions nearer to each other than this are one."""
TIE = 1e-6
"""Degrees under which angles are equal."""


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
        rows = [[point[axis] for point in self.points.values()] for axis in range(3)]
        return max(max(row) - min(row) for row in rows)

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
        waiting = []
        for one, two in combinations(enumerate(self.branches), 2):
            (first, low), (second, high) = sorted((one, two), key=lambda numbered: numbered[1].vertex)
            if low.label != high.label or self.side[low.corner] != self.side[high.corner]:
                continue
            across = plus(self.points[high.vertex], self.points[low.vertex], -1)
            distance = hypot(*across)
            if distance <= least:
                continue
            angles = angle_between(low.heading, across), angle_between(high.heading, times(across, -1))
            if max(angles) < branch_angle - TIE:
                # The specification stops at the ids; pairs with the same ends go by label, then as they were drawn.
                ids = low.vertex, high.vertex, low.label, first, second
                waiting.append((round(sum(angles), 6), round(distance / least), ids, low, high))
        for _, _, _, low, high in sorted(waiting, key=lambda found: found[:3]):
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
