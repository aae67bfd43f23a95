"""The kind of timed forms: who is valid and why not, what is written, given and kept."""

from __future__ import annotations

import numpy as np
import pytest
from timed_forms import PLANT, plant, timed, timed_spec

from evaluators.timed import TIMED_CRITERIA
from genome.bnf import parse_bnf
from genome.errors import InputError
from genome.timed import parse_tl
from islands.individual import Evaluation
from islands.kinds.meshes import read_mesh_text
from islands.kinds.timed import COSTLY, FORMATS, TimedKind


def scores(found: Evaluation) -> dict[str, float]:
    assert found.error == ""
    return dict(found.scores)


def test_a_form_is_measured_by_every_criterion_at_the_time_at_which_it_is_judged(tmp_path) -> None:
    told = scores(timed(tmp_path, fitness={"parts": {"goal": "maximise"}}).evaluate(plant()))
    assert set(told) == {*TIMED_CRITERIA} - {*COSTLY}
    goals = {name: {"goal": "maximise"} for name in (*COSTLY, "parts")}
    assert set(scores(timed(tmp_path, fitness=goals).evaluate(plant()))) == set(TIMED_CRITERIA)
    assert told["parts"] == 7.0, "three segments, three branches and a sphere"
    early = timed(tmp_path, growth={"time": 2.5}, fitness={"parts": {"goal": "maximise"}}).evaluate(plant())
    assert scores(early)["parts"] == 4.0
    assert early.fitness == 4.0


INVALID = [
    ({}, PLANT.replace("0.9)", "1/(n - 2))"), "expression: division by zero"),
    ({"max_modules": 5}, PLANT, "budget: more modules"),
    ({"max_events": 20}, PLANT, "budget: more births"),
    ({"turtle": {"max_parts": 3}}, PLANT, "budget: "),
    ({}, "axiom A\nA -> A\n", "empty: "),
]


@pytest.mark.parametrize(("growth", "text", "error"), INVALID)
def test_what_does_not_unfold_is_invalid_with_a_reason(tmp_path, growth, text, error) -> None:
    found = timed(tmp_path, growth=growth).evaluate(plant(text))
    assert (found.fitness, found.scores) == (None, ())
    assert found.error.startswith(error)


def test_the_seed_decides_what_is_drawn_at_random(tmp_path) -> None:
    biology = timed(tmp_path)
    text = PLANT.replace("s*0.9", "s*random(0.2, 1)")
    sizes = [scores(biology.evaluate(plant(text, seed)))["size"] for seed in (1, 1, 2)]
    assert sizes[0] == sizes[1] != sizes[2]


def test_forms_are_written_in_every_format_and_the_system_reads_back(tmp_path) -> None:
    biology = timed(tmp_path)
    files = biology.write_forms(plant(), tmp_path / "form", FORMATS, {"run": "test"})
    assert [path.name for path in files] == [f"form.{suffix}" for suffix in FORMATS]
    assert all(path.stat().st_size > 100 for path in files)
    assert parse_tl((tmp_path / "form.tl").read_text()) == plant().system
    usual = biology.write_forms(plant(), tmp_path / "usual", (), {})
    assert [path.suffix for path in usual] == [".glb", ".tl"]
    assert biology.write_forms(plant("axiom F(1/0)\n"), tmp_path / "x", (), {}) == []


def test_surroundings_get_closed_parts_and_others_the_genotype(tmp_path) -> None:
    biology = timed(tmp_path)
    vertices, triangles = read_mesh_text(biology.offer(plant(), "surroundings"), "form")
    assert np.ptp(vertices[:, 2]) > 2.0
    corners = vertices[triangles]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume > 0.0, "fronts look outward"
    assert biology.decode(biology.offer(plant(), "migrants")) == plant()
    with pytest.raises(InputError, match="a form with a closed part, got none"):
        biology.offer(plant("axiom { f(1) +(120) f(1) +(120) f(1) }\n"), "surroundings")


def test_the_system_and_the_grammar_are_kept_and_breed_the_same_again(tmp_path) -> None:
    kept: dict[str, bytes] = {}

    def keep(folder: str, name: str, content: bytes) -> str:
        kept[f"{folder}/{name}"] = content
        (tmp_path / "run" / folder).mkdir(parents=True, exist_ok=True)
        (tmp_path / "run" / folder / name).write_bytes(content)
        return f"{folder}/{name}"

    spec = timed_spec(tmp_path)
    genome, growth = TimedKind().keep_files(spec, keep)
    assert (genome["system"], genome["grammar"]) == ("systems/plant.tl", "grammars/plant.bnf")
    assert growth == spec.growth
    assert kept["systems/plant.tl"].decode() == PLANT
    assert "Successor.stem" in parse_bnf(kept["grammars/plant.bnf"].decode(), "plant.bnf").rules
    from dataclasses import replace

    again = TimedKind().build(replace(spec, genome=genome, base=str(tmp_path / "run")), lambda: 0.0)
    first, second = timed(tmp_path), again
    family = [[one.random(np.random.default_rng(seed)) for seed in range(6)] for one in (first, second)]
    assert family[0] == family[1]
    mutants = [[one.mutate(each, np.random.default_rng(7)) for each in family[0]] for one in (first, second)]
    assert mutants[0] == mutants[1]
    # Kept once more, as of a resumed run, they are the same files.
    assert TimedKind().keep_files(replace(spec, genome=genome, base=str(tmp_path / "run")), keep)[0] == genome


def test_a_shipped_system_is_kept_by_its_name(tmp_path) -> None:
    kept = {}
    spec = timed_spec(tmp_path, genome={"system": "gait", "numbers": {}, "productions": []})
    genome, _ = TimedKind().keep_files(
        spec, lambda folder, name, content: kept.setdefault(f"{folder}/{name}", name) and f"{folder}/{name}"
    )
    assert genome["system"] == "systems/gait.tl"
    assert genome["grammar"] is None, "nothing varies, and nothing is written"
