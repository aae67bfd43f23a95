"""The turtle as plain Python: vectors as tuples, states in a list; nothing is shared with the kernel."""

from __future__ import annotations

import math
from typing import NamedTuple

from growth.timed import Word

Vector = tuple[float, float, float]


class Turtle(NamedTuple):
    """Place, heading, left, up and radius."""

    place: Vector
    heading: Vector
    left: Vector
    up: Vector
    radius: float


class Stop(NamedTuple):
    """Where something is drawn, with what, and who."""

    turtle: Turtle
    command: str
    module: int


START = Turtle((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), 0.1)


def mixed(a: Vector, b: Vector, angle: float) -> tuple[Vector, Vector]:
    """Turn a towards b, and b away from a."""
    c, s = math.cos(angle), math.sin(angle)
    (ax, ay, az), (bx, by, bz) = a, b
    return (c * ax + s * bx, c * ay + s * by, c * az + s * bz), (c * bx - s * ax, c * by - s * ay, c * bz - s * az)


def moved(place: Vector, heading: Vector, length: float) -> Vector:
    """Go ahead."""
    return tuple(x + length * y for x, y in zip(place, heading, strict=True))  # type: ignore[return-value]


def steered(turtle: Turtle, command: str, angle: float) -> Turtle:
    """Turn, pitch or roll."""
    if command in "-&\\":
        angle = -angle
    heading, left, up = turtle.heading, turtle.left, turtle.up
    if command in "+-":
        heading, left = mixed(heading, left, angle)
    elif command in "^&":
        heading, up = mixed(heading, up, angle)
    else:
        left, up = mixed(left, up, angle)
    return turtle._replace(heading=heading, left=left, up=up)


def levelled(turtle: Turtle) -> Turtle:
    """Make left level."""
    x, y = -turtle.heading[1], turtle.heading[0]
    if math.hypot(x, y) < 1e-12:
        return turtle
    left = (x / math.hypot(x, y), y / math.hypot(x, y), 0.0)
    (a, b, c), (d, e, _) = turtle.heading, left
    return turtle._replace(left=left, up=(-c * e, c * d, a * e - b * d))


def walk(word: Word, length: float = 1.0, angle: float = 22.5) -> tuple[list[Stop], list[Vector]]:
    """Give where F and sphere draw, and the tips."""
    unit = 1.0 if word.radians else math.pi / 180.0
    turtle, pile, stops, tips = START, [START][:0], [], []
    for at, code in enumerate(word.codes.tolist()):
        command = word.commands[code]
        given = word.values[word.starts[at] : word.starts[at + 1]].tolist()
        if command in ("f", "F"):
            run = given[0] if given else length
            if command == "F" and run != 0.0 and turtle.radius > 0.0:
                stops.append(Stop(turtle, command, at))
            turtle = turtle._replace(place=moved(turtle.place, turtle.heading, run))
        elif command in ("+", "-", "^", "&", "/", "\\"):
            turtle = steered(turtle, command, given[0] * unit if given else math.radians(angle))
        elif command == "|":
            turtle = steered(turtle, "+", math.pi)
        elif command == "$":
            turtle = levelled(turtle)
        elif command == "!":
            turtle = turtle._replace(radius=max(given[0], 0.0))
        elif command == "sphere":
            if given[0] != 0.0:
                stops.append(Stop(turtle, command, at))
        elif command == "[":
            pile.append(turtle)
        elif command == "]":
            tips.append(turtle.place)
            turtle = pile.pop()
    return stops, [*tips, turtle.place]
