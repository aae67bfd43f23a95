"""What biologies of rooms, zones and houses write."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from houses import house_spec, zones

from genome.errors import InputError
from genome.polyform import Room, decode_assembly, encode
from growth.protocol import Failure
from islands.kinds.house import HouseKind
from islands.kinds.plans import Planner, write_plans

FACTS = {"run": "r", "island": "house", "id": "7", "fitness": 1.0}


def test_a_house_is_drawn_in_the_usual_formats_or_those_asked_for(tmp_path: Path) -> None:
    biology = HouseKind().build(house_spec(), lambda: 0.0).supplied(zones(3))
    genotype = biology.random(np.random.default_rng(1))
    files = biology.write_forms(genotype, tmp_path / "house-best1", (), FACTS)
    assert [one.name for one in files] == ["house-best1.svg", "house-best1.glb", "house-best1.json"]
    assert decode_assembly((tmp_path / "house-best1.json").read_text(encoding="utf-8")) == genotype
    drawn = (tmp_path / "house-best1.svg").read_text(encoding="utf-8")
    assert "<title>r house 7</title>" in drawn
    layout = biology.layout(genotype)
    assert not isinstance(layout, Failure)
    assert drawn.count('class="door"') == len(layout.doors) + 1
    every = biology.write_forms(genotype, tmp_path / "x", ("dxf", "ifc", "png"), FACTS)
    assert [one.suffix for one in every] == [".dxf", ".ifc", ".png"]
    with pytest.raises(InputError, match="--format: expected one of svg, dxf, ifc, glb, png, json, got 'obj'"):
        biology.write_forms(genotype, tmp_path / "x", ("obj",), FACTS)
    assert isinstance(biology, Planner)


def test_plans_of_cubes_are_written_as_they_can_be_and_failures_not_at_all(tmp_path: Path) -> None:
    from evaluators.plans import Brief
    from growth.polyforms import CUBE, form_of

    brief = Brief.model_validate({"tiling": "cube", "rooms": {"a": {"cells": 1}}})
    room = Room(())
    files = write_plans(room, form_of(room, CUBE), brief, tmp_path / "a", (), {})
    assert [one.name for one in files] == ["a.glb", "a.json"]
    assert (tmp_path / "a.json").read_text(encoding="utf-8") == encode(room)
    assert write_plans(room, Failure("conjoining", "none"), brief, tmp_path / "b", (), {}) == []
    with pytest.raises(InputError, match="a plan on one floor"):
        write_plans(room, form_of(room, CUBE), brief, tmp_path / "a", ("svg",), {})
