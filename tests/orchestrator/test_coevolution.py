"""Coevolution with its remedies and measures: the same on any number of hosts, and after a run was broken off."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pyarrow.dataset as ds
import pytest
import yaml
from hosts import BrokenOffError, resume_on_threads, run_on_threads

from experiments import run, write
from orchestrator.digest import digest
from orchestrator.folder import open_run
from orchestrator.messages import EpochDone
from orchestrator.query import as_rows, ask
from orchestrator.regrow import Nursery, by_id, same

MIXED = {"kind": "partners", "pairing": "mixed", "pairings": 5, "count": 3, "archive": 4, "measures": True}

RANDOM = {**MIXED, "pairing": "random", "pairings": 2, "every": 4}


def arms(**algorithm) -> dict:
    """Hosts that flee from guests, and guests that follow, two islands of each; migrants among the hosts."""
    return {
        "name": "arms",
        "seed": 5,
        "epochs": 8,
        "epoch": 2,
        "backend": "inline",
        "defaults": {
            "kind": "bits", "count": 2, "population": 8, "genome": {"length": 12},
            "algorithm": {"sharing": "competitive", "mutation": 0.5, **algorithm},
        },
        "islands": {
            "host": {"species": "host", "fitness": {"agreement": {"goal": "minimise"}}},
            "guest": {"species": "guest", "fitness": {"agreement": {"goal": "maximise"}}},
        },
        "channels": [
            {"topology": "ring", "among": "host", "count": 2},
            {"name": "to-hosts", "from": "guest", "to": "host", **MIXED},
            # An epoch without new ones leaves a deme as it was scored, outcomes and all.
            {"name": "to-guests", "from": "host", "to": "guest", **RANDOM},
        ],
    }  # fmt: skip


def told(log: Path, kind: str = "coevolution") -> list[tuple]:
    found = [row for row in ds.dataset(log / "events").to_table().to_pylist() if row["kind"] == kind]
    return sorted((row["epoch"], row["island"], row["detail"]) for row in found)


@pytest.mark.parametrize("algorithm", [{}, {"name": "plus"}, {"name": "parents", "longest_life": 3}], ids=str)
def test_digest_and_measures_are_the_same_on_any_number_of_hosts(tmp_path, algorithm) -> None:
    data = write(tmp_path, arms(**algorithm))
    alone = run(tmp_path, arms(**algorithm)).folder / "log"
    rows = told(alone)
    assert [row[:2] for row in rows] == [
        (epoch, f"{name}-{n}") for epoch in range(1, 9) for name in ("guest", "host") for n in (0, 1)
    ]
    for hosts, storm, schedule in ((1, None, "barrier"), (2, 1, "barrier"), (4, 2, "dataflow")):
        log, outcome = run_on_threads(tmp_path, data, hosts, f"schedule={schedule}", storm=storm)
        assert (outcome.status, digest(log)) == ("finished", digest(alone))
        assert told(log) == rows


@pytest.mark.parametrize("sharing", ["competitive", "none"])
def test_a_run_that_was_broken_off_goes_on_to_the_same_digest_and_measures(tmp_path, sharing) -> None:
    data = write(tmp_path, arms(sharing=sharing))
    log, _ = run_on_threads(tmp_path / "whole", data, 2)

    def breaking(event, backend) -> None:
        if isinstance(event, EpochDone) and event.epoch >= 5:
            raise BrokenOffError

    with pytest.raises(BrokenOffError):
        run_on_threads(tmp_path / "part", data, 2, meanwhile=breaking)
    again, outcome = resume_on_threads(tmp_path / "part" / "arms", 3)
    assert outcome.status == "finished"
    assert ask(again, "select count(*) from events where kind = 'resume'").rows == [(1,)]
    assert digest(again) == digest(log)
    assert told(again) == told(log)


def test_a_host_that_is_lost_changes_neither(tmp_path) -> None:
    data = write(tmp_path, arms())
    log, _ = run_on_threads(tmp_path / "whole", data, 1)
    lost = []

    def losing(event, backend) -> None:
        if isinstance(event, EpochDone) and event.epoch >= 5 and not lost:
            lost.append(event.host)
            backend.lose(event.host)

    again, outcome = run_on_threads(tmp_path / "lost", data, 3, storm=1, meanwhile=losing)
    assert (outcome.status, len(lost)) == ("finished", 1)
    assert ask(again, "select count(*) from events where kind = 'recovery'").rows == [(1,)]
    assert (digest(again), told(again)) == (digest(log), told(log))


def test_an_async_run_replays_to_the_same_digest_and_measures(tmp_path) -> None:
    data = write(tmp_path, arms())
    settings = ("schedule=async", "checkpoint.every=99")
    log, _ = run_on_threads(tmp_path, data, 4, *settings, storm=6)
    assert digest(log) != digest(run(tmp_path, arms()).folder / "log")
    again, _ = run_on_threads(tmp_path, data, 2, *settings, replay=log)
    assert (digest(again), told(again), told(again, "late")) == (digest(log), told(log), told(log, "late"))
    assert told(log, "late")


def test_every_individual_replays_with_the_partners_that_it_was_mixed_with(tmp_path) -> None:
    folder = open_run(str(run(tmp_path, arms()).folder))
    nursery = Nursery(folder)
    ids = [identity for (identity,) in ask(folder.log, "select id from individuals order by id").rows]
    assert all(same(logged, nursery.score(logged)) for logged in by_id(folder, ids))
    sql = "select distinct epoch, len(partners) from individuals where species = 'host' order by all"
    # The best, two others shown, and past ones, of which there are none at first.
    assert ask(folder.log, sql).rows == [(0, 0), (1, 5), (2, 5), (3, 5), (4, 5), (5, 5), (6, 5), (7, 5), (8, 5)]


def test_a_champion_s_score_is_that_of_the_members_of_the_log(tmp_path) -> None:
    log = run(tmp_path, arms()).folder / "log"
    genes = dict(ask(log, "select id, genotype from individuals").rows)
    for epoch, island, detail in told(log):
        one = json.loads(detail)
        sign = 1 if island.startswith("guest") else -1
        for identity, value in one["archive"]["each"]:
            unlike = sum(a != b for a, b in zip(genes[one["champion"]], genes[identity], strict=True))
            assert value == sign * (1 - unlike / 12)
        assert one["archive"]["number"] <= min(epoch - 1, 4)
    assert any(json.loads(detail)["archive"]["number"] == 4 for *_, detail in told(log))


def test_settings_left_alone_are_those_of_before(tmp_path) -> None:
    plain = arms(sharing="none")
    for channel in plain["channels"][1:]:
        channel |= {"pairing": "several", "pairings": 2, "measures": False, "archive": 0}
    bare = json.loads(json.dumps(plain))
    for channel in bare["channels"][1:]:
        del channel["measures"], channel["archive"]
    del bare["defaults"]["algorithm"]["sharing"]
    logs = []
    for number, data in enumerate((plain, bare)):
        (tmp_path / str(number)).mkdir()
        logs.append(run(tmp_path / str(number), data).folder / "log")
    assert digest(logs[0]) == digest(logs[1])
    # As drawn before there was any sharing of fitness.
    assert digest(logs[1])[0] == "79ece7d3519fd4c793de8ee78dab38a407e66dc09081f61dfee57bd5f0e53e96"
    assert told(logs[1]) == []


# -- what the documentation says ---------------------------------------------------------------------------------------

ROOT = Path(__file__).resolve().parents[2]


def documented() -> list[str]:
    return re.findall(r"```sql\n(.*?)```", (ROOT / "docs" / "coevolution.md").read_text(encoding="utf-8"), re.DOTALL)


def test_the_documented_query_draws_each_trouble_from_the_log(tmp_path) -> None:
    data = yaml.safe_load((ROOT / "experiments" / "arms_race.yaml").read_text(encoding="utf-8"))
    # A third pair of which one side cannot change: it has nothing to choose from, and no way on.
    dead = {"genome": {"length": 24, "flip": 0}, "population": 8, "algorithm": {"elite": 1, "crossover": 0}}
    data["islands"] |= {"dead-host": {"species": "dead-host", "population": 8}, "dead-parasite": dead}
    data["channels"] += [
        {"kind": "partners", "from": f"dead-{one}", "to": f"dead-{other}", "archive": 5, "measures": True}
        for one, other in (("host", "parasite"), ("parasite", "host"))
    ]
    log = run(tmp_path, data).folder / "log"
    troubles, queen, _ = documented()
    rows = {row["island"]: row for row in as_rows(ask(log, troubles))}
    assert all(row["epochs"] == 20 for row in rows.values())
    plain, hall = ([rows[f"{pair}-{end}"] for end in ("host", "parasite")] for pair in ("plain", "hall"))
    assert min(row["cycling"] for row in plain) > 0.5 > 0.1 > max(row["cycling"] for row in hall)
    assert max(row["archive_score"] for row in plain) < 0.5 < min(row["archive_score"] for row in hall)
    beaten = rows["dead-parasite"]
    assert (beaten["distinct_fitness"], beaten["spread"]) == (1 / 8, 0.0)
    assert beaten["stalled"] > 30
    drawn = as_rows(ask(log, queen))
    assert {row["fitness"] for row in drawn} == {-1.0, 0.0, 1.0}
    assert all(row["born"] < row["epoch"] for row in drawn)


def test_the_documented_query_tells_who_was_late(tmp_path) -> None:
    log, _ = run_on_threads(tmp_path, write(tmp_path, arms()), 4, "schedule=async", "checkpoint.every=99", storm=3)
    rows = ask(log, documented()[2]).rows
    assert sum(times for *_, times in rows) == len(told(log, "late")) > 0
