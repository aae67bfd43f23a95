"""Runs of timed forms: the same on any hosts and after a resume, replayed, steered; and mistakes in their settings."""

from __future__ import annotations

import copy
import json
import re
from pathlib import Path
from typing import Any

import pytest
from helm import Helmsman
from hosts import run_on_threads
from refusals import refused
from timed_forms import PLANT, garden

from experiments import Silent, run, write
from genome.timed.genotype import TimedGenotype, decode_genotype, encode_genotype
from genome.timed.variation import differs_in_production
from orchestrator.digest import digest
from orchestrator.folder import RunFolder, open_run
from orchestrator.loading import load_experiment
from orchestrator.query import ask
from orchestrator.regrow import Nursery, by_id, same
from orchestrator.replay import replay
from orchestrator.resume import resumable, resume
from orchestrator.run import make_backend, run_experiment
from orchestrator.steering.command import Request

DONE = "select detail from events where kind = 'intervention' and island = 'bed-0'"


@pytest.fixture(scope="module")
def lived(tmp_path_factory) -> RunFolder:
    folder = tmp_path_factory.mktemp("garden")
    outcome = run(folder, garden(folder))
    assert outcome.status == "finished"
    return open_run(str(outcome.folder))


def test_a_run_replays_and_writes_its_best(lived, tmp_path) -> None:
    nursery = Nursery(lived)
    everyone = [identity for (identity,) in ask(lived.log, "select id from individuals order by id").rows]
    assert len(everyone) > 100
    assert all(same(one, nursery.score(one)) for one in by_id(lived, everyone))
    forms = sorted(path.suffix for path in (lived.path / "forms").iterdir())
    assert set(forms) == {".glb", ".tl"}
    kept = [lived.store.read(f"{folder}/plant.{suffix}") for folder, suffix in (("systems", "tl"), ("grammars", "bnf"))]
    assert kept[0].decode() == PLANT
    assert b"<Successor.stem>" in kept[1]
    assert digest(replay(lived, tmp_path / "again", None, (), Silent()).store.at("log")) == digest(lived.log)


def test_a_fifth_of_the_offspring_at_least_differ_in_a_production(lived) -> None:
    sql = "select id, parents, genotype, valid, origin from individuals"
    rows = ask(lived.log, sql).rows
    told = {identity: decode_genotype(genotype) for identity, _, genotype, _, _ in rows}
    born = [(identity, parents) for identity, parents, _, valid, _ in rows if valid and parents]
    assert len(born) > 50
    share = sum(all(differs_in_production(told[one], told[parent]) for parent in parents) for one, parents in born)
    assert share >= len(born) / 5


@pytest.mark.parametrize("hosts", [1, 2])
def test_the_log_is_the_same_on_any_hosts(lived, tmp_path, hosts) -> None:
    log, outcome = run_on_threads(tmp_path, write(tmp_path, garden(tmp_path)), hosts)
    assert outcome.status == "finished"
    assert digest(log) == digest(lived.log)


def test_a_resumed_run_is_the_run_itself(lived, tmp_path) -> None:
    outcome = run(tmp_path, garden(tmp_path, epochs=2))
    folder = open_run(str(outcome.folder))
    (tmp_path / "plant.tl").unlink()
    loaded = resumable(folder, ("epochs=4",))
    assert resume(folder, loaded, make_backend(loaded, None), Silent()).status == "finished"
    assert digest(open_run(str(folder.store)).log) == digest(lived.log)


def test_a_persons_choice_breeds(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("orchestrator.archipelago.CALL_S", 0.0)
    chosen = TimedGenotype(decode_genotype('{"format":1,"seed":0,"system":{"format":1,"axiom":"F(0.1)"}}').system, 9)
    letters = {
        2: [Request("insert", {"genotype": encode_genotype(chosen), "islands": ["bed-0"]})],
        6: [Request("weight", {"values": {"size": 0.5}})],
    }
    data = garden(tmp_path, epochs=12, epoch=1, checkpoint={"every": 3, "spacing": 0.0})
    loaded = load_experiment(write(tmp_path, data))
    outcome = run_experiment(loaded, make_backend(loaded, None), tmp_path / "runs", None, Helmsman(letters))
    folder = open_run(str(outcome.folder))
    commands = [json.loads(line) for line in folder.store.read("commands.jsonl").decode().splitlines()]
    assert [one["outcome"] for one in commands] == ["accepted"] * 2
    ((identity, genotype),) = ask(folder.log, "select id, genotype from individuals where origin = 'intervention'").rows
    assert decode_genotype(genotype) == chosen
    told = [json.loads(one) for (one,) in ask(folder.log, DONE).rows]
    assert [(one["kind"], one["done"]) for one in told] == [("insert", True), ("weight", True)]
    assert identity > 0
    assert digest(replay(folder, tmp_path / "again", None, (), Silent()).store.at("log")) == digest(folder.log)


def chosen_for(folder: Path, letters: dict[int, list[Request]]) -> RunFolder:
    folder.mkdir()
    loaded = load_experiment(write(folder, garden(folder, epochs=14, epoch=1)))
    outcome = run_experiment(loaded, make_backend(loaded, None), folder / "runs", None, Helmsman(letters))
    return open_run(str(outcome.folder))


def test_whom_a_person_chooses_is_the_parent_of_many(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("orchestrator.archipelago.CALL_S", 0.0)
    before = chosen_for(tmp_path / "before", {})
    sql = "select id from individuals where generation = 0 and island = 'bed-0' and valid order by fitness desc limit 1"
    ((identity,),) = ask(before.log, sql).rows
    choice = {"id": identity, "islands": ["bed-0"]}
    after = chosen_for(tmp_path / "after", {0: [Request("lock", choice), Request("promote", choice)]})
    assert [json.loads(one)["done"] for (one,) in ask(after.log, DONE).rows] == [True, True]
    sql = f"select count(*) from individuals where list_contains(parents, {identity}) and island = 'bed-0'"
    ((few,),), ((many,),) = (ask(folder.log, sql).rows for folder in (before, after))
    assert many > 2 * few


# -- mistakes ----------------------------------------------------------------------------------------------------------


def sown(data: dict[str, Any], key: str, value: Any) -> dict[str, Any]:
    data = copy.deepcopy(data)
    section = data["islands"]["bed"]
    *keys, last = key.split(".")
    for one in keys:
        section = section[one]
    section[last] = value
    return data


MISTAKES = [
    (
        "genome.numbers",
        {"LIVE": [1, 2]},
        "genome.numbers.LIVE: expected a define of plant.tl, got 'LIVE'; did you mean",
    ),
    ("genome.numbers", {"LIFE": [2, 1]}, "genome.numbers.LIFE.*: expected the least and the most: .*write the smaller"),
    (
        "genome.numbers",
        {"LIFE": {"bounds": [0.2, 0.8], "whole": True}},
        "genome.numbers.LIFE: expected bounds with a whole number",
    ),
    ("genome.numbers", {"LIFE": 3}, "genome.numbers.LIFE: expected the least and the most, such as"),
    ("genome.numbers", {"LIFE": [1, 2, 3]}, "genome.numbers.LIFE.*: expected the least and the most"),
    (
        "genome.numbers",
        {"LIFE": {"bounds": [1, 2], "hole": True}},
        "genome.numbers.LIFE.hole: expected a known key, got 'hole'; did you mean",
    ),
    ("genome.system", "plnt.tl", "genome.system: expected a timed system's file, got 'plnt.tl': no such file"),
    (
        "genome.system",
        "flour",
        "genome.system: expected a timed system's name or file, got 'flour'; did you mean 'flower'",
    ),
    ("genome.system", "garden.yaml.tl", "genome.system: expected a timed system's file"),
    ("genome.system", "broken.tl", "genome.system: broken.tl:1:9: expected a '\\]' for this '\\['"),
    ("genome.grammar", "g.bnf", "genome.grammar: expected a grammar's file, got 'g.bnf'"),
    ("genome.grammar", "bad.bnf", "genome.grammar: bad.bnf:1:1: expected"),
    (
        "genome.grammar",
        "odd.bnf",
        "genome.grammar: expected <Successor> to write what the language takes, got 'seg \\('",
    ),
    ("genome.productions", ["leaf"], "genome.productions: expected symbols with a production in plant.tl, got 'leaf'"),
    ("genome.protected", ["stm"], "genome.protected: .*did you mean 'stem'"),
    ("genome.literals", 0.5, "genome.literals: expected greater than or equal to 1, got 0.5"),
    ("genome.mutations", {"grow": 1}, "genome.mutations.grow: expected a known key"),
    ("genome.sistem", "x", "genome.sistem: expected a known key, got 'sistem'; did you mean 'system'"),
    ("growth.time", 0, "growth.time: expected"),
    ("fitness", {"sise": {"goal": "maximise"}}, "fitness.sise: expected a criterion, got 'sise'; did you mean 'size'"),
]


@pytest.mark.parametrize(("key", "value", "message"), MISTAKES)
def test_a_mistake_is_refused_in_a_line_that_names_the_key(tmp_path, key, value, message) -> None:
    (tmp_path / "broken.tl").write_text("axiom A [ B\n")
    (tmp_path / "bad.bnf").write_text("A -> B\n")
    (tmp_path / "odd.bnf").write_text("<Successor> ::= seg '('\n")
    for line in refused(tmp_path, sown(garden(tmp_path), key, value)):
        assert re.search(rf"islands\.bed\.{message}", line), line
