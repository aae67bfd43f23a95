"""``atoll grow`` and ``atoll check`` on block bodies."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from evaluators.blocks import BLOCK_CRITERIA
from orchestrator.cli import main

SYSTEMS = Path(__file__).resolve().parents[2] / "experiments" / "systems"
SHIPPED = ("arch", "column", "helix", "tree")
CONTRACT = {
    "internal", "boundary", "envelope", "height", "span", "ground", "stable", "max_translational", "max_torsional",
    "accessibility",
}  # fmt: skip


def atoll(*arguments: object):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def grown(*arguments: object) -> dict:
    result = atoll("grow", *arguments, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout.splitlines()[-1])


def refused(result, said: str) -> None:
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert said in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1


def body_file(folder: Path, cells: list, supports: list | None = None) -> Path:
    path = folder / "x.body.json"
    data = {"cells": cells} if supports is None else {"cells": cells, "supports": supports}
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_systems_grow_stand_and_are_measured(name: str) -> None:
    told = grown(SYSTEMS / f"{name}.blocks")
    assert told.keys() >= CONTRACT | BLOCK_CRITERIA.keys()
    assert told["stable"] is True
    assert told["floating"] == told["failed"] == 0
    assert "failure" not in told
    assert told["span"] == max(told["span_x"], told["span_y"])
    assert told["residual"] < 1e-9
    checked = atoll("check", SYSTEMS / f"{name}.blocks", "--json")
    assert json.loads(checked.stdout) == {"ok": True, "kind": "rules"}


def test_the_arch_is_what_it_looks_like() -> None:
    told = grown(SYSTEMS / "arch.blocks")
    assert (told["internal"], told["boundary"], told["envelope"]) == (60, 6, 0)
    assert (told["height"], told["span"], told["ground"]) == (8.0, 12.0, 6.0)
    assert (told["lattice"], told["bounds"]) == ("cubic", [[0, -1, -1], [11, 1, 7]])
    wrapped = grown(SYSTEMS / "arch.blocks", "--set", "envelope=true", "--set", "envelope_below=27")
    assert wrapped["envelope"] > 100
    bare = grown(SYSTEMS / "arch.blocks", "--steps", 0)
    assert (bare["internal"], bare["boundary"]) == (1, 1)


def test_a_body_file_is_measured_against_closed_forms(tmp_path: Path) -> None:
    """A column of n blocks of weight w carries n w at its foot; a cantilever has moment w n^2 / 2 at its root."""
    column = body_file(tmp_path, [[0, 0, z] for z in range(1, 6)], [[0, 0, 0]])
    told = grown(column, "--set", "load.weight=2", "--forces")
    assert told["max_translational"] == pytest.approx(10.0)
    assert told["max_torsional"] == pytest.approx(0.0, abs=1e-9)
    joints = told["forces"]
    assert len(joints) == 5
    feet = {tuple(joint["cells"][0]): joint["translational"] for joint in joints}
    assert feet == pytest.approx({(0, 0, z): 2.0 * (5 - z) for z in range(5)})
    beam = body_file(tmp_path, [[x, 0, 0] for x in range(1, 7)], [[0, 0, 0]])
    told = grown(beam)
    assert told["max_translational"] == pytest.approx(6.0)
    assert told["max_torsional"] == pytest.approx(6.0**2 / 2.0)
    checked = atoll("check", beam, "--json")
    assert json.loads(checked.stdout) == {"ok": True, "kind": "body"}


def test_a_body_that_does_not_stand_is_told_why(tmp_path: Path) -> None:
    beam = body_file(tmp_path, [[x, 0, 0] for x in range(1, 7)], [[0, 0, 0]])
    told = grown(beam, "--set", "load.torsion_strength=10")
    assert told["stable"] is False
    assert told["failed"] > 0
    assert told["failure"].startswith("unstable: joint (0,0,0)-(1,0,0): torsional 18 over 10")
    # It holds in the end, with its counterweight, and not while it grows.
    arms = [[1, 0, 2], [2, 0, 2], [3, 0, 2], [-1, 0, 2], [-2, 0, 2], [-3, 0, 2]]
    balance = body_file(tmp_path, [[0, 0, 1], [0, 0, 2], *arms], [[0, 0, 0]])
    assert grown(balance, "--set", "load.torsion_strength=5", "--set", "load.stages=1")["stable"] is True
    told = grown(balance, "--set", "load.torsion_strength=5", "--set", "load.stages=8")
    assert told["stable"] is False
    assert told["failed"] == 0
    assert told["failure"] == "unstable: joint (0,0,0)-(0,0,1): torsional 6 over 5 at stage 5 of 8"
    missing = grown(SYSTEMS / "arch.blocks", "--set", "ground=fixed", "--set", "ground_level=-9")
    assert (missing["stable"], missing["boundary"], missing["floating"]) == (False, 0, 60)
    assert "touches no ground" in missing["failure"]


def test_a_body_of_a_file_stands_on_its_own_supports_at_every_stage(tmp_path: Path) -> None:
    """A beam between two walls is a cantilever until it reaches the second."""
    beam = body_file(tmp_path, [[x, 0, 5] for x in range(1, 8)], [[0, 0, 5], [8, 0, 5]])
    words = ("--set", "load.model=frame", "--set", "load.torsion_strength=6")
    assert grown(beam, *words)["stable"] is True
    told = grown(beam, *words, "--set", "load.stages=7")
    assert told["stable"] is False
    assert "torsional 8 over 6 at stage 4 of 7" in told["failure"]
    # The longest cantilever has 6 blocks.
    assert told["self_support"] == pytest.approx(1 - 18 / 6)
    iso = tmp_path / "iso.body.json"
    iso.write_text(json.dumps({"lattice": "isospatial", "cells": [[0, 0, 0], [0, 1, 1], [0, 2, 2]]}), encoding="utf-8")
    assert grown(iso, "--set", "load.stages=3")["lattice"] == "isospatial"


def test_a_factor_that_nothing_bounds_is_null(tmp_path: Path) -> None:
    column = body_file(tmp_path, [[0, 0, z] for z in range(4)])
    assert grown(column, "--set", "load.model=limit")["factor"] is None
    told = grown(column, "--set", "load.model=limit", "--set", "load.axial_strength=8")
    assert told["factor"] == pytest.approx(2.0, rel=0.02)


def test_the_seed_decides_what_chance_does() -> None:
    tree = SYSTEMS / "tree.blocks"
    own = grown(tree)
    assert grown(tree) == own
    assert grown(tree, "--seed", 5) == own
    assert grown(tree, "--seed", 0) != own


@pytest.mark.parametrize("suffix", ["glb", "obj", "stl", "npz", "png"])
def test_a_body_is_written_in_every_format(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"column.{suffix}"
    told = grown(SYSTEMS / "column.blocks", "-o", path)
    assert told["file"] == str(path)
    plain = path.read_bytes()
    grown(SYSTEMS / "column.blocks", "--forces", "-o", path)
    assert (path.read_bytes() == plain) == (suffix == "stl")


def test_forces_colour_the_cells_that_bear_most(tmp_path: Path) -> None:
    grown(SYSTEMS / "column.blocks", "--forces", "-o", tmp_path / "x.npz")
    with np.load(tmp_path / "x.npz") as data:
        assert data["grid"].shape == (5, 5, 14)
        axis, slab = data["forces"][2, 2], data["forces"][0, 0]
    # Up the axis: foundation, base of two steps, shaft from level 3 on, two steps of the capital.
    assert axis.argmax() in (3, 4)
    assert (np.diff(axis[4:12]) < 0.0).all()
    assert slab[:2].max() < 0.2


def test_bad_input_is_told_in_a_line(tmp_path: Path) -> None:
    arch = SYSTEMS / "arch.blocks"
    bad = tmp_path / "bad.blocks"
    bad.write_text("axiom: F\niterations: 2\nF -> F[F\n", encoding="utf-8")
    body = body_file(tmp_path, [[0, 0, 1]], [[0, 0, 1]])
    for command in ("grow", "check"):
        refused(atoll(command, bad), "bad.blocks:3:7: expected a ']' for this '['")
        refused(atoll(command, tmp_path / "none.blocks"), "expected a rule file, got no such file")
        refused(atoll(command, tmp_path / "none.body.json"), "expected a body's file, got no such file")
        refused(atoll(command, body), "x.body.json: cells: expected cells that are no supports, got [0, 0, 1]")
    refused(atoll("check", arch, "--set", "x=1"), "--set: expected an experiment")
    refused(atoll("grow", arch, "--set", "latice=cubic"), "--set: latice: expected a known key, got 'latice'; did you")
    refused(
        atoll("grow", arch, "--set", "load.axial_strength=0"), "--set: load.axial_strength: expected greater than 0"
    )
    refused(atoll("grow", arch, "--set", "load.x.y=0"), "expected key=value or load.key=value")
    refused(atoll("grow", arch, "--set", "load=0"), "--set: load: expected a known key")
    refused(atoll("grow", arch, "--steps", -1), "--steps: expected a number of iterations from 0 to 1000, got -1")
    refused(atoll("grow", arch, "--time", 1), "--time: expected a timed system (.tl)")
    refused(atoll("grow", arch, "--environment", "x.env.yaml"), "--environment: expected a form that grows in one")
    refused(atoll("grow", arch, "-o", tmp_path / "x.ply"), "-o: expected a file that ends in .glb, .obj, .stl, .npz")
    refused(atoll("grow", arch, "--set", "load.dimensions=2"), "one plane of x and z")
    good = body_file(tmp_path, [[0, 0, 1]])
    refused(atoll("grow", good, "--steps", 1), "--steps: expected rules to grow from")
    refused(atoll("grow", good, "--set", "lattice=cubic"), "--set lattice: expected a setting that the body's file")
    refused(atoll("grow", SYSTEMS / "square.hemls", "--forces"), "--forces: expected a block body")


def test_a_growth_that_fails_exits_with_one(tmp_path: Path) -> None:
    wild = tmp_path / "wild.blocks"
    wild.write_text("axiom: F\niterations: 40\nF -> FF\n", encoding="utf-8")
    result = atoll("grow", wild)
    assert result.exit_code == 1
    assert "did not grow: budget: iteration 16 makes 65536 symbols where max_symbols allows 50000" in result.stderr
    shown = atoll("grow", SYSTEMS / "column.blocks", "--steps", 0, "--forces")
    assert shown.exit_code == 0
    assert "stable: True" in shown.stdout
    assert "forces.0: cells=" in shown.stdout
