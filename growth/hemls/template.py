"""Successors drawn once, in the frame of the edge that they replace.

The turtle's path depends on the rule alone, so each rule is drawn a single time in a local frame whose x axis is
the edge (start at 0, end at 1), y its left and z its up. Rewriting an edge then is an affine map of this drawing,
which :mod:`growth.hemls._paths` applies to thousands of edges at once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from growth.hemls.rules import Rule, Segment, Symbol, System

Vector = NDArray[np.float64]
KEEP = -1
"""In place of a segment's label: the edge keeps the one it has."""
COINCIDENT = 1e-9
"""Path ends nearer than this, in segment lengths, coincide: the path divides the edge evenly."""


@dataclass(frozen=True, slots=True)
class Template:
    """One successor, drawn.

    Attributes
    ----------
    nodes
        (k, 3) float64. Row 0 is the edge's start, row m its end, between them the path's inner nodes, after them the
        nodes of bracketed chains.
    segments
        The m drawn segments of the path as (label, reversed), from node i to node i + 1.
    chains
        Bracketed segments that become edges, as (from node, to node, label, reversed).
    branches
        (node, label) of each branch.
    headings
        (b, 3) float64 unit vectors, one for each branch.
    """

    nodes: Vector
    segments: tuple[tuple[int, bool], ...]
    chains: tuple[tuple[int, int, int, bool], ...]
    branches: tuple[tuple[int, int], ...]
    headings: Vector


@dataclass(slots=True)
class _Turtle:
    """Heading, left and up, as the columns of a rotation, and the node it stands on."""

    node: int
    frame: Vector

    def turned(self, symbol: str, angle: float) -> _Turtle:
        r"""Turn by ``angle`` radians: + left, - right, & down, ^ up, / rolls left, \ rolls right."""
        cos, sin = math.cos(angle), math.sin(angle)
        heading, left, up = self.frame.T
        if symbol == "+":
            columns = (heading * cos + left * sin, left * cos - heading * sin, up)
        elif symbol == "-":
            columns = (heading * cos - left * sin, left * cos + heading * sin, up)
        elif symbol == "&":
            columns = (heading * cos - up * sin, left, up * cos + heading * sin)
        elif symbol == "^":
            columns = (heading * cos + up * sin, left, up * cos - heading * sin)
        elif symbol == "/":
            columns = (heading, left * cos - up * sin, up * cos + left * sin)
        else:
            columns = (heading, left * cos + up * sin, up * cos - left * sin)
        return _Turtle(self.node, np.column_stack(columns))


@dataclass(slots=True)
class _Drawing:
    """What the turtle has drawn so far, in segment lengths, unfitted."""

    points: list[Vector] = field(default_factory=lambda: [np.zeros(3)])
    path: list[int] = field(default_factory=lambda: [0])
    segments: list[tuple[int, bool]] = field(default_factory=list)
    chains: list[tuple[int, int, int, bool]] = field(default_factory=list)
    branches: list[tuple[int, int]] = field(default_factory=list)
    headings: list[Vector] = field(default_factory=list)

    def step(self, turtle: _Turtle) -> int:
        """Add the point one segment ahead and give its number."""
        self.points.append(self.points[turtle.node] + turtle.frame[:, 0])
        return len(self.points) - 1


def draw(rule: Rule, angle: float) -> Template:
    """Draw a rule's successor and fit it to the edge.

    Parameters
    ----------
    rule
        The rule.
    angle
        Turn angle in degrees.

    Returns
    -------
    Template
        A successor that draws nothing outside its brackets keeps the edge whole. A path whose ends coincide divides
        the edge evenly and leaves headings as the turtle had them.
    """
    drawing = _Drawing()
    _walk(drawing, rule.successor, _Turtle(0, np.eye(3)), math.radians(angle), inside=False)
    return _fitted(drawing)


def draw_all(system: System) -> list[Template]:
    """Draw the successor of every rule of a system, in their order."""
    return [draw(rule, system.angle) for rule in system.rules]


def _walk(drawing: _Drawing, symbols: Sequence[Symbol], turtle: _Turtle, angle: float, inside: bool) -> None:
    """Follow the symbols of one bracket level; the last segment inside a bracket is its branch.

    One that an inner bracket goes on from is an edge, as that bracket needs a vertex to start from.
    """
    last = max((i for i, symbol in enumerate(symbols) if isinstance(symbol, Segment)), default=-1)
    index = 0
    while index < len(symbols):
        symbol = symbols[index]
        if isinstance(symbol, Segment):
            if inside and index == last:
                drawing.branches.append((turtle.node, symbol.label))
                drawing.headings.append(turtle.frame[:, 0])
            else:
                turtle = _Turtle(_segment(drawing, turtle, symbol, inside), turtle.frame)
        elif symbol == "[":
            end = _closing(symbols, index)
            _walk(drawing, symbols[index + 1 : end], turtle, angle, inside=True)
            index = end
        else:
            turtle = turtle.turned(symbol, angle)
        index += 1


def _segment(drawing: _Drawing, turtle: _Turtle, segment: Segment, inside: bool) -> int:
    """Draw a segment that becomes an edge and give the node at its end."""
    node = drawing.step(turtle)
    if inside:
        drawing.chains.append((turtle.node, node, segment.label, segment.reversed))
    else:
        drawing.segments.append((segment.label, segment.reversed))
        drawing.path.append(node)
    return node


def _closing(symbols: Sequence[Symbol], opening: int) -> int:
    depth = 0
    for index in range(opening, len(symbols)):
        depth += {"[": 1, "]": -1}.get(str(symbols[index]), 0)
        if depth == 0:
            return index
    raise AssertionError("brackets balance in every parsed rule")


def _fitted(drawing: _Drawing) -> Template:
    """Apply the similarity that takes the path's ends to 0 and 1 on the x axis, and order the nodes."""
    points = np.array(drawing.points)
    path = drawing.path
    end = points[path[-1]]
    span = float(np.linalg.norm(end))
    turn, size = np.eye(3), 1.0
    if span > COINCIDENT:
        turn, size = _shortest_arc(end / span), 1.0 / span
    nodes = (points @ turn.T) * size
    if span <= COINCIDENT:
        nodes = _even(drawing, points)
    segments = tuple(drawing.segments)
    if not segments:
        segments, path = ((KEEP, False),), [0, len(points)]
        nodes = np.vstack([nodes, [1.0, 0.0, 0.0]])
    on_path = set(path)
    order = path + [node for node in range(len(nodes)) if node not in on_path]
    place = {node: index for index, node in enumerate(order)}
    nodes = nodes[order]
    nodes[0], nodes[len(path) - 1] = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    chains = tuple((place[a], place[b], label, flipped) for a, b, label, flipped in drawing.chains)
    branches = tuple((place[node], label) for node, label in drawing.branches)
    headings = np.array(drawing.headings).reshape(-1, 3) @ turn.T
    return Template(nodes, segments, chains, branches, headings)


def _even(drawing: _Drawing, points: Vector) -> Vector:
    """Put the path's nodes at even distances on the edge; chains keep their shape, at the size of a part."""
    parts = max(len(drawing.segments), 1)
    nodes = np.zeros_like(points)
    for index, node in enumerate(drawing.path):
        nodes[node, 0] = index / parts
    for start, end, _, _ in drawing.chains:
        nodes[end] = nodes[start] + (points[end] - points[start]) / parts
    return nodes


def _shortest_arc(direction: Vector) -> Vector:
    """Give the rotation of least angle that takes a unit vector to the x axis; half a turn goes about up (z)."""
    cos, y, z = (float(x) for x in direction)
    if cos < 0 and math.hypot(y, z) < COINCIDENT:
        return np.diag([-1.0, -1.0, 1.0])
    share = 1 / (1 + cos) if cos > 0 else (1 - cos) / (y * y + z * z)
    return np.array([[cos, y, z], [-y, 1 - y * y * share, -y * z * share], [-z, -y * z * share, 1 - z * z * share]])
