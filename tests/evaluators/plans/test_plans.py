from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from evaluators.plans import PLAN_CRITERIA, Brief, Layout, laid_out, score
from evaluators.plans.layout import facing, ground
from genome.errors import InputError
from genome.settings import validated
from growth.outline import Outline
from growth.polyforms import CUBE, HEXAGON, SQUARE, TILINGS, TRIANGLE, Plan

LETTERS = "abcdefgh"


def drawn(picture: str) -> Plan:
    """Make a plan of a picture: a letter a room, the first row north."""
    rows = [row.strip() for row in picture.split()]
    cells = [(x, len(rows) - 1 - y, 0, letter) for y, row in enumerate(rows) for x, letter in enumerate(row)]
    ordered = sorted((one for one in cells if one[3] != "."), key=lambda one: one[3])
    rooms = [LETTERS.index(one[3]) for one in ordered]
    return Plan(SQUARE, np.array([one[:3] for one in ordered], dtype=np.int64), np.array(rooms))


def brief(plan: Plan, **more: Any) -> Brief:
    counts = np.bincount(plan.rooms).tolist()
    wishes = more.pop("wishes", {})
    rooms = {LETTERS[k]: {"cells": count, **wishes.get(LETTERS[k], {})} for k, count in enumerate(counts)}
    return validated(Brief, {"rooms": rooms, **more}, "house.yaml", ("brief",))


def judged(picture: str, **more: Any) -> Layout:
    plan = drawn(picture)
    return laid_out(plan, brief(plan, **more))


def scored(picture: str, **more: Any) -> dict[str, float]:
    found = score(judged(picture, **more), PLAN_CRITERIA)
    assert isinstance(found, dict)
    return found


ROW = "aabbccdd aabbccdd"


def test_walls_are_counted_between_rooms_and_to_each_side() -> None:
    layout = judged("aab aac")
    assert layout.shared.tolist() == [[0, 1, 1], [1, 0, 1], [1, 1, 0]]
    assert [layout.facing(0, side) for side in ("north", "east", "south", "west")] == [2, 0, 2, 2]
    assert [layout.facing(1, side) for side in ("north", "east", "south", "west")] == [1, 1, 0, 0]


def test_adjacency_sums_walls_crossed_by_weight() -> None:
    wanted = [["a", "b"], ["a", "d", 2], ["b", "c", 0.5]]
    found = scored(ROW, adjacencies=wanted)
    assert found["adjacency"] == 1 + 2 * 3 + 0.5
    assert found["met"] == pytest.approx(1.5 / 3.5)
    assert scored(ROW)["met"] == 1.0


def test_a_door_wants_its_width() -> None:
    wanted = [["a", "b"]]
    assert scored("aab. .abb", adjacencies=wanted, door=2)["met"] == 1.0
    assert scored("aab aa.", adjacencies=wanted, door=2)["met"] == 0.0
    assert judged("aab aa.", adjacencies=wanted, door=2).far.tolist() == [[0, 2], [2, 0]]


def test_doors_stand_where_adjacencies_are_met() -> None:
    assert judged(ROW, adjacencies=[["c", "d"], ["a", "d"], ["b", "a"]]).doors == ((2, 3), (1, 0))


def test_rooms_are_reached_through_doors_and_not_through_private_ones() -> None:
    wanted = [["a", "b"], ["b", "c"], ["c", "d"]]
    assert scored(ROW, adjacencies=wanted, entrance="a")["reachable"] == 1.0
    assert scored(ROW, adjacencies=wanted[:2], entrance="a")["reachable"] == 0.75
    assert scored(ROW, adjacencies=wanted[1:])["reachable"] == 0.75
    private = {"b": {"private": True}}
    found = scored(ROW, adjacencies=wanted, entrance="a", wishes=private)
    assert (found["reachable"], found["circulation"]) == (1.0, 0.5)
    ends = {"d": {"private": True}, "a": {"private": True}}
    assert scored(ROW, adjacencies=wanted, entrance="a", wishes=ends)["circulation"] == 1.0


def test_daylight_wants_an_outer_wall() -> None:
    inner = "aaa aba aaa"
    wishes = {"a": {"daylight": True}, "b": {"daylight": True}}
    assert scored(inner, wishes=wishes)["daylight"] == 0.5
    assert scored(inner, wishes={"a": {"daylight": True}})["daylight"] == 1.0


def test_sun_view_and_street_want_walls_that_face_them() -> None:
    wishes = {"a": {"facing": ["south"], "view": True}, "d": {"facing": ["west", "east"], "view": True}}
    found = scored(ROW, wishes=wishes, entrance="b", site={"street": "east", "view": "west"})
    assert (found["orientation"], found["view"], found["street"]) == (1.0, 0.5, 0.0)
    found = scored("aabb", wishes={"b": {"facing": ["west"]}}, entrance="b", site={"street": "east"})
    assert (found["orientation"], found["view"], found["street"]) == (0.0, 1.0, 1.0)


def test_a_plan_is_put_where_it_fits_its_site() -> None:
    room = [[10, 10], [12, 10], [12, 12], [10, 12]]
    layout = judged("aab aa.", site={"outline": [[10, 10], [14, 10], [14, 13], [10, 13]]})
    assert score(layout, PLAN_CRITERIA)["site"] == 1.0  # type: ignore[index]
    assert layout.place.shift == (10, 10)
    slim = judged("aab aac", site={"outline": [[10, 10], [11.99, 10], [11.99, 20], [10, 20]]})
    assert score(slim, PLAN_CRITERIA)["site"] == pytest.approx(2 / 6)  # type: ignore[index]
    # A slot narrower than a cell runs into the third one, whose corners all lie on the site.
    slot = [[0, 0], [4, 0], [4, 4], [2.6, 4], [2.5, 0.05], [2.4, 4], [0, 4]]
    assert score(judged("aaab", site={"outline": slot}), PLAN_CRITERIA)["site"] == pytest.approx(3 / 4)  # type: ignore[index]
    with pytest.raises(InputError, match="a site that holds the rooms' area of 6"):
        judged("aab aac", site={"outline": room})


def test_the_worst_room_gives_the_proportions() -> None:
    assert scored("aabb aabb")["proportions"] == 1.0
    assert scored("aab aab aab")["proportions"] == pytest.approx(1 / 3)


def test_a_plan_as_a_whole_has_a_rim_and_corners() -> None:
    found = scored("aab aa.")
    assert (found["perimeter"], found["perimeter_to_area"], found["corners"]) == (10.0, 2.0, 6.0)


def test_a_part_of_a_brief_keeps_what_is_among_its_rooms() -> None:
    whole = brief(drawn(ROW), adjacencies=[["a", "b"], ["b", "c"]], entrance="a", site={"street": "east"})
    part = whole.among(["c", "b"])
    assert (list(part.rooms), part.adjacencies, part.entrance) == (["c", "b"], [("b", "c", 1.0)], None)


@pytest.mark.parametrize(("side", "vectors"), [("north", "E"), ("east", "S"), ("south", "W"), ("west", "N")])
def test_edges_of_squares_face_one_side_each(side: Any, vectors: str) -> None:
    assert [SQUARE.letters[k] for k in facing("square", side)] == list(vectors)


def test_edges_of_other_cells_face_sides_by_their_normals() -> None:
    assert [HEXAGON.letters[k] for k in facing("hexagon", "north")] == ["B"]
    assert [HEXAGON.letters[k] for k in facing("hexagon", "east")] == ["A", "F"]
    assert [TRIANGLE.letters[k] for k in facing("triangle", "south")] == ["A"]
    assert [CUBE.letters[k] for k in facing("cube", "north")] == ["N"]


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"adjacencies": [["a", "z"]]}, "expected adjacencies of rooms of the brief, got 'z'"),
        ({"adjacencies": [["a", "a"]]}, "expected adjacencies of two rooms, got 'a' with itself"),
        ({"adjacencies": [["a", "b"], ["b", "a"]]}, "expected each adjacency once"),
        ({"adjacencies": [["a", "b", 0]]}, "a weight above 0"),
        ({"adjacencies": [["a"]]}, "expected two rooms"),
        ({"entrance": "door"}, "an entrance that is a room"),
        ({"wishes": {"a": {"cells": 0}}}, "a whole number of cells, at least 1"),
        ({"wishes": {"a": {"cells": 2.5}}}, "a whole number of cells, at least 1"),
        ({"wishes": {"a": {"cells": 1999}}}, "rooms of 2000 cells in all at most"),
        ({"site": {"outline": [[0, 0], [9, 9], [9, 0], [0, 9]]}}, "side 1 .* meets side 3"),
        ({"site": {"outline": [[0, 0], [9, 0]]}}, "an outline of 3 points at least"),
        ({"site": {"outline": [[0, 0], [9, 0], [5, 0]]}}, "cross or touch itself"),
        ({"site": {"outline": [[0, 0], [0, 0], [5, 0]]}}, "twice in a row"),
        ({"site": {"outline": [[0, 0], [1, 0], [1, "x"]]}}, "a point of two numbers"),
        ({"site": {"street": "up"}}, "site.street"),
    ],
)
def test_wrong_briefs_are_refused(more: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        judged(ROW, **more)


def test_cells_of_all_tilings_lie_in_an_outline_with_all_corners() -> None:
    outline = Outline(((0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)))
    counts = {name: int(ground(outline, name)[0].sum()) for name in TILINGS}
    assert (counts["square"], counts["cube"]) == (36, 36)
    assert 0.7 * 36 / TRIANGLE.area < counts["triangle"] < 36 / TRIANGLE.area
    assert 0.4 * 36 / HEXAGON.area < counts["hexagon"] < 36 / HEXAGON.area


def test_the_i_value_is_the_mean_rra_over_the_doors() -> None:
    path = [["a", "b"], ["b", "c"], ["c", "d"]]
    # A path of four: RA 1 at its ends and 1/3 between, D_4 = .3333 by the formula of semantics.md, section 3.
    d4 = 2 * (4 * (math.log2(6 / 3) - 1) + 1) / (3 * 2)
    assert scored(ROW, adjacencies=path)["i_value"] == pytest.approx((2 * 1 + 2 * (1 / 3)) / 4 / d4)
    assert scored(ROW)["i_value"] == 1.0
    star = scored("aaa bcd", adjacencies=[["a", "b"], ["a", "c"], ["a", "d"]])["i_value"]
    assert star < scored(ROW, adjacencies=path)["i_value"]
