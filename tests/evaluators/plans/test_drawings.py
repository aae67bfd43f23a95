"""Drawings against shapely: rooms simple, disjoint, connected, areas exact; walls without gaps; openings in walls."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import shapely
from drawn_houses import PLANE, SIZES, house

from evaluators.plans import Layout
from evaluators.plans.drawings import Drawing, drawing
from evaluators.plans.drawings.doors import faces, sweep
from evaluators.plans.drawings.inside import inside
from evaluators.plans.drawings.poche import pieces, poche
from evaluators.plans.layout import COMPASS
from genome.errors import InputError

UNIT = 1.25
CASES = [(tiling, seed) for tiling in PLANE for seed in range(3)]
HOUSES = pytest.mark.parametrize(("tiling", "seed"), CASES)


def drawn(tiling: str, seed: int, **brief) -> tuple[Layout, Drawing]:
    layout = house(tiling, seed, **{"unit": UNIT, **brief})
    return layout, drawing(layout, "house")


def cells_of(layout: Layout) -> list[shapely.Polygon]:
    """Give each room as shapely's union of its cells, in metres."""
    tiling, plan = layout.plan.tiling, layout.plan
    x, y = layout.place.shift
    corners = tiling.vertices(plan.cells + np.array([x, y, 0])) @ tiling.positions.T * layout.brief.unit
    each = [shapely.Polygon(ring[:, :2]).convex_hull for ring in corners]
    rooms = range(plan.count)
    return [
        shapely.union_all([cell.buffer(1e-9) for cell, own in zip(each, plan.rooms, strict=True) if own == room])
        for room in rooms
    ]


@HOUSES
def test_rooms_are_the_unions_of_their_cells(tiling: str, seed: int) -> None:
    layout, found = drawn(tiling, seed)
    polygons = [shapely.Polygon(room.outline) for room in found.rooms]
    for room, polygon, cells in zip(found.rooms, polygons, cells_of(layout), strict=True):
        assert polygon.is_valid
        assert polygon.exterior.is_ccw
        assert polygon.symmetric_difference(cells).area < 1e-6
        assert room.area == pytest.approx(polygon.area, abs=1e-9)
    for one, other in itertools.combinations(polygons, 2):
        assert one.intersection(other).area < 1e-9
    whole = shapely.union_all([polygon.buffer(1e-9) for polygon in polygons])
    assert whole.geom_type == "Polygon"
    assert whole.area == pytest.approx(found.area, abs=1e-6)
    assert whole.symmetric_difference(shapely.Polygon(found.outline)).area < 1e-6


@HOUSES
def test_walls_fill_what_lies_between_floors_without_gaps_or_overlaps(tiling: str, seed: int) -> None:
    layout, found = drawn(tiling, seed)
    bodies = [shapely.Polygon(wall.body) for wall in found.walls]
    floors = [shapely.Polygon(room.floor) for room in found.rooms]
    assert all(one.is_valid and one.exterior.is_ccw for one in [*bodies, *floors])
    hull = shapely.Polygon(found.hull)
    total = sum(one.area for one in [*bodies, *floors])
    assert total == pytest.approx(hull.area, abs=1e-9)
    assert shapely.union_all([*bodies, *floors]).symmetric_difference(hull).area < 1e-9
    edges = {tuple(sorted(wall.rooms)): 0.0 for wall in found.walls}
    for wall in found.walls:
        edges[tuple(sorted(wall.rooms))] += wall.length / UNIT
    count = layout.plan.count
    outer = {(-1, room): float(layout.outer[room].sum()) for room in range(count)}
    inner = {(a, b): float(layout.shared[a, b]) for a in range(count) for b in range(a + 1, count)}
    assert edges == pytest.approx({pair: length for pair, length in {**outer, **inner}.items() if length})


@HOUSES
def test_pieces_and_rings_are_the_walls_less_the_openings(tiling: str, seed: int) -> None:
    _, found = drawn(tiling, seed)
    walls = shapely.union_all([shapely.Polygon(wall.body) for wall in found.walls])
    cut = [shapely.Polygon(one.ring) for one in pieces(found) if one.opening is not None]
    solid = shapely.union_all([shapely.Polygon(one.ring) for one in pieces(found) if one.opening is None])
    assert walls.difference(shapely.union_all(cut)).symmetric_difference(solid).area < 1e-9
    rings = poche(found, ("door", "window"))
    signed = sum(shapely.Polygon(ring).area * (1 if shapely.LinearRing(ring).is_ccw else -1) for ring in rings)
    assert signed == pytest.approx(solid.area, abs=1e-4)
    assert sum(shapely.LinearRing(ring).length for ring in rings) == pytest.approx(solid.length, abs=1e-4)
    assert len(rings) == sum(1 + len(part.interiors) for part in shapely.get_parts(solid))
    areas = sum(one.area for one in cut)
    assert areas == pytest.approx(sum(one.width * found.walls[one.wall].thickness for one in found.openings))


@HOUSES
def test_doors_stand_where_adjacencies_are_met_and_open_into_free_room(tiling: str, seed: int) -> None:
    layout, found = drawn(tiling, seed)
    front, *doors = found.doors
    assert front.front
    assert found.walls[front.wall].rooms == (list(SIZES).index("entrance"), -1)
    assert [set(found.walls[one.wall].rooms) for one in doors] == [{first, second} for first, second in layout.doors]
    for one in found.doors:
        wall = found.walls[one.wall]
        assert one.into in wall.rooms
        assert wall.clear[0] < one.start < one.start + one.width < wall.clear[1]
        leaf = found.leaf(one)
        assert math.dist(leaf.hinge, leaf.tip) == pytest.approx(one.width)
        assert math.dist(leaf.hinge, leaf.jamb) == pytest.approx(one.width)
        if tiling == "square":
            assert inside(sweep(wall, one), found.rooms[one.into].floor).all()
            assert one.width >= 0.7


@HOUSES
def test_windows_are_where_rooms_want_light_and_apart_from_doors(tiling: str, seed: int) -> None:
    _, found = drawn(tiling, seed)
    wanting = {list(SIZES).index(name) for name in ("living", "master_bedroom", "kitchen")}
    assert {one.into for one in found.windows} <= wanting
    outside = {wall.rooms[0] for wall in found.walls if wall.outer and wall.clear[1] - wall.clear[0] > UNIT / 2}
    assert {one.into for one in found.windows} >= wanting & outside
    for number, wall in enumerate(found.walls):
        own = found.of_wall(number)
        assert all(wall.outer for one in own if one.kind == "window")
        for one, other in itertools.pairwise(own):
            assert one.start + one.width < other.start


def test_where_nobody_asks_for_light_all_rooms_have_windows() -> None:
    rooms = {name: {"cells": size} for name, size in SIZES.items()}
    layout, found = drawn("square", 0, rooms=rooms)
    assert {one.into for one in found.windows} == {room for room in range(6) if layout.outer[room].any()}


@pytest.mark.parametrize("street", COMPASS)
def test_the_front_door_faces_the_street(street: str) -> None:
    _, found = drawn("square", 1, site={"street": street})
    front = found.doors[0]
    wall = found.walls[front.wall]
    entrance = [one for one in found.walls if one.outer and one.rooms[0] == wall.rooms[0]]
    assert faces(wall, COMPASS[street]) or not any(faces(one, COMPASS[street]) for one in entrance)


@HOUSES
def test_words_stand_in_their_rooms(tiling: str, seed: int) -> None:
    _, found = drawn(tiling, seed)
    for room in found.rooms:
        assert shapely.Polygon(room.floor).contains(shapely.Point(room.label.at))
        assert 0.04 <= room.label.size / UNIT <= 0.28


@HOUSES
def test_dimensions_measure_the_whole_and_its_stretches(tiling: str, seed: int) -> None:
    _, found = drawn(tiling, seed)
    low_x, low_y, high_x, high_y = shapely.Polygon(found.outline).bounds
    whole = {"south": high_x - low_x, "north": high_x - low_x, "east": high_y - low_y, "west": high_y - low_y}
    for side, length in whole.items():
        rows: dict[float, float] = {}
        for one in found.dimensions:
            if one.side == side:
                row = one.first[1 if side in ("south", "north") else 0]
                rows[row] = rows.get(row, 0.0) + one.length
        assert all(row == pytest.approx(length) for row in rows.values())
        assert rows or tiling != "square"
        assert len(rows) >= 1 or side in ("north", "east")


def test_a_drawing_lies_where_the_plan_lies_on_its_site() -> None:
    outline = [[100, 50], [140, 50], [140, 90], [100, 90]]
    layout, found = drawn("square", 2, site={"outline": outline})
    assert layout.place.inside == len(layout.plan.cells)
    site = shapely.Polygon(found.ground.outline)
    assert site.bounds == (125.0, 62.5, 175.0, 112.5)
    assert site.buffer(1e-9).contains(shapely.Polygon(found.outline))


def test_cubes_have_no_floor_plan() -> None:
    with pytest.raises(InputError, match=r"drawing: expected a plan on one floor, got one of cubes"):
        drawing(house("cube", 0), "cubes")
