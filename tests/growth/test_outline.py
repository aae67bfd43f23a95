"""Outlines: which points lie in them, and which lists of points are none."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from genome.errors import InputError
from growth.outline import Outline, as_outline

ELL = np.array([(0, 0), (4, 0), (4, 2), (2, 2), (2, 4), (0, 4)], dtype=np.float64)


def grid(low: int, high: int) -> np.ndarray:
    side = np.arange(low, high + 1)
    return np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2).astype(np.float64)


def of(points: np.ndarray) -> Outline:
    return Outline(tuple((float(x), float(y)) for x, y in points))


@pytest.mark.parametrize("turned", [ELL, ELL[::-1], np.roll(ELL, 2, axis=0)])
def test_an_outline_holds_the_centres_in_it_and_on_its_edge(turned) -> None:
    points = grid(-1, 5)
    expected = [(0 <= x <= 4 and 0 <= y <= 2) or (0 <= x <= 2 and 0 <= y <= 4) for x, y in points]
    assert of(turned).holds(points).tolist() == expected
    halves = points + 0.5
    expected = [(0 < x < 4 and 0 < y < 2) or (0 < x < 2 and 0 < y < 4) for x, y in halves]
    assert of(turned).holds(halves).tolist() == expected


@given(st.lists(st.tuples(st.integers(-6, 6), st.integers(-6, 6)), min_size=3, max_size=6, unique=True))
def test_of_a_convex_outline_those_on_the_inner_side_of_all_edges_are_in_it(corners) -> None:
    centre = np.mean(corners, axis=0)
    around = np.array(sorted(corners, key=lambda c: np.arctan2(c[1] - centre[1], c[0] - centre[0])), dtype=np.float64)
    after = np.roll(around, -1, axis=0) - around
    turns = after[:, 0] * np.roll(after, -1, axis=0)[:, 1] - after[:, 1] * np.roll(after, -1, axis=0)[:, 0]
    if not (turns > 0).all():
        return
    points = grid(-7, 7)
    side = after[:, 0] * (points[:, None, 1] - around[:, 1]) - after[:, 1] * (points[:, None, 0] - around[:, 0])
    assert of(around).holds(points).tolist() == (side >= 0).all(axis=1).tolist()


@given(points=st.lists(st.tuples(st.integers(-3, 3), st.integers(-3, 3)), min_size=3, max_size=7))
def test_outlines_taken_are_simple_and_hold_what_their_area_says(points: list[tuple[int, int]]) -> None:
    try:
        outline = as_outline([list(one) for one in points])
    except InputError:
        return
    assert isinstance(outline, Outline)
    # Pick's theorem holds for simple polygons alone.
    grid = np.array([(x, y) for x in range(-4, 5) for y in range(-4, 5)], dtype=float)
    held = int(outline.holds(grid).sum())
    ring = [*points[1:], points[0]]
    rim = sum(math.gcd(bx - ax, by - ay) for (ax, ay), (bx, by) in zip(points, ring, strict=True))
    assert outline.area == held - rim + rim / 2 - 1


@pytest.mark.parametrize(
    ("outline", "message"),
    [
        ([[0, 0], [2, 2], [2, 0], [0, 2]], "side 1 ([0, 0] to [2, 2]) meets side 3 ([2, 0] to [0, 2])"),
        ([[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]], "side 1 ([0, 0] to [4, 0]) meets side 3"),
        ([[0, 0], [4, 0], [2, 0]], "meets side 2"),
        ([[0, 0], [1, 0], [2, 0]], "meet"),
        ([[0, 0], [4, 0], [4, 0], [0, 4]], "[4.0, 0.0] twice in a row"),
        ([[0, 0], [4, 0], [4, 4], [0, 0]], "[0.0, 0.0] twice in a row"),
        ([[0, 0], [4, 0]], "an outline of 3 points at least"),
        ([[0, 0], [4, 0], [4, None]], "a point of two numbers"),
        ([[0, 0], [4, 0], [4, True]], "a point of two numbers"),
        ([[0, 0], [4, 0], [4, 1, 2]], "a point of two numbers"),
        ("square", "an outline of 3 points at least"),
    ],
)
def test_an_outline_that_is_none_is_refused(outline, message) -> None:
    with pytest.raises(InputError) as caught:
        as_outline(outline)
    assert message in str(caught.value)
