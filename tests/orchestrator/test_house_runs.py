"""Runs of rooms, zones and houses: levels in turn and together, the same on any hosts, resumed and replayed."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hosts import run_on_threads

from experiments import Silent, run, write
from orchestrator.digest import digest
from orchestrator.folder import RunFolder, open_run
from orchestrator.loading import load_experiment
from orchestrator.query import ask
from orchestrator.regrow import Nursery, by_id, same
from orchestrator.resume import resumable, resume
from orchestrator.run import make_backend

SMALL: dict[str, Any] = {"population": 8, "epochs": 2, "rise": 4}


def small(**brief: Any) -> dict[str, Any]:
    rooms = {"hall": {"cells": 3}, "living": {"cells": 6}, "bed": {"cells": 4}, "bath": {"cells": 2}}
    whole = {
        "rooms": rooms,
        "zones": {"day": ["hall", "living"], "night": ["bed", "bath"]},
        "adjacencies": [["hall", "living"], ["hall", "bed"], ["bed", "bath"]],
        "entrance": "hall",
        "room": SMALL,
        "zone": SMALL,
        "house": SMALL,
        **brief,
    }
    return {"name": "small", "seed": 5, "epoch": 2, "backend": "inline", "brief": whole}


def folder_of(tmp_path, data: dict[str, Any], *overrides: str, name: str | None = None) -> RunFolder:
    return open_run(str(run(tmp_path, data, *overrides, name=name).folder))


def rows(folder: RunFolder, sql: str) -> list[tuple[Any, ...]]:
    return ask(folder.log, sql).rows


def test_levels_in_turn_breed_one_after_the_other(tmp_path) -> None:
    folder = folder_of(tmp_path, small(levels="in_turn"))
    sql = """select species[:4] as level, min(epoch), max(epoch), min(generation), max(generation)
             from individuals group by all order by all"""
    assert rows(folder, sql) == [("hous", 5, 6, 0, 4), ("room", 0, 2, 0, 4), ("zone", 3, 4, 0, 4)]
    carried = rows(folder, "select distinct channel, epoch from migrations order by all")
    assert carried == [("to-day", 3), ("to-house", 5), ("to-night", 3)]
    waits = rows(folder, "select island from events where kind = 'waiting' order by all")
    assert waits == [("day",), ("house",), ("night",)]


def test_levels_together_take_better_parts_as_they_come(tmp_path) -> None:
    folder = folder_of(tmp_path, small(), "epochs=5")
    assert rows(folder, "select min(epoch) from individuals where island = 'house'") == [(2,)]
    risen = rows(folder, "select count(distinct epoch) from migrations where channel = 'to-house' and accepted")
    assert risen[0][0] >= 3
    parts = rows(
        folder,
        """select count(*) from individuals as one, unnest(components) as parts(part)
           where one.island = 'house' and part not in (select id from individuals where island in ('day', 'night'))""",
    )
    assert parts == [(0,)]
    asked = rows(folder, "select count(*) from individuals where island = 'living' and len(partners) > 0")
    assert asked[0][0] > 0
    nursery = Nursery(folder)
    everyone = [one for (one,) in rows(folder, "select id from individuals order by id")]
    assert all(same(one, nursery.score(one)) for one in by_id(folder, everyone))


def test_the_log_is_the_same_on_any_hosts(tmp_path) -> None:
    data = small()
    inline = folder_of(tmp_path, data, "epochs=4", name="inline")
    path = write(tmp_path, {**data, "epochs": 4, "schedule": "dataflow"}, "threads.yaml")
    for hosts in (1, 2):
        log, _ = run_on_threads(tmp_path, path, hosts)
        assert digest(log) == digest(inline.log), hosts


@pytest.mark.parametrize("levels", ["in_turn", "together"])
def test_a_run_that_goes_on_from_where_islands_wait_is_the_same(tmp_path, levels: str) -> None:
    data = small(levels=levels)
    whole = folder_of(tmp_path, data, "epochs=6", name="whole")
    begun = folder_of(tmp_path, data, "epochs=1", name="begun")
    more = resumable(begun, ("epochs=6",))
    assert resume(begun, more, make_backend(more, None), Silent()).status == "finished"
    assert digest(open_run(str(begun.store)).log) == digest(whole.log)


def test_a_run_too_short_for_its_upper_levels_ends_well_and_says_so(tmp_path, capsys) -> None:
    data = small(levels="in_turn")
    loaded = load_experiment(write(tmp_path, data), ("epochs=3",))
    assert any("comes too late" in note for note in loaded.notes)
    folder = folder_of(tmp_path, data, "epochs=3")
    assert folder.manifest()["status"] == "finished"
    assert rows(folder, "select count(*) from individuals where island = 'house'") == [(0,)]
    forms = {path.name.split("-best")[0] for path in (tmp_path / "runs").rglob("*-best*")}
    assert "house" not in forms
    assert {"living", "day"} <= forms


def test_the_resolved_copy_holds_the_islands_and_runs_again(tmp_path) -> None:
    folder = folder_of(tmp_path, small(), "epochs=2")
    again = load_experiment(folder.experiment)
    assert list(again.experiment.islands) == ["hall", "living", "bed", "bath", "day", "night", "house"]
    assert "brief" not in json.loads(json.dumps(again.data()))
