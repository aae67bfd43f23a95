"""Runs of block bodies: under load, steered to other strengths, as partners, as pairs, as surroundings of surfaces."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from block_bodies import building

from experiments import Silent, run, write
from genome.errors import InputError
from islands.kinds.meshes import read_mesh_text
from islands.kinds.surface import SurfaceBiology
from islands.store import Store
from orchestrator.digest import digest
from orchestrator.folder import RunFolder, open_run
from orchestrator.loading import load_experiment
from orchestrator.query import ask
from orchestrator.regrow import Nursery, by_id, same
from orchestrator.replay import replay
from orchestrator.resume import resumable, resume
from orchestrator.run import make_backend, run_experiment
from orchestrator.steering.checks import checked
from orchestrator.steering.command import Request
from orchestrator.steering.language import Words, read
from orchestrator.steering.mailbox import post
from orchestrator.steering.structure import structure_of


def everyone(folder: RunFolder) -> list[int]:
    return [identity for (identity,) in ask(folder.log, "select id from individuals order by id").rows]


def all_replay(folder: RunFolder) -> bool:
    nursery = Nursery(folder)
    return all(same(one, nursery.score(one)) for one in by_id(folder, everyone(folder)))


def test_a_run_of_bodies_replays_and_writes_its_best(tmp_path) -> None:
    outcome = run(tmp_path, building())
    folder = open_run(str(outcome.folder))
    assert outcome.status == "finished"
    assert all_replay(folder)
    ((valid, tallest),) = ask(folder.log, "select count(fitness), max(scores['height']) from individuals").rows
    assert valid > 0
    assert tallest > 2
    reasons = {
        error.split(":")[0] for (error,) in ask(folder.log, "select error from individuals where error > ''").rows
    }
    assert reasons <= {"unstable", "budget", "single"}
    assert "unstable" in reasons
    forms = sorted(path.suffix for path in (Path(folder.path) / "forms").iterdir())
    assert {".glb", ".blocks"} == set(forms)
    assert digest(replay(folder, tmp_path / "again", None, (), Silent()).store.at("log")) == digest(folder.log)


# -- strengths ---------------------------------------------------------------------------------------------------------


class Helmsman(Silent):
    """Leaves letters once an epoch is done."""

    def __init__(self, letters: Mapping[int, Request]) -> None:
        self.letters, self.store = dict(letters), None

    def begin(self, plan: Any, experiment: Any, folder: Store) -> None:
        self.store = folder

    def epoch(self, epoch: int, rows: Any) -> None:
        for at in [at for at in self.letters if at <= epoch]:
            post(self.store, self.letters.pop(at), f"2026-01-01T00:00:{at:02d}.000+00:00", "test")


def test_strengths_are_steered_recorded_resumed_and_replayed(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("orchestrator.archipelago.CALL_S", 0.0)
    letters = {
        2: Request("strength", {"values": {"axial": 6}, "islands": ["tower-0"]}),
        7: Request("strength", {"values": {"axial": 90.5, "torsion": 40}}),
    }
    loaded = load_experiment(write(tmp_path, building(epochs=14, epoch=1, checkpoint={"every": 3, "spacing": 0.0})))
    outcome = run_experiment(loaded, make_backend(loaded, None), tmp_path / "runs", None, Helmsman(letters))
    folder = open_run(str(outcome.folder))
    told = [json.loads(line) for line in folder.store.read("commands.jsonl").decode().splitlines()]
    assert [one["outcome"] for one in told] == ["accepted"] * 2
    weak, strong = (one["epoch"] for one in told)
    sql = "select island, epoch, count(*) from evaluations where reason = 'strengths' group by all order by all"
    assert ask(folder.log, sql).rows == [("tower-0", weak, 8), ("tower-0", strong, 8), ("tower-1", strong, 8)]
    # A foot of one block carries all: no body of more than six blocks stands on one in between.
    sql = """select max(scores['blocks'] / scores['ground']) from individuals
             where island = 'tower-0' and valid and epoch between {} and {}"""
    ((heaviest,),) = ask(folder.log, sql.format(weak, strong - 1)).rows
    ((before,),) = ask(folder.log, sql.format(0, weak - 1)).rows
    assert heaviest <= 6 < before
    sql = "select detail from events where kind = 'intervention' and island like 'tower%'"
    events = [json.loads(detail) for (detail,) in ask(folder.log, sql).rows]
    assert [(one["kind"], one["done"]) for one in events] == [("strength", True)] * 3
    assert all_replay(folder)
    assert digest(replay(folder, tmp_path / "again", None, (), Silent()).store.at("log")) == digest(folder.log)
    more = resumable(folder, ("epochs=16",))
    assert resume(folder, more, make_backend(more, None), Silent()).status == "finished"
    folder = open_run(str(folder.store))
    assert digest(replay(folder, tmp_path / "more", None, (), Silent()).store.at("log")) == digest(folder.log)


WRONG = [
    (("axial=0",), "steer strength on tower axial: expected a number above 0 and up to 1e+12, got 0"),
    (("axial=-2",), "steer strength on tower axial: expected a number above 0 and up to 1e+12, got -2.0"),
    (("axail=2",), "steer strength on tower: expected a strength of joints, got 'axail'; did you mean 'axial'?"),
    (("axial=nan",), "steer strength: expected STRENGTH=NUMBER, got 'axial=nan'; for example: strength axial=12"),
    ((), "steer strength: expected STRENGTH=NUMBER, got nothing; for example: strength axial=12"),
]


@pytest.mark.parametrize(("words", "message"), WRONG)
def test_strengths_that_cannot_be_meant_are_told(tmp_path, words, message) -> None:
    structure = structure_of(load_experiment(write(tmp_path, building())))
    with pytest.raises(InputError) as caught:
        checked(read("strength", Words(words)), structure, 3)
    assert str(caught.value) == message


def test_strengths_are_for_islands_of_bodies(tmp_path) -> None:
    data = building()
    data["islands"]["bits"] = {"kind": "bits", "fitness": {"ones": {"goal": "maximise"}}}
    data["channels"].append({"topology": "unconnected", "among": "bits"})
    structure = structure_of(load_experiment(write(tmp_path, data)))
    request = read("strength", Words(("axial=12",)))
    assert checked(request, structure, 3).arguments == {"values": {"axial": 12}, "islands": ["tower-0", "tower-1"]}
    with pytest.raises(InputError, match="steer strength on bits: expected an island of bodies under load, got one"):
        checked(read("strength", Words(("axial=12",), ("bits",))), structure, 3)


# -- partners and pairs ------------------------------------------------------------------------------------------------


def test_two_species_are_scored_as_one_body(tmp_path) -> None:
    fitness = {"height": {"goal": "maximise", "scale": 5}, "meet": {"goal": "maximise"}}
    tower = building()["islands"]["tower"] | {"count": 1, "fitness": fitness}
    beside = tower | {"growth": tower["growth"] | {"start": [4, 0, 0]}}
    channels = [
        {"kind": "partners", "from": "here", "to": "there", "count": 2, "pairing": "several", "pairings": 2},
        {"kind": "partners", "from": "there", "to": "here"},
    ]
    islands = {"here": tower | {"species": "one"}, "there": beside | {"species": "other"}}
    folder = open_run(str(run(tmp_path, building(islands=islands, channels=channels)).folder))
    assert all_replay(folder)
    sql = "select count(*) from individuals where valid and len(partners) > 0"
    assert ask(folder.log, sql).rows[0][0] > 0
    sql = "select min(scores['alone_second']), max(scores['meet']) from individuals where epoch = 0 and valid"
    assert ask(folder.log, sql).rows == [(0.0, 0.0)], "nobody has come yet"
    sql = "select count(*) from evaluations where reason = 'partners' and scores['alone_second'] = 1"
    assert ask(folder.log, sql).rows[0][0] > 0


def test_pairs_breed_travel_and_replay(tmp_path) -> None:
    tower = building()["islands"]["tower"]
    fitness = {"meet": {"goal": "maximise"}, "alone_first": {"goal": "minimise"}}
    growth = tower["growth"] | {"starts": [[0, 0, 0], [4, 0, 0]]}
    islands = {"pair": tower | {"kind": "block_pair", "growth": growth, "fitness": fitness}}
    data = building(islands=islands, channels=[{"topology": "ring", "among": "pair"}])
    folder = open_run(str(run(tmp_path, data).folder))
    assert all_replay(folder)
    rows = ask(folder.log, "select genotype from individuals").rows
    assert all(len(json.loads(genotype)) == 2 for (genotype,) in rows)
    assert ask(folder.log, "select count(*) from migrations where accepted").rows[0][0] > 0
    names = {path.name.split("-best")[1][1:] for path in (Path(folder.path) / "forms").iterdir()}
    assert names == {".glb", "-part1.blocks", "-part2.blocks"}


# -- surroundings ------------------------------------------------------------------------------------------------------


def test_a_body_becomes_a_boundary_that_surfaces_grow_against(tmp_path) -> None:
    skin = {
        "kind": "surface",
        "population": 6,
        "genome": {"length": 120},
        "growth": {
            "steps": 2,
            "scale": 1.2,
            "environment": {"gravity": [0, 0, -0.1]},
            "surroundings": {"scale": 2, "at": [0, 0, 0.5]},
        },
        "fitness": {"size": {"goal": "target", "value": 5}},
    }
    tower = building()["islands"]["tower"] | {"count": 1}
    channels = [{"kind": "surroundings", "from": "tower", "to": "skin"}]
    folder = open_run(str(run(tmp_path, building(islands={"tower": tower, "skin": skin}, channels=channels)).folder))
    sql = "select count(*) from evaluations where island = 'skin' and reason = 'surroundings'"
    assert ask(folder.log, sql).rows[0][0] >= 6
    assert all_replay(folder)
    # Those of the last epoch, grown again: by the log's own forms, none passes through, and without some would.
    nursery = Nursery(folder)
    sql = "select id from individuals where island = 'skin' and valid and epoch = 3 order by id"
    late = by_id(folder, [identity for (identity,) in ask(folder.log, sql).rows])
    assert late
    among = nursery._circumstances.biology("skin", 3)
    alone = nursery.biology("skin", 3)
    assert isinstance(among, SurfaceBiology)
    assert isinstance(alone, SurfaceBiology)
    (solid,) = among._environment.boundaries
    vertices, _ = solid.outline(1.0)
    assert vertices[:, 2].min() == pytest.approx(0.5 - 1), "scaled and moved as the settings say"
    passed = 0
    for one in late:
        genes = among.decode(one.genotype)
        inside = solid.inside(np.ascontiguousarray(among._grown(genes)[2].vertices))
        assert not inside.any()
        passed += bool(solid.inside(np.ascontiguousarray(alone._grown(genes)[2].vertices)).any())
    assert passed == len(late)


def test_a_form_that_is_no_closed_mesh_is_noted_and_changes_nothing() -> None:
    for text, told in (
        ("no", "a mesh as JSON"),
        ('{"vertices":[[0,0,0]],"triangles":[[0,1,2]]}', "triangles of vertices 0 to 0"),
        ('{"vertices":[[0,0,0],[1,0,0],[0,1,0]],"triangles":[[0,1,2]]}', "a closed mesh, got one with 3 open edges"),
        ('{"vertices":[[0,0,null]],"triangles":[]}', "coordinates up to 1e+09"),
        ('{"vertices":[[0,0,0]],"triangles":[]}', "a mesh with faces, got an empty one"),
        ('{"vertices":[[0,0,"x"]],"triangles":[]}', "rows of three numbers"),
    ):
        with pytest.raises(InputError, match="form 7: expected") as caught:
            read_mesh_text(text, "form 7")
        assert told in str(caught.value)
