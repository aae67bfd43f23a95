"""Where cells may be placed: outlines, storeys, solids; and bare cells that grow there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from genome.errors import InputError
from genome.lsystem import LSystem, parse_word
from genome.settings import validated
from growth.blocks import BlockGrowth, Body, CellGrowth, grow, grow_cells
from growth.blocks.lattice import CUBIC, ISOSPATIAL, SQUARE
from growth.blocks.site import OutlineSettings, site_of
from growth.environment import Environment, environment_from
from growth.protocol import Failure

ELL = np.array([(0, 0), (4, 0), (4, 2), (2, 2), (2, 4), (0, 4)], dtype=np.float64)


def grid(low: int, high: int) -> np.ndarray:
    side = np.arange(low, high + 1)
    return np.stack(np.meshgrid(side, side, side, indexing="ij"), axis=-1).reshape(-1, 3)


def system(word: str) -> LSystem:
    return LSystem(parse_word(word), (), 0, 0)


def outlined(outline, floors=None, level=0):
    return site_of(validated(OutlineSettings, {"outline": outline, "floors": floors}, "x"), level, Environment.empty())


def test_storeys_begin_at_the_level_of_the_start() -> None:
    site = outlined([[0, 0], [2, 0], [2, 2], [0, 2]], floors=3, level=4)
    cells = grid(0, 8)
    held = {tuple(cell) for cell in cells[site.holds(cells)].tolist()}
    assert held == {(x, y, z) for x in range(3) for y in range(3) for z in (4, 5, 6)}
    assert site_of(OutlineSettings(floors=1), 2, Environment.empty()).holds(cells).sum() == 81


def test_solids_take_the_cells_whose_centre_lies_in_them() -> None:
    box = {"shape": "box", "at": [0, 0, 0], "size": [3, 3, 3]}
    cells = grid(-3, 3)
    cube = (np.abs(cells) <= 1).all(axis=1)
    for solid, expected in (("inside", ~cube), ("outside", cube)):
        environment = environment_from({"boundaries": [{**box, "solid": solid}]}, "x", Path())
        assert site_of(OutlineSettings(), 0, environment).holds(cells).tolist() == expected.tolist()
    soft = environment_from({"boundaries": [{**box, "soft": True}]}, "x", Path())
    assert site_of(OutlineSettings(), 0, soft).holds(cells).all(), "growth may pass it"


def test_an_outline_may_go_straight_on_and_bend_inwards() -> None:
    for outline in ([[0, 0], [1, 0], [2, 0], [2, 2], [0, 2]], ELL.tolist(), ELL[::-1].tolist()):
        assert len(outlined(outline).outline.points) == len(outline)


def test_how_much_an_outline_holds_hangs_on_the_lattice() -> None:
    small = [[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8]]
    assert outlined(small).capacity(CUBIC) == outlined(small, floors=3).capacity(CUBIC) == 0
    one = [[0.5, 0], [1.5, -0.5], [1.5, 0.5]]
    assert outlined(one).capacity(CUBIC) is None
    assert outlined(one, floors=1).capacity(ISOSPATIAL) == 0
    assert outlined(one, floors=1, level=1).capacity(ISOSPATIAL) == 1
    assert outlined(one, floors=2).capacity(ISOSPATIAL) == 1
    assert outlined(None).capacity(CUBIC) is None


@pytest.mark.parametrize(("lattice", "floors", "level"), [(CUBIC, 3, -1), (ISOSPATIAL, 3, 1), (ISOSPATIAL, 2, 0)])
def test_a_site_holds_as_many_cells_as_its_capacity_says(lattice, floors: int, level: int) -> None:
    site = outlined(ELL.tolist(), floors, level)
    cells = grid(-2, 6)
    if lattice.parity:
        cells = cells[cells.sum(axis=1) % 2 == 0]
    assert site.capacity(lattice) == site.holds(cells).sum()


def test_of_a_plane_one_storey_counts() -> None:
    assert outlined(ELL.tolist(), 5).capacity(SQUARE) == outlined(ELL.tolist(), 1).capacity(CUBIC)


def test_bare_cells_are_those_of_a_body_without_its_ground() -> None:
    word = "F[+F|F^F]&FF[-FF]$F"
    for lattice in ("cubic", "isospatial"):
        body = grow(system(word), BlockGrowth(lattice=lattice))
        assert isinstance(body, Body)
        cells = grow_cells(system(word), CellGrowth(lattice=lattice, start=(4, -2, 6)))
        assert isinstance(cells, np.ndarray)
        assert (cells - [4, -2, 6]).tolist() == body.internal.tolist()
        assert cells.dtype == np.int64


def test_in_the_plane_all_cells_lie_in_it() -> None:
    cells = grow_cells(system("F+F++FF&F^F$FF"), CellGrowth(lattice="square", start=(3, 3, 0)))
    assert isinstance(cells, np.ndarray)
    assert len(cells) > 4
    assert not cells[:, 2].any()
    assert cells[0].tolist() == [3, 3, 0]
    with pytest.raises(InputError, match=r"which lie in the plane z = 0, got \[0, 0, 1\]"):
        validated(CellGrowth, {"lattice": "square", "start": [0, 0, 1]}, "x")


def test_cells_outside_the_site_are_left_out_and_the_turtle_goes_on() -> None:
    growth = CellGrowth()
    gap = grow_cells(system("FFFF"), growth, free=lambda cells: cells[:, 2] != 2)
    assert isinstance(gap, np.ndarray)
    assert gap[:, 2].tolist() == [0, 1, 3, 4]
    none = grow_cells(system("FFFF"), growth, free=lambda cells: cells[:, 2] > 9)
    assert none == Failure("empty", "none of 5 cells lies where cells may be placed")
    much = grow_cells(system("FFFF"), CellGrowth(max_blocks=4))
    assert isinstance(much, Failure)
    assert much.reason == "budget"


def test_cells_that_are_left_out_do_not_count() -> None:
    low = grow_cells(system("F" * 50), CellGrowth(max_blocks=3), free=lambda cells: cells[:, 2] < 3)
    assert isinstance(low, np.ndarray)
    assert low[:, 2].tolist() == [0, 1, 2]
    over = grow_cells(system("F" * 50), CellGrowth(max_blocks=2), free=lambda cells: cells[:, 2] < 3)
    assert isinstance(over, Failure)
    assert over.reason == "budget"
