"""Rooms, zones and houses as islands: what rises, what is asked for, what is eliminated."""

from __future__ import annotations

import json

import numpy as np
import pytest
from archipelagos import spec
from houses import BRIEF, ZONES, house_spec, migrant, room, zone, zones

from genome.errors import InputError
from genome.polyform import Assembly, Conjoining, Room, encode
from growth.polyforms import SQUARE, Plan, form_of
from islands.kinds.assemblies import AssemblyBiology, _assembly, _genes
from islands.kinds.house import HouseKind
from islands.kinds.meshes import read_mesh_text
from islands.kinds.parts import demand_text, part_text, read_demand_text, read_part_text
from islands.kinds.room import RoomBiology, RoomKind
from islands.kinds.zone import ZoneKind


def house(**growth) -> AssemblyBiology:
    return HouseKind().build(house_spec(**growth), lambda: 0.0).supplied(zones(5))


def living() -> RoomBiology:
    genome = RoomKind.genome.model_validate({"cells": 6}).model_dump(mode="json")
    fitness = {"corners": {"goal": "minimise"}, "fresh": {"goal": "maximise"}}
    return RoomKind().build(spec(kind="room", group="living", genome=genome, growth={}, fitness=fitness), lambda: 0.0)


def test_a_house_waits_until_there_is_a_part_of_each_name() -> None:
    waiting = HouseKind().build(house_spec(), lambda: 0.0)
    assert not waiting.ready
    assert not waiting.supplied(zones(3)[:3]).ready
    assert waiting.supplied(zones(1)).ready


def test_a_house_names_its_parts_and_keeps_their_order() -> None:
    biology, rng = house(), np.random.default_rng(2)
    for one in [biology.random(rng) for _ in range(20)]:
        first, second = biology.components(one)
        assert (first // 100, second // 100) == (1, 2)
        assert biology.evaluate(one).fitness is not None
        assert [part.genotype.size for part in one.parts] == [9, 6]


def test_what_is_bred_is_made_of_the_parents_parts_or_of_those_that_rose() -> None:
    biology, rng = house(), np.random.default_rng(3)
    known = {one.id for one in zones(5)}
    mothers = [biology.random(rng) for _ in range(12)]
    exchanged = redrawn = 0
    for first, second in zip(mothers[::2], mothers[1::2], strict=True):
        for child in biology.crossover(first, second, rng):
            assert set(child.parts) <= {*first.parts, *second.parts}
        for _ in range(10):
            child = biology.mutate(first, rng)
            assert {part.id for part in child.parts} <= known
            assert isinstance(form_of(child, SQUARE), Plan)
            exchanged += child.parts != first.parts
            redrawn += child.parts == first.parts and child.joins != first.joins
    assert exchanged > 10
    assert redrawn > 10


def test_crossover_has_the_papers_sites() -> None:
    one = zone([2, 3, 4], np.random.default_rng(1))
    genes = _genes(one)
    assert len(genes) == 5  # four sites, as in Figure 6
    assert _assembly(genes) == one


def test_short_of_what_is_required_a_plan_is_eliminated_and_keeps_its_scores() -> None:
    free, strict, rng = house(), house(required={"met": 1.0}), np.random.default_rng(4)
    eliminated = 0
    for one in [free.random(rng) for _ in range(30)]:
        scores = dict(free.evaluate(one).scores)
        found = strict.evaluate(one)
        assert dict(found.scores) == scores
        if scores["met"] < 1.0:
            eliminated += 1
            assert found.fitness is None
            assert found.error == f"constraint: met {scores['met']:g} where 1 is required"
        else:
            assert found.fitness == free.evaluate(one).fitness
    assert eliminated > 0


def test_parts_and_demands_survive_their_texts() -> None:
    rng = np.random.default_rng(5)
    for one in (room(6, rng), zone([2, 3], rng)):
        assert read_part_text(part_text("living", one)) == ("living", one)
        assert read_demand_text(demand_text(0.5, {"living": one})) == (0.5, {"living": one})


@pytest.mark.parametrize("text", ["", "[]", '{"name":"a"}', '{"name":1,"genotype":{}}', '{"met":NaN,"parts":{}}'])
def test_other_texts_are_no_parts_and_no_demands(text: str) -> None:
    with pytest.raises(InputError):
        read_part_text(text)
    with pytest.raises(InputError):
        read_demand_text(text)


def row(size: int) -> Room:
    return Room(tuple(Conjoining(2, 0) for _ in range(size - 1)))


def test_a_room_is_fresh_by_how_far_it_is_from_what_an_unsatisfied_plan_uses() -> None:
    biology = living()
    upright = row(6)
    level = Room(tuple(Conjoining(3, 0) for _ in range(5)))
    assert dict(biology.evaluate(upright).scores)["fresh"] == 0.0

    def fresh(one: Room, *demands: str) -> float:
        found = biology.evaluate_with(one, tuple(migrant(k, text) for k, text in enumerate(demands)))
        return dict(found.scores)["fresh"]

    asked = demand_text(0.25, {"living": level})
    assert fresh(level, asked) == 0.0
    assert fresh(upright, asked) == pytest.approx(0.75 * (1 - 1 / 11))
    assert fresh(upright, asked, demand_text(0.5, {"living": upright})) == 0.0
    assert fresh(upright, demand_text(1.0, {"living": level})) == 0.0
    assert fresh(upright, demand_text(0.0, {"bed": level})) == 0.0


def test_what_a_house_offers() -> None:
    biology, rng = house(), np.random.default_rng(6)
    one = biology.random(rng)
    demand = read_demand_text(biology.offer(one, "partners"))
    assert demand.met == dict(biology.evaluate(one).scores)["met"]
    assert list(demand.parts) == list(ZONES)
    vertices, triangles = read_mesh_text(biology.offer(one, "surroundings"), "house")
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(15 * 3.0)
    assert biology.decode(biology.offer(one, "migrants")) == one


def test_a_part_of_other_rooms_is_no_part() -> None:
    biology = house()
    rng = np.random.default_rng(7)
    wrong = part_text("day", zone([3, 3, 3], rng)), part_text("night", zone([4, 2], rng))
    supplied = biology.supplied(tuple(migrant(k, text) for k, text in enumerate(wrong)))
    found = supplied.evaluate(supplied.random(rng))
    assert found.error == "parts: a part of 3 rooms where 2 are expected: hall, living"


def test_diversity_is_the_mean_distance_of_the_forms() -> None:
    biology = living()
    upright, level = row(6), Room(tuple(Conjoining(3, 0) for _ in range(5)))
    assert biology.diversity([upright]) is None
    assert biology.diversity([upright, upright]) == 0.0
    assert biology.diversity([upright, level, upright]) == pytest.approx(2 / 3 * (1 - 1 / 11))


def test_islands_give_and_take_parts_by_name() -> None:
    genome = {"parts": {"hall": ["hall"], "living": ["living"]}, "part": None}
    own = spec(kind="zone", group="day", genome=genome, growth={})
    kind = ZoneKind()
    assert kind.gives(own) == {"components": "part day", "partners": "demand"}
    assert kind.takes(own)["components"] == ("part hall", "part living")
    assert kind.needed(own) == {"components": ("part hall", "part living")}
    assert RoomKind().gives(spec(kind="room", group="living", genome={"cells": 6}, growth={})) == {
        "components": "part living"
    }


@pytest.mark.parametrize(
    ("genome", "growth", "message"),
    [
        ({"parts": ["hall", "attic"]}, {}, "expected rooms of the brief, got 'attic'"),
        ({"parts": ["hall", "living"]}, {}, "expected each room of the brief, got none named 'bed'"),
        ({}, {"required": {"mett": 1.0}}, "did you mean 'met'"),
    ],
)
def test_parts_that_do_not_fit_the_brief_are_refused(genome, growth, message: str) -> None:
    kind = HouseKind()
    written = kind.genome.model_validate({"parts": ZONES, **genome}).model_dump(mode="json")
    settings = kind.growth.model_validate({"brief": BRIEF, **growth}).model_dump(mode="json")
    with pytest.raises(InputError, match=message):
        kind.build(spec(kind="house", genome=written, growth=settings, fitness={}), lambda: 0.0)


def test_forms_are_written_with_their_genotype(tmp_path) -> None:
    biology = house()
    one = biology.random(np.random.default_rng(8))
    (path,) = biology.write_forms(one, tmp_path / "best", ("json",), {})
    assert json.loads(path.read_text()) == json.loads(encode(one))
    assert isinstance(one, Assembly)
