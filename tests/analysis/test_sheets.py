"""``atoll sheet`` on a small run of rooms, zones and a house."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest
from click.testing import CliRunner
from PIL import Image

from orchestrator.cli import main

EXPERIMENT = """
name: small
seed: 3
epoch: 1
backend: inline
brief:
  rooms: {hall: {cells: 2}, living: {cells: 4}, bed: {cells: 3}}
  zones: {day: [hall, living], night: [bed]}
  adjacencies: [[hall, living], [hall, bed]]
  entrance: hall
  levels: in_turn
  room: {epochs: 1, population: 6, rise: 3}
  zone: {epochs: 2, population: 6, rise: 3}
  house: {epochs: 2, population: 8}
"""


def atoll(*arguments: object) -> Any:
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sheets")
    (folder / "small.yaml").write_text(EXPERIMENT, encoding="utf-8")
    result = atoll("run", folder / "small.yaml", "--runs-dir", folder, "--json")
    assert result.exit_code == 0, result.output
    return folder / "small"


def test_a_run_ends_with_drawings(done: Path) -> None:
    names = {one.name for one in (done / "forms").iterdir()}
    assert {f"{stem}-best1.{suffix}" for stem in ("hall", "day", "house") for suffix in ("svg", "glb", "json")} <= names


def test_the_best_plans_of_the_uppermost_level_stand_side_by_side(done: Path, tmp_path: Path) -> None:
    path = tmp_path / "best.svg"
    result = atoll("sheet", done, "--best", 3, "-o", path, "--json")
    assert json.loads(result.stdout.splitlines()[-1]) == {"file": str(path), "missing": []}
    root = ET.fromstring(path.read_bytes())
    captions = [one.text or "" for one in root.iter() if one.get("class") == "caption"]
    fitness = [float(one.partition(": ")[2]) for one in captions]
    assert 1 <= len(captions) <= 3
    assert fitness == sorted(fitness, reverse=True)
    assert [one.text for one in root.iter() if one.get("class") == "name"][:3] == ["H", "L", "B"]
    assert atoll("sheet", done, "--island", "living", "-o", tmp_path / "living.png").exit_code == 0
    with Image.open(tmp_path / "living.png") as picture:
        assert picture.width > 1000


def test_sheets_that_cannot_be_drawn_are_refused(done: Path, tmp_path: Path) -> None:
    for arguments, said in (
        (("--island", "livin", "-o", tmp_path / "x.png"), "did you mean 'living'?"),
        (("-o", tmp_path / "x.pdf"), "expected a file that ends in .png, .svg"),
    ):
        result = atoll("sheet", done, *arguments)
        assert result.exit_code == 2
        assert said in result.stderr
