from __future__ import annotations

import numpy as np
import pytest

from evaluators.rooms import ROOM_CRITERIA, corners, perimeter, perimeter_to_area, proportions, score
from growth.polyforms import CUBE, HEXAGON, SQUARE, TRIANGLE, Polyform, Tiling


def form(tiling: Tiling, *cells: tuple[int, int, int]) -> Polyform:
    return Polyform(tiling, np.array(cells, dtype=np.int64))


def block(tiling: Tiling, *sides: int) -> Polyform:
    return form(tiling, *((x, y, z) for x in range(sides[0]) for y in range(sides[1]) for z in range(sides[2])))


@pytest.mark.parametrize(
    ("room", "rim", "angles"),
    [
        (block(SQUARE, 1, 1, 1), 4, 4),
        (block(SQUARE, 6, 4, 1), 20, 4),
        (form(SQUARE, (0, 0, 0), (1, 0, 0), (1, 1, 0)), 8, 6),
        (form(SQUARE, (0, 0, 0), (1, 0, 0), (2, 0, 0), (1, 1, 0)), 10, 8),
        (form(SQUARE, (-5, 9, 0)), 4, 4),
        (form(TRIANGLE, (0, 0, 0)), 3, 3),
        (form(TRIANGLE, (0, 0, 0), (0, 0, 1)), 4, 4),  # a rhombus
        (form(TRIANGLE, (0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0)), 6, 3),  # a triangle twice as large
        (form(HEXAGON, (0, 0, 0)), 6, 6),
        (form(HEXAGON, (0, 0, 0), (1, 0, 0)), 10, 10),
        (block(CUBE, 1, 1, 1), 6, 8),
        (block(CUBE, 2, 3, 4), 52, 8),
        (form(CUBE, (0, 0, 0), (1, 0, 0), (1, 1, 0)), 14, 12),
    ],
)
def test_rims_and_corners_of_known_forms(room: Polyform, rim: int, angles: int) -> None:
    assert (perimeter(room), corners(room)) == (rim, angles)


def test_rims_are_over_areas_in_units_of_an_edge() -> None:
    assert perimeter_to_area(block(SQUARE, 6, 4, 1)) == pytest.approx(20 / 24)
    assert perimeter_to_area(form(TRIANGLE, (0, 0, 0))) == pytest.approx(3 / (3**0.5 / 4))
    assert perimeter_to_area(form(HEXAGON, (0, 0, 0))) == pytest.approx(6 / (1.5 * 3**0.5))
    assert perimeter_to_area(block(CUBE, 2, 2, 2)) == pytest.approx(3.0)


def test_proportions_are_those_of_the_box_around() -> None:
    assert proportions(block(SQUARE, 6, 4, 1)) == pytest.approx(4 / 6)
    assert proportions(block(SQUARE, 2, 8, 1)) == pytest.approx(1 / 4)
    assert proportions(form(HEXAGON, (0, 0, 0))) == pytest.approx(3**0.5 / 2)


def test_all_criteria_are_scored() -> None:
    found = score(block(SQUARE, 2, 2, 1), ROOM_CRITERIA)
    assert found == {"corners": 4.0, "perimeter": 8.0, "perimeter_to_area": 2.0, "proportions": 1.0}
