"""The shipped systems: Table 1, the filament's length, continuity, the gait's cycle, the flower's head."""

from __future__ import annotations

import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.special

from genome.timed import Define, Module, Number, TimedSystem, parse_tl
from growth.timed import Derivation, Word, begin, derive

ROOT = Path(__file__).resolve().parents[3]
SYSTEMS = ROOT / "experiments" / "systems"
PHI = (1.0 + math.sqrt(5.0)) / 2.0


def shipped(name: str) -> TimedSystem:
    return parse_tl((SYSTEMS / f"{name}.tl").read_text(encoding="utf-8"), f"{name}.tl")


def word_at(system: TimedSystem, time: float, seed: int = 0) -> list[Module]:
    word = derive(system, time, seed)
    assert isinstance(word, Word), word
    return word.modules()


def value_of(word: list[Module], symbol: str) -> float:
    return next(module.parameters[0] for module in word if module.symbol == symbol)


def as_printed(system: TimedSystem) -> TimedSystem:
    """The profile `paper` of the piston."""
    changed = [replace(one, value=Number(1.0)) if one.name == "PAPER" else one for one in system.defines]
    assert Define("PAPER", Number(1.0)) in changed
    return replace(system, defines=tuple(changed))


@pytest.mark.parametrize("paper", [False, True])
def test_the_piston_is_table_1(paper: bool) -> None:
    piston = as_printed(shipped("piston")) if paper else shipped("piston")
    assert word_at(piston, 0.0) == [Module("piston", (), 0.0)]
    for time, age, mov, bend, turn in ((0.04, 0, 0, 0, 0), (1.04, 1, 50, 0.253, 1.82), (4.04, 0, 0, 0, 0)):
        word = word_at(piston, time)
        rounded = [(m.symbol, tuple(round(value, 2) for value in m.parameters)) for m in word]
        assert rounded == [
            ("mov", (mov,)), ("!", (10,)), ("cC", (60, 1)), ("bend", (round(bend, 2),)), ("!", (2,)), ("cC", (200, 1)),
            ("turn", (turn,)), ("f", (50,)), ("+", (1.57,)), ("[", ()), ("disc", (0, 50)), ("]", ()),
        ]  # fmt: skip
        assert [word[at].age for at in (0, 3, 6)] == pytest.approx([age, age, age])
    exact = word_at(piston, 1.04)
    assert value_of(exact, "bend") == pytest.approx(math.asin(0.25), abs=1e-12)
    assert value_of(exact, "turn") == pytest.approx(math.asin(0.25) + math.pi / 2, abs=1e-12)
    # The table's last row has the angle before the cycle ends: the limit from the left.
    before = word_at(piston, 4.04 - 1e-7)
    assert value_of(before, "turn") == pytest.approx(2.0 * math.pi, abs=1e-6)
    assert value_of(before, "mov") == pytest.approx(0.0, abs=1e-6)


def test_the_printed_piston_breaks_its_linkage_in_the_second_cycle() -> None:
    assert value_of(word_at(shipped("piston"), 5.04), "bend") == pytest.approx(math.asin(0.25))
    assert value_of(word_at(as_printed(shipped("piston")), 5.04), "bend") == pytest.approx(2.0 * math.asin(0.25))


def test_the_piston_moves_without_jumps_and_its_linkage_holds() -> None:
    """The foot of the arm stays on the piston's axis, at the height where the piston is."""
    piston = shipped("piston")
    for time in np.linspace(0.05, 12.0, 97):
        word = word_at(piston, float(time))
        mov, bend, turn = (value_of(word, symbol) for symbol in ("mov", "bend", "turn"))
        angle = 2.0 * math.pi * ((time - 0.04) % 4.0) / 4.0
        assert 200.0 * math.sin(bend) == pytest.approx(50.0 * math.sin(angle), abs=1e-9)
        assert math.cos(turn - bend) == pytest.approx(math.cos(angle), abs=1e-9)
        assert mov == pytest.approx(50.0 * (1.0 - math.cos(angle)), abs=1e-9)


@pytest.mark.parametrize("time", [0.0, 0.4, 1.0, 1.7, 2.0, 3.999, 4.0, 7.25, 12.5])
def test_a_filament_of_cells_grows_as_e_to_the_t_log_phi(time: float) -> None:
    word = word_at(shipped("filament"), time)
    assert math.fsum(module.parameters[0] for module in word) == pytest.approx(
        math.exp(time * math.log(PHI)), rel=1e-12
    )
    fibonacci = [1, 2]
    while len(fibonacci) < 20:
        fibonacci.append(fibonacci[-1] + fibonacci[-2])
    assert len(word) == fibonacci[math.floor(time)]


def test_development_is_continuous_where_cells_divide() -> None:
    filament = shipped("filament")
    for instant in (1.0, 2.0, 5.0):
        before, after = (
            sum(module.parameters[0] for module in word_at(filament, time)) for time in (instant - 1e-9, instant)
        )
        assert after == pytest.approx(before, abs=1e-7)


def test_the_bush_has_five_times_as_many_segments_each_time() -> None:
    word = word_at(shipped("bush"), 5.0)
    assert (len(word), sum(module.symbol == "F" for module in word)) == (7811, 3125)


def test_the_gait_goes_round_in_its_cycle() -> None:
    gait = shipped("gait")
    early, late = word_at(gait, 0.37), word_at(gait, 0.37 + 2.0 * 7)
    assert [m.symbol for m in early] == [m.symbol for m in late]
    legs = sum(m.symbol == "sw" for m in early)
    assert (legs, sum(m.symbol == "sk" for m in early), sum(m.symbol in ("st", "st2") for m in early)) == (10, 10, 10)
    # What the turtle reads is the first parameter of each.
    first, second = ([value for m in word for value in m.parameters[:1]] for word in (early, late))
    assert first == pytest.approx(second, abs=1e-9)


def test_the_joints_of_the_gait_never_jump() -> None:
    start = begin(shipped("gait"))
    assert isinstance(start, Derivation)
    rows = []
    for time in np.arange(0.0, 6.0, 0.005):
        reached = start.at(float(time))
        assert isinstance(reached, Derivation)
        word = reached.word()
        assert isinstance(word, Word)
        rows.append([m.parameters[0] for m in word.modules() if m.symbol in ("sw", "su", "sk", "st", "st2")])
    steps = np.abs(np.diff(np.array(rows), axis=0))
    assert steps.max() < 0.02
    assert np.array(rows).std(axis=0).min() > 0.03


def test_a_segment_of_the_animal_is_ahead_of_the_one_before() -> None:
    gait = shipped("gait")
    swings = [m.parameters[0] for m in word_at(gait, 0.0) if m.symbol == "sw"]
    amplitude = 0.378 * math.pi
    left = [amplitude * math.sin(k * math.pi / 2.5) for k in range(5)]
    assert swings[::2] == pytest.approx(left, abs=1e-12)
    # A leg on the right is half a cycle from that on the left, and turns the other way round.
    assert swings[1::2] == pytest.approx(left, abs=1e-12)


def test_a_flower_forks_and_its_heads_pulsate() -> None:
    flower = shipped("flower")
    word = word_at(flower, 30.0)
    names = [module.symbol for module in word]
    assert (names.count("head"), names.count("petal"), names.count("spike"), names.count("thorn")) == (2, 16, 40, 18)
    heads = [module for module in word if module.symbol == "head"]
    for head in heads:
        assert head.parameters[0] == pytest.approx(
            0.55 * 0.94**6 * 0.9**3 * (1.0 - scipy.special.jv(0, 2.2 * head.age))
        )
    for petal in (at for at, name in enumerate(names) if name == "petal"):
        assert sum(word[at].parameters[0] for at in range(petal - 3, petal)) == pytest.approx(1.0)
    assert word_at(flower, 30.0, 1) != word
    assert word_at(flower, 30.0) == word


WARM = """
import gc
import sys
from pathlib import Path

from numba.core.registry import CPUDispatcher

from genome.timed import parse_tl
from growth.timed import Word, derive
from growth.timed.turtle import draw
from growth.timed.warm import compile_kernels


def compiled():
    kernels = [one for one in gc.get_objects() if isinstance(one, CPUDispatcher)]
    return {(one.__module__, one.__name__): len(one.signatures) for one in kernels}


compile_kernels()
before = compiled()
for path in sorted(Path(sys.argv[1]).glob("*.tl")):
    word = derive(parse_tl(path.read_text(), path.name), 3.0)
    assert isinstance(word, Word)
    draw(word)
after = compiled()
print(sum(before.values()), {name: count for name, count in after.items() if count > before.get(name, 0)})
"""


def test_no_shipped_system_waits_for_the_compiler_once_the_kernels_are_compiled() -> None:
    command = [sys.executable, "-c", WARM, str(SYSTEMS)]
    told = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    count, late = told.stdout.split(" ", 1)
    assert int(count) >= 8  # entries of the kernels; those that they call are not counted once they are kept
    assert late.strip() == "{}"
