"""``atoll grow`` and ``atoll check`` on ``.plan`` files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from evaluators.plans import PLAN_CRITERIA
from evaluators.rooms import ROOM_CRITERIA
from genome.polyform import Assembly, Room, decode_any
from orchestrator.cli import main

SYSTEMS = Path(__file__).resolve().parents[2] / "experiments" / "systems"

ZONE = """
brief:
  rooms: {a: {cells: 2}, b: {cells: 1}, c: {cells: 1}}
  zones: {left: [a, b], right: [c]}
  adjacencies: [[a, b], [b, c]]
  order: given
"""


def atoll(*arguments: object) -> Any:
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def grown(*arguments: object) -> dict[str, Any]:
    result = atoll("grow", *arguments, "--json")
    assert result.exit_code == 0, result.output
    return dict(json.loads(result.stdout.splitlines()[-1]))


def plan(folder: Path, text: str) -> Path:
    path = folder / "x.plan"
    path.write_text(text, encoding="utf-8")
    return path


def complaints(path: Path, *arguments: object) -> list[str]:
    """Give the one line by which ``grow``, and without arguments ``check``, refuse a file."""
    found = []
    for command in ("grow",) if arguments else ("grow", "check"):
        result = atoll(command, path, *arguments)
        assert result.exit_code == 2, result.output
        (line,) = result.stderr.strip().splitlines()
        found.append(line)
    return found


def test_the_papers_trimino() -> None:
    told = grown(SYSTEMS / "trimino.plan")
    assert (told["cells"], told["perimeter"], told["corners"], told["area"]) == (3, 8.0, 6.0, 3.0)
    assert told.keys() >= {*ROOM_CRITERIA, "rooms", "doors"}
    assert told["rooms"] == [{"name": "room", "cells": 3, "area": 3.0, "perimeter": 8.0, "corners": 6.0}]


def test_the_shipped_house_meets_all_that_is_wanted() -> None:
    told = grown(SYSTEMS / "house.plan")
    assert told.keys() >= {*PLAN_CRITERIA, "cells", "perimeter", "corners", "rooms"}
    assert (told["cells"], told["met"], told["adjacency"], told["circulation"]) == (88, 1.0, 7.0, 1.0)
    assert [one["cells"] for one in told["rooms"]] == [24, 15, 9, 4, 3, 15, 12, 6]
    assert len(told["doors"]) == 7
    checked = atoll("check", SYSTEMS / "house.plan", "--json")
    assert json.loads(checked.stdout) == {"ok": True, "kind": "plan"}


def test_what_a_file_leaves_open_is_drawn_from_the_seed(tmp_path: Path) -> None:
    living = SYSTEMS / "living.plan"
    assert grown(living) == grown(living, "--seed", 9)
    assert grown(living) != grown(living, "--seed", 10)
    assert grown(living)["rooms"][0] == grown(living, "--seed", 10)["rooms"][0]
    drawn = plan(tmp_path, "cells: 12\ntiling: hexagon\n")
    assert grown(drawn)["cells"] == 12
    assert len({grown(drawn, "--seed", seed)["perimeter"] for seed in range(6)}) > 1


def test_conjoinings_are_taken_as_they_are_given(tmp_path: Path) -> None:
    path = plan(tmp_path, ZONE + "rooms: {a: [S1]}\njoins: {left: [[S1, 1]], house: [[S1, 1]]}\n")
    told = grown(path, "-o", tmp_path / "x.json")
    assert (told["perimeter"], told["corners"], told["met"]) == (10.0, 4.0, 1.0)
    whole = decode_any((tmp_path / "x.json").read_text(encoding="utf-8"))
    assert isinstance(whole, Assembly)
    assert whole.joins == ((3, 0, 0),)
    assert [type(part.genotype) for part in whole.parts] == [Assembly, Room]
    overlapping = plan(tmp_path, ZONE + "rooms: {a: [S1]}\njoins: {left: [[S2, 1]], house: [[S1, 1]]}\n")
    result = atoll("grow", overlapping)
    assert result.exit_code == 1
    assert "left: number 1: there is no free edge S2" in result.stderr


def test_triangles_point_up_or_down(tmp_path: Path) -> None:
    told = grown(plan(tmp_path, "tiling: triangle\nunit: 2\nroom: [down, D1]\n"))
    assert (told["cells"], told["perimeter"]) == (2, 4.0)
    assert told["area"] == pytest.approx(2 * 3**0.5)
    lines = complaints(plan(tmp_path, "tiling: triangle\nroom: [up, Z1]\n"))
    assert all("x.plan:2: room.1: expected a vector's letter (A, B" in line for line in lines)
    result = atoll("grow", plan(tmp_path, "tiling: triangle\nroom: [up, D1]\n"))
    assert (result.exit_code, "there is no free edge D1" in result.stderr) == (1, True)


@pytest.mark.parametrize("suffix", ["svg", "dxf", "ifc", "glb", "png"])
def test_plans_are_written_in_each_format(suffix: str, tmp_path: Path) -> None:
    told = grown(SYSTEMS / "trimino.plan", "-o", tmp_path / f"x.{suffix}")
    assert told["file"] == str(tmp_path / f"x.{suffix}")
    begins = {"svg": b"<?xml", "dxf": b"  0\nSECTION", "ifc": b"ISO-10303-21", "glb": b"glTF", "png": b"\x89PNG"}
    assert (tmp_path / f"x.{suffix}").read_bytes().startswith(begins[suffix])


def test_cubes_have_no_floor_plan(tmp_path: Path) -> None:
    path = plan(tmp_path, "tiling: cube\nroom: [U1, N1]\n")
    assert grown(path, "-o", tmp_path / "x.glb")["cells"] == 3
    (line,) = complaints(path, "-o", tmp_path / "x.svg")
    assert "drawing: expected a plan on one floor, got one of cubes" in line


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("unit: 2\n", "expected a brief, a room's conjoinings or its cells"),
        ("room: [E0]\n", "x.plan:1: room.0: expected a vector's letter (W, N, E, S) and the number of a free edge"),
        ("room: [up]\n", "expected a vector's letter"),
        ("room: [E1]\ncells: 3\n", "x.plan:2: cells: expected conjoinings of 3 cells, got conjoinings of 2"),
        ("rom: [E1]\n", "did you mean 'room'?"),
        (ZONE + "rooms: {d: [E1]}\n", "rooms.d: expected rooms of the brief, got 'd'"),
        (ZONE + "rooms: {a: []}\n", "rooms.a: expected 1 conjoinings for 2 cells, got 0"),
        (ZONE + "joins: {left: []}\n", "joins.left: expected an attachment of each part but the first (a, b), got 0"),
        (ZONE + "joins: {up: []}\n", "joins.up: expected zones of the brief, or the house"),
        (ZONE + "joins: {left: [[E1]]}\n", "joins.left.0: expected a free edge and the number of the part's"),
        (ZONE + "joins: {left: [[E1, 0]]}\n", "joins.left.0: expected a free edge and the number of the part's"),
        (ZONE.replace("c: {cells: 1}", "c: {cells: 0}"), "brief.rooms.c.cells: expected a whole number of cells"),
        (ZONE.replace("right: [c]", "right: []"), "expected zones of one room at least"),
    ],
)
def test_wrong_files_are_refused(text: str, said: str, tmp_path: Path) -> None:
    lines = complaints(plan(tmp_path, text))
    assert len(lines) == 2
    assert all(said in line for line in lines), lines


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--steps", 2), "--steps: expected rules to derive"),
        (("--time", 1), "--time: expected a timed system"),
        (("--environment", "x.yaml"), "a plan's site is in its brief"),
        (("--set", "unit=2"), "set it in the file"),
        (("--forces",), "--forces: expected a block body"),
        (("-o", "x.obj"), "expected a file that ends in .svg, .dxf, .ifc, .glb, .png, .json"),
    ],
)
def test_options_of_other_engines_are_refused(arguments: tuple[object, ...], said: str) -> None:
    (line,) = complaints(SYSTEMS / "trimino.plan", *arguments)
    assert said in line
