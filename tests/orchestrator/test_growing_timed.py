"""``atoll grow`` and ``atoll check`` on timed systems."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from orchestrator.cli import main

SYSTEMS = Path(__file__).resolve().parents[2] / "experiments" / "systems"
PISTON = SYSTEMS / "piston.tl"


def atoll(*arguments: object):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def grown(*arguments: object) -> dict:
    result = atoll("grow", *arguments, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout.splitlines()[-1])


def refused(said: str, *arguments: object) -> None:
    result = atoll(*arguments)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert said in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1


def test_the_word_is_symbols_parameters_and_ages() -> None:
    told = grown(PISTON, "--time", 1.04, "--word")
    assert (told["modules"], told["time"]) == (12, 1.04)
    assert told["word"][0] == ["mov", pytest.approx([50.0]), pytest.approx(1.0)]
    assert told["word"][2] == ["cC", [60.0, 1.0], pytest.approx(1.0)]
    assert told["word"][9] == ["[", [], pytest.approx(1.0)]
    assert "word" not in grown(PISTON, "--time", 1.04)


@pytest.mark.parametrize("name", ["bush", "filament", "flower", "gait", "piston"])
def test_shipped_systems_grow(name: str) -> None:
    assert grown(SYSTEMS / f"{name}.tl", "--time", 2)["modules"] >= 3
    checked = atoll("check", SYSTEMS / f"{name}.tl", "--json")
    assert json.loads(checked.stdout) == {"ok": True, "kind": "rules"}


def test_defines_budget_and_seed_can_be_set() -> None:
    word = grown(PISTON, "--time", 1.04, "--word", "--set", "define.WR=20")["word"]
    assert word[0][1] == pytest.approx([20.0])
    assert grown(PISTON, "--time", 5.04, "--word", "--set", "define.PAPER=1")["word"][3][1] == pytest.approx(
        [0.505360510]
    )
    flower = SYSTEMS / "flower.tl"
    own = grown(flower, "--time", 9, "--word")
    assert grown(flower, "--time", 9, "--word", "--seed", 0) == own
    assert grown(flower, "--time", 9, "--word", "--seed", 1) != own
    few = atoll("grow", SYSTEMS / "bush.tl", "--time", 9, "--set", "max_modules=50")
    assert few.exit_code == 1
    assert "bush.tl did not grow: budget: more modules at time 9 than the 50 that max_modules allows" in few.stderr


def test_symbols_that_draw_nothing_are_named(tmp_path: Path) -> None:
    odd = tmp_path / "odd.tl"
    odd.write_text("equiv F leg\naxiom leg(1) Z A B\nA -> A B\n", encoding="utf-8")
    assert grown(odd, "--time", 1)["ignored"] == ["Z", "B"]
    assert "ignored" not in grown(PISTON, "--time", 1)
    checked = atoll("check", odd)
    assert checked.exit_code == 0
    assert (
        f"note: {odd}: the turtle draws nothing for Z, B; such a symbol needs a production, or an equiv"
        in checked.stderr
    )
    assert "note" not in atoll("check", PISTON).stderr


def test_a_growth_that_fails_exits_with_one(tmp_path: Path) -> None:
    bad = tmp_path / "bad.tl"
    bad.write_text("axiom A(0)\nA(x) @ 2 -> B(1/x)\n", encoding="utf-8")
    assert atoll("check", bad).exit_code == 0
    result = atoll("grow", bad, "--time", 3)
    assert result.exit_code == 1
    assert "did not grow: expression: division by zero, in a parameter of B at time 2" in result.stderr


def test_bad_input_is_told_in_a_line(tmp_path: Path) -> None:
    bad = tmp_path / "bad.tl"
    bad.write_text("axiom A(1)\nA(x) @ 1 -> [ A(x)\n", encoding="utf-8")
    for command in (("check", bad), ("grow", bad, "--time", 1)):
        refused("bad.tl:2:13: expected a ']' for this '[', got none; brackets must balance", *command)
    constant = tmp_path / "constant.tl"
    constant.write_text("#define K 1/0\naxiom A\n", encoding="utf-8")
    for command in (("check", constant), ("grow", constant, "--time", 1)):
        refused("constant.tl:1:9: expected a value of K, got division by zero", *command)
    refused("expected a rule file, got no such file", "grow", tmp_path / "none.tl", "--time", 1)
    refused("--time: expected the time to grow to, got none; for example --time 1.5", "grow", PISTON)
    refused("--time: expected a time of 0 or more, or FROM:TO:STEP, got '-1'", "grow", PISTON, "--time", -1)
    refused("--time: expected a time of 0 or more, or FROM:TO:STEP, got 'nan'", "grow", PISTON, "--time", "nan")
    refused("--steps: expected a form that takes it", "grow", PISTON, "--time", 1, "--steps", 2)
    refused("--forces: expected a form that takes it", "grow", PISTON, "--time", 1, "--forces")
    refused("--environment: expected a form that takes it", "grow", PISTON, "--time", 1, "--environment", "x.env.yaml")
    refused("-o: expected a file that ends in .glb, .png, .gif", "grow", PISTON, "--time", 1, "-o", tmp_path / "x.dxf")
    refused("-o: expected a form with parts, got none", "grow", PISTON, "--time", 0, "-o", tmp_path / "x.glb")
    for times in ("0:1", "2:1:1", "0:1:0", "0:1:-1", "a:b:c", "0:inf:1", ""):
        refused("--time: expected ", "grow", PISTON, "--time", times)
    refused("--time: expected at most 5000 times", "grow", PISTON, "--time", "0:1:0.0001")
    refused("--word: expected one time, got --time 0:1:1", "grow", PISTON, "--time", "0:1:1", "--word")
    refused("--set: turtle.side: expected a known key", "grow", PISTON, "--time", 1, "--set", "turtle.side=9")
    refused("--set: max_module: expected a known key", "grow", PISTON, "--time", 1, "--set", "max_module=3")
    refused("expected the name of a define in the file, got 'WS'", "grow", PISTON, "--time", 1, "--set", "define.WS=3")
    refused("expected a number, got 'a'", "grow", PISTON, "--time", 1, "--set", "define.WR=a")
    refused("expected key=value, define.NAME=value, turtle.KEY=value", "grow", PISTON, "--time", 1, "--set", "a.b=3")
    refused("--word: expected a timed system (.tl)", "grow", SYSTEMS / "square.hemls", "--word")
    refused("--word: expected a timed system (.tl)", "grow", SYSTEMS / "arch.blocks", "--word")
    refused("--word: expected a timed system (.tl)", "grow", SYSTEMS / "house.plan", "--word")


def test_a_range_of_times_becomes_an_animation(tmp_path: Path) -> None:
    told = grown(PISTON, "--time", "0.04:4.04:1", "-o", tmp_path / "piston.glb")
    assert (told["frames"], told["parts"], told["time"]) == (5, 3, pytest.approx(4.04))
    assert told["file"] == str(tmp_path / "piston.glb")
    low, high = told["bounds"]
    assert (low[2], high[2]) == (0.0, pytest.approx(360.0))  # the piston's foot, and the wheel's top at its highest
    several = grown(PISTON, "--time", "1:2:0.5", "-o", tmp_path / "piston.ply")
    assert several["files"] == [str(tmp_path / f"piston-000{at}.ply") for at in range(3)]
    assert all(Path(name).is_file() for name in several["files"])
    assert grown(PISTON, "--time", "0.1:0.7:0.2")["frames"] == 4


def test_the_turtle_can_be_set(tmp_path: Path) -> None:
    bush = SYSTEMS / "bush.tl"
    sizes = []
    for sides in (6, 12):
        grown(bush, "--time", 2, "--set", f"turtle.sides={sides}", "-o", tmp_path / "bush.stl")
        sizes.append((tmp_path / "bush.stl").stat().st_size - 84)
    assert sizes == [50 * 25 * 4 * sides for sides in (6, 12)]  # 25 cylinders: two caps and a belt of so many pairs
