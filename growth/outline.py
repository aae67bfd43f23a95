"""Outlines of sites: simple polygons, and which points lie in them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any, Final, final

import numpy as np
from numpy.typing import NDArray
from pydantic import GetCoreSchemaHandler
from pydantic_core import core_schema

from genome.errors import InputError
from genome.settings import describe

Floats = NDArray[np.float64]
Point = tuple[float, float]

FARTHEST: Final = 10_000.0
"""Of a coordinate."""
MOST_POINTS: Final = 1000
CLOSE: Final = 1e-9


@final
@dataclass(frozen=True, slots=True)
class Outline:
    """A simple polygon.

    Attributes
    ----------
    points
        Its corners in order, in either sense; the last is joined to the first.
    """

    points: tuple[Point, ...]

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:  # noqa: ANN401
        """Tell pydantic how it is written out: as a list of points."""
        del source, handler
        return core_schema.is_instance_schema(
            cls,
            serialization=core_schema.plain_serializer_function_ser_schema(lambda one: [list(p) for p in one.points]),
        )

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: object, handler: object) -> dict[str, Any]:
        """Describe it for editors."""
        del schema, handler
        return {"type": "array", "minItems": 3, "items": {"type": "array", "items": {"type": "number"}}}

    @property
    def area(self) -> float:
        """What it encloses."""
        return abs(_twice_area(self.points)) / 2

    def holds(self, points: Floats) -> NDArray[np.bool_]:
        """Tell which of points (n, 2) lie in it or on it, to 1e-9."""
        inside = np.zeros(len(points), dtype=bool)
        on = np.zeros(len(points), dtype=bool)
        x, y = points[:, 0], points[:, 1]
        for (ax, ay), (bx, by) in zip(self.points, (*self.points[1:], self.points[0]), strict=True):
            crosses = (ay > y) != (by > y)
            if ay != by:
                inside ^= crosses & (x < ax + (y - ay) * (bx - ax) / (by - ay))
            length = math.hypot(bx - ax, by - ay)
            away = np.abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / length
            along = ((bx - ax) * (x - ax) + (by - ay) * (y - ay)) / length
            on |= (away <= CLOSE) & (along >= -CLOSE) & (along <= length + CLOSE)
        return inside | on


def as_outline(value: object) -> Outline | None:
    """Take a list of points as an outline.

    Raises
    ------
    InputError
        For fewer than three points, points that are no two finite numbers, and a polygon that crosses or touches itself
        or encloses nothing.
    """
    if value is None or isinstance(value, Outline):
        return value
    if not isinstance(value, (list, tuple)) or not 3 <= len(value) <= MOST_POINTS:
        raise InputError("", "an outline of 3 points at least: [[x, y], ...]", describe(value))
    points = tuple(_point(one) for one in value)
    _check_simple(points)
    return Outline(points)


def _point(value: object) -> Point:
    match value:
        case [int() | float() as x, int() | float() as y] if not isinstance(x, bool) and not isinstance(y, bool):
            if abs(x) <= FARTHEST and abs(y) <= FARTHEST:
                return float(x), float(y)
            raise InputError("", f"coordinates up to {FARTHEST:g}", describe(value))
    raise InputError("", "a point of two numbers: [x, y]", describe(value))


def _check_simple(points: Sequence[Point]) -> None:
    sides = list(zip(points, (*points[1:], points[0]), strict=True))
    for first, second in sides:
        if first == second:
            raise InputError("", "corners that differ from the next", f"{list(first)} twice in a row", "remove one")
    for (i, one), (j, other) in combinations(enumerate(sides), 2):
        neighbours = j - i == 1 or j - i == len(sides) - 1
        if _meet(*one, *other, neighbours=neighbours):
            got = f"side {i + 1} ({_said(one)}) meets side {j + 1} ({_said(other)})"
            raise InputError("", "an outline that does not cross or touch itself", got, "list its corners in order")
    if abs(_twice_area(points)) <= CLOSE:
        raise InputError("", "an outline that encloses something", "an area of 0")


def _said(side: tuple[Point, Point]) -> str:
    (ax, ay), (bx, by) = side
    return f"[{ax:g}, {ay:g}] to [{bx:g}, {by:g}]"


def _meet(a: Point, b: Point, c: Point, d: Point, *, neighbours: bool) -> bool:
    """Tell whether two sides meet; neighbours may at the corner that they share, and must not run back."""
    if neighbours:
        shared, one, other = (b, a, d) if b == c else (a, b, c)
        return _turn(one, shared, other) == 0 and _dot(one, shared, other) > 0
    turns = [np.sign(_turn(*three)) for three in ((a, b, c), (a, b, d), (c, d, a), (c, d, b))]
    if turns[0] * turns[1] < 0 and turns[2] * turns[3] < 0:
        return True
    return any(
        turn == 0 and _between(*line)
        for turn, line in zip(turns, ((a, b, c), (a, b, d), (c, d, a), (c, d, b)), strict=True)
    )


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _dot(one: Point, at: Point, other: Point) -> float:
    return (one[0] - at[0]) * (other[0] - at[0]) + (one[1] - at[1]) * (other[1] - at[1])


def _between(a: Point, b: Point, c: Point) -> bool:
    return min(a[0], b[0]) <= c[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= c[1] <= max(a[1], b[1])


def _twice_area(points: Sequence[Point]) -> float:
    return math.fsum(ax * by - bx * ay for (ax, ay), (bx, by) in zip(points, (*points[1:], points[0]), strict=True))
