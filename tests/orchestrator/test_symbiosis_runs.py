"""Runs of enclosures, spaces and routes: partners, forms of all species, sites that evolve, any number of hosts."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from block_bodies import building
from hosts import run_on_threads
from rooms import house

from experiments import Silent, run, write
from growth.blocks import grow_cells
from islands.kinds.symbiosis import SymbiosisBiology
from orchestrator.digest import digest
from orchestrator.folder import RunFolder, open_run
from orchestrator.query import ask
from orchestrator.regrow import Nursery, best, by_id, same
from orchestrator.replay import replay


@pytest.fixture(scope="module")
def lived(tmp_path_factory) -> RunFolder:
    """The run of the house."""
    outcome = run(tmp_path_factory.mktemp("house"), house())
    assert outcome.status == "finished"
    return open_run(str(outcome.folder))


def everyone(folder: RunFolder, where: str = "true") -> list:
    sql = f"select id from individuals where {where} order by id"
    return by_id(folder, [identity for (identity,) in ask(folder.log, sql).rows])


def test_rows_name_the_partners_and_all_replays(lived, tmp_path) -> None:
    nursery = Nursery(lived)
    assert all(same(one, nursery.score(one)) for one in everyone(lived))
    sql = (
        "select epoch > 0, species like 'space%', min(len(partners)), max(len(partners)) from individuals group by all"
    )
    told = {row[:2]: row[2:] for row in ask(lived.log, sql).rows}
    assert told[False, False] == told[False, True] == (0, 0), "nobody has come yet"
    assert told[True, False] == (1, 1)
    assert told[True, True] == (2, 2)
    sql = "select max(scores['symbiotic']) from individuals where epoch = {}"
    assert ask(lived.log, sql.format(0)).rows == [(0.0,)]
    assert ask(lived.log, sql.format(3)).rows[0][0] > 0
    assert digest(replay(lived, tmp_path / "again", None, (), Silent()).store.at("log")) == digest(lived.log)


def voxels(path: Path) -> set[tuple[int, ...]]:
    """The cells of a grid that an enclosure and a space has, each with which of them."""
    with np.load(path) as arrays:
        places = np.argwhere(arrays["grid"])
        return {(*(place + arrays["origin"]), arrays["grid"][tuple(place)]) for place in places}


def test_forms_show_both_species_at_the_end_and_later(lived, tmp_path) -> None:
    forms = Path(lived.path) / "forms"
    scenes = {path.name: trimesh.load_scene(path) for path in sorted(forms.glob("*.glb"))}
    assert len(scenes) >= 4
    for name, scene in scenes.items():
        assert set(scene.graph.nodes_geometry) == {"enclosure", "space"}, name
        partners = [int(one) for one in scene.metadata["partners"].split(", ")]
        others = "space" if name.startswith("walls") else "enclosure"
        assert {by_id(lived, [one])[0].island.split("-")[0] for one in partners} == {
            "rooms" if others == "space" else "walls"
        }
    # Of one bred with partners the log's are shown: its own cells and theirs, and no others.
    nursery = Nursery(lived)
    one = next(row for row in everyone(lived, "epoch = 3 and valid and island = 'walls-1'") if row.partners)
    (path,) = nursery.write_forms(one, tmp_path, ("npz",))
    (other,) = by_id(lived, one.partners)
    own, theirs = (_cells(nursery, row) for row in (one, other))
    assert voxels(path) == {(*cell, (cell in own) + 2 * (cell in theirs)) for cell in own | theirs}
    alone = next(row for row in everyone(lived, "epoch = 0 and valid and island = 'rooms-0'"))
    (path,) = nursery.write_forms(alone, tmp_path, ("npz",))
    assert voxels(path) == {(*cell, 2) for cell in _cells(nursery, alone)}
    assert best(lived, 1)[0].fitness is not None


def _cells(nursery: Nursery, row) -> set[tuple[int, ...]]:
    biology = nursery.biology(row.island)
    assert isinstance(biology, SymbiosisBiology)
    return {tuple(cell) for cell in biology.grown(biology.decode(row.genotype)).tolist()}


def test_the_digest_is_the_same_on_any_number_of_hosts(lived, tmp_path) -> None:
    data = write(tmp_path, house())
    for hosts in (1, 2):
        log, _ = run_on_threads(tmp_path, data, hosts)
        assert digest(log) == digest(lived.log), hosts


def three(**changes) -> dict:
    """A route between one island of walls and one of rooms, each shown to each."""
    data = house(**changes)
    data["defaults"]["count"] = 1
    data["islands"]["ways"] = {"kind": "route", "fitness": {"route": {"goal": "maximise"}}}
    pairs = [("rooms", "walls"), ("walls", "rooms"), ("rooms", "ways"), ("walls", "ways"), ("ways", "rooms")]
    data["channels"] = [{"kind": "partners", "from": one, "to": other} for one, other in pairs]
    return data


def test_a_route_is_scored_with_both(tmp_path) -> None:
    folder = open_run(str(run(tmp_path, three()).folder))
    nursery = Nursery(folder)
    late = everyone(folder, "epoch = 3 and valid and island = 'ways'")
    assert late
    assert all(len(one.partners) == 2 and same(one, nursery.score(one)) for one in late)
    assert all(dict(one.scores)[f"{name}_cells"] > 0 for one in late for name in ("enclosure", "space", "route"))
    assert all(len(one.partners) == 2 for one in everyone(folder, "epoch = 3 and island = 'rooms'"))
    scene = trimesh.load_scene(Path(folder.path) / "forms" / "ways-best1.glb")
    assert set(scene.graph.nodes_geometry) == {"enclosure", "space", "route"}


def test_an_evolved_body_is_a_site_that_no_wall_enters(tmp_path) -> None:
    data = house()
    data["defaults"]["count"] = 1
    tower = building()["islands"]["tower"]["growth"] | {"start": [1, 0, 0]}
    data["islands"]["tower"] = {"kind": "blocks", "growth": tower, "fitness": {"height": {"goal": "maximise"}}}
    data["channels"] = [
        {"kind": "partners", "from": "rooms", "to": "walls"},
        {"kind": "partners", "from": "walls", "to": "rooms"},
        {"kind": "surroundings", "from": "tower", "to": "walls"},
    ]
    folder = open_run(str(run(tmp_path, data).folder))
    nursery = Nursery(folder)
    late = everyone(folder, "epoch = 3 and valid and island = 'walls'")
    assert late
    assert all(same(one, nursery.score(one)) for one in late)
    among, alone = nursery._circumstances.biology("walls", 3), nursery.biology("walls", 3)
    assert isinstance(among, SymbiosisBiology)
    assert isinstance(alone, SymbiosisBiology)
    (solid,) = among._site.environment.boundaries
    entered = 0
    for one in late:
        genotype = among.decode(one.genotype)
        assert not solid.inside(among.grown(genotype).astype(np.float64)).any()
        entered += bool(solid.inside(grow_cells(genotype, alone._growth).astype(np.float64)).any())
    assert entered, "without the site some would"
    sql = "select count(*) from evaluations where island = 'walls' and reason = 'surroundings'"
    assert ask(folder.log, sql).rows[0][0] > 0


def test_a_run_of_which_all_are_invalid_ends_and_says_so(tmp_path) -> None:
    data = house(epochs=1)
    data["islands"]["rooms"]["growth"] = {"least": 2000, "max_blocks": 2000}
    outcome = run(tmp_path, data)
    folder = open_run(str(outcome.folder))
    assert outcome.status == "finished"
    sql = """select count(*), count(fitness), min(error like 'small: %' or error like 'budget: %')
             from individuals where species like 'space%'"""
    ((born, valid, told),) = ask(folder.log, sql).rows
    assert (valid, told) == (0, True)
    assert born > 0
    assert json.loads((Path(folder.path) / "manifest.json").read_text(encoding="utf-8"))["status"] == "finished"
