"""Mistakes in experiments with block bodies: refused by ``check`` and ``run`` alike, in a line that names the key."""

from __future__ import annotations

import copy
from typing import Any

import pytest
from block_bodies import building
from click.testing import CliRunner
from refusals import refused

from experiments import write
from orchestrator.cli import main


def built(path: str, value: Any, kind: str = "blocks") -> dict[str, Any]:
    """Give the experiment with one key of its island set."""
    data = copy.deepcopy(building())
    section = data["islands"]["tower"]
    section["kind"] = kind
    *keys, last = path.split(".")
    for key in keys:
        section = section.setdefault(key, {})
    section[last] = value
    return data


CASES: dict[str, tuple[dict[str, Any], str, str]] = {
    "unbalanced brackets": (built("genome.axiom", "F[+F"), "genome.axiom", "expected"),
    "an unknown symbol": (built("genome.axiom", "F?F"), "genome.axiom", "expected"),
    "an unknown symbol among those to draw": (built("genome.symbols", "F+?"), "genome.symbols", "got '?'"),
    "words that never draw": (built("genome.symbols", "+-"), "genome.symbols", "F among them"),
    "an axiom that no rule can rewrite": (built("genome.axiom", "++"), "genome.axiom", "a letter that rules can"),
    "a strength of zero": (built("growth.load.axial_strength", 0), "growth.load.axial_strength", "than 0, got 0"),
    "a strength below zero": (
        built("growth.load.torsion_strength", -1.5), "growth.load.torsion_strength", "greater than 0, got -1.5"
    ),
    "a model that there is not": (built("growth.load.model", "rigit"), "growth.load.model", "'galasyn', 'rigid', "),
    "a misspelt key of the load": (
        built("growth.load.torsional_strength", 4), "growth.load.torsional_strength", "did you mean 'torsion_strength'?"
    ),
    "no stage": (built("growth.load.stages", 0), "growth.load.stages", "greater than or equal to 1, got 0"),
    "a lattice that there is not": (built("growth.lattice", "hexagonal"), "growth.lattice", "'cubic' or 'isospatial'"),
    "no supports": (built("growth.supports", []), "growth.supports", "a list of cells"),
    "a start that is no cell": (built("growth.start", [0, 0.5, 0]), "growth.start", "a cell of three whole numbers"),
    "a start between cells": (
        built("growth", {"lattice": "isospatial", "start": [1, 0, 0]}), "growth.start", "add up to an even number"
    ),
    "a criterion that there is not": (
        built("fitness", {"hieght": {"goal": "maximise"}}), "fitness.hieght", "did you mean 'height'?"
    ),
    "a weight that is no number": (
        built("fitness", {"height": {"goal": "maximise", "weight": "heavy"}}), "fitness.height.weight", "a number"
    ),
    "more parents than members": (
        built("algorithm", {"name": "parents", "parents": 9}), "algorithm.parents", "at most the population of 8, got 9"
    ),
    "one start of a pair": (
        built("growth", {"starts": [[0, 0, 0]]}, "block_pair"), "growth.starts", "expected two cells"
    ),
    "a single body's key for a pair": (built("growth", {"start": [0, 0, 0]}, "block_pair"), "growth.start", "'starts'"),
    "a genome for both of a pair": (built("genome", {"rules": 2}, "block_pair"), "genome.rules", "known: first, sec"),
}  # fmt: skip


def nan() -> str:
    return """islands:
  tower: {kind: blocks, fitness: {height: {goal: maximise, weight: .nan}}}
"""


def partners(lattice: str) -> dict[str, Any]:
    tower = building()["islands"]["tower"] | {"count": 1}
    other = tower | {"species": "other", "growth": {"lattice": lattice}}
    channels = [{"kind": "partners", "from": "tower", "to": "other"}, {"topology": "unconnected", "among": "tower"}]
    return building(islands={"tower": tower, "other": other}, channels=channels)


@pytest.mark.parametrize("name", CASES)
def test_is_refused_by_check_and_by_run_in_one_line_that_names_the_key(tmp_path, name) -> None:
    data, key, told = CASES[name]
    for line in refused(tmp_path, data):
        assert f"islands.tower.{key}: expected " in line
        assert told in line


def test_a_weight_of_nan_is_refused(tmp_path) -> None:
    path = tmp_path / "nan.yaml"
    path.write_text(nan(), encoding="utf-8")
    result = CliRunner().invoke(main, ["check", str(path)])
    assert result.exit_code == 2
    assert "expected a finite number, got" in result.stderr


def test_partners_on_another_lattice_are_refused(tmp_path) -> None:
    assert CliRunner().invoke(main, ["check", str(write(tmp_path, partners("cubic")))]).exit_code == 0
    result = CliRunner().invoke(main, ["check", str(write(tmp_path, partners("isospatial")))])
    assert result.exit_code == 2
    assert "blocks, cubic" in result.stderr
    assert "blocks, isospatial" in result.stderr


def test_rules_that_grow_without_end_are_invalid_and_the_run_goes_on(tmp_path) -> None:
    data = built("genome", {"iterations": 30, "axiom": "F"})
    data["islands"]["tower"]["growth"]["max_blocks"] = 300
    path = write(tmp_path, data)
    result = CliRunner().invoke(main, ["run", str(path), "--runs-dir", str(tmp_path / "runs"), "--set", "epochs=1"])
    assert result.exit_code == 0, result.stderr
    sql = "select count(*) > 0 from individuals where error like 'budget: %'"
    found = CliRunner().invoke(main, ["query", str(tmp_path / "runs" / "building"), sql, "--format", "csv"])
    assert "true" in found.stdout.lower()
