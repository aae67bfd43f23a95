"""Several hosts at once: what islands do hangs neither on where they live nor on when packets come."""

from __future__ import annotations

import json

import pyarrow.dataset as ds
import pytest
from hosts import run_on_threads

from experiments import bits, write
from orchestrator.archipelago import Conclude, EpochDone
from orchestrator.digest import digest

TOPOLOGIES = ["ring", "complete", {"name": "random", "degree": 2}, "unconnected"]
FINISHED = Conclude("finished", "", settled=True)


def experiment(topology, **changes) -> dict:
    """Nine islands that do not all score alike, exchanging two of their members an epoch."""
    data = bits(epochs=6, epoch=2, channels=[{"topology": topology, "count": 2}], **changes)
    data["islands"]["north"]["count"] = 8
    data["defaults"]["population"] = 6
    data["islands"]["south"]["population"] = 5
    return data


def rows(log, table: str, kind: str | None = None) -> list[dict]:
    found = ds.dataset(log / table).to_table().to_pylist()
    return [row for row in found if kind is None or row["kind"] == kind]


@pytest.mark.parametrize("topology", TOPOLOGIES, ids=str)
def test_barrier_and_dataflow_agree_on_any_number_of_hosts_in_any_weather(tmp_path, topology) -> None:
    data = write(tmp_path, experiment(topology))
    log, end = run_on_threads(tmp_path, data, 1)
    whole = digest(log)
    assert (end, whole[1] > 500) == (FINISHED, True)
    for schedule in ("barrier", "dataflow"):
        for hosts, storm in ((2, None), (3, 1), (4, None), (9, 2)):
            log, end = run_on_threads(tmp_path, data, hosts, f"schedule={schedule}", storm=storm)
            assert (digest(log), end) == (whole, FINISHED), (schedule, hosts)
            assert len({path.name.split("-i")[1] for path in (log / "generations").iterdir()}) == hosts


@pytest.mark.parametrize("topology", TOPOLOGIES[:3], ids=str)
def test_a_replay_of_async_is_the_run_itself_on_any_number_of_hosts(tmp_path, topology) -> None:
    data = write(tmp_path, experiment(topology))
    log, end = run_on_threads(tmp_path, data, 3, "schedule=async", storm=3)
    assert end == FINISHED
    for hosts, storm in ((1, None), (2, None), (4, 5)):
        again, _ = run_on_threads(tmp_path, data, hosts, "schedule=async", storm=storm, replay=log)
        assert digest(again) == digest(log)
        marks = [sorted((row["island"], row["epoch"], row["detail"]) for row in rows(one, "events", "arrivals"))
                 for one in (log, again)]  # fmt: skip
        assert marks[0] == marks[1]


def test_async_takes_each_packet_once_and_none_of_an_epoch_to_come(tmp_path) -> None:
    log, _ = run_on_threads(tmp_path, write(tmp_path, experiment("complete")), 3, "schedule=async", storm=7)
    events = rows(log, "events", "arrivals")
    assert len(events) == 9 * 6
    seen = set()
    for event in events:
        detail = json.loads(event["detail"])
        for channel, source, epoch, size in detail["packets"]:
            assert size in (0, 2)
            mark = (event["island"], channel, source, epoch)
            assert mark not in seen
            seen.add(mark)
            assert epoch < event["epoch"]
        assert (detail["without"] == ["migrants-0"]) == (not detail["packets"] and event["epoch"] > 1)
    sent = {(row["source"], row["target"], row["epoch"], row["id"]) for row in rows(log, "migrations")}
    assert sent


@pytest.mark.parametrize("schedule", ["barrier", "dataflow", "async"])
def test_a_stop_ends_all_logs_at_one_epoch_and_the_run_up_to_it_replays(tmp_path, schedule) -> None:
    data = write(tmp_path, experiment("ring"))

    done = [-1] * 3

    def stop_one(event, hosts) -> None:
        if isinstance(event, EpochDone):
            done[event.host] = event.epoch
        if min(done) >= 4:
            hosts[1].stop()

    settings = (f"schedule={schedule}", "epochs=400")
    log, end = run_on_threads(tmp_path, data, 3, *settings, meanwhile=stop_one)
    assert end == Conclude("stopped", "asked to stop", settled=True)
    last: dict[str, int] = {}
    for row in rows(log, "generations"):
        last[row["island"]] = max(row["epoch"], last.get(row["island"], -1))
    (through,) = set(last.values())
    assert 4 <= through < 400
    assert len(last) == 9
    for table in ("individuals", "migrations", "events"):
        assert max((row["epoch"] or 0 for row in rows(log, table)), default=0) <= through
    forms = {path.name.rpartition("-")[0] for path in (log.parent / "forms").iterdir()}
    assert forms == set(last)
    again, _ = run_on_threads(tmp_path, data, 2, f"schedule={schedule}", f"epochs={through}", replay=log)
    assert digest(again) == digest(log)


def test_a_host_whose_peer_is_silent_says_for_whom_it_waits(tmp_path, monkeypatch) -> None:
    from dataclasses import replace

    from islands.host import Host
    from orchestrator.loading import load_experiment
    from orchestrator.plan import host_plans, make_plan

    loaded = load_experiment(write(tmp_path, experiment("ring")))
    plans = host_plans(loaded, make_plan(loaded), 3, "x", tmp_path)
    host = Host(replace(plans[1], patience=0.05, schedule="dataflow"), post=lambda number, packets: True)
    host.ready()
    assert host.advance(0, 8, -1).epoch == 0
    told = host.advance(4, 8, 0)
    assert (told.epoch, told.stopped, told.summaries) == (0, False, ())
    assert told.trouble == (
        "waited 0.05 s to begin epoch 1 of north-3 without news from island north-2 of host 0 (epoch 0)"
    )
    assert host.advance(5, 8, 0).trouble == told.trouble


def test_islands_go_on_to_the_horizon_while_others_wait(tmp_path) -> None:
    from dataclasses import replace

    from islands.host import Host
    from orchestrator.loading import load_experiment
    from orchestrator.plan import host_plans, make_plan

    data = experiment("ring", seed=3)
    data["channels"] = [{"from": "north-4", "to": "north-5"}, {"topology": "unconnected"}]
    loaded = load_experiment(write(tmp_path, data))
    plans = host_plans(loaded, make_plan(loaded), 3, "x", tmp_path)
    host = Host(replace(plans[1], patience=0.05, schedule="dataflow"), post=lambda number, packets: True)
    host.ready()
    assert host.advance(2, 5, -1).epoch == 2  # north-3, north-4, north-5 live together
    data["channels"] = [{"from": "north-2", "to": "north-3"}, {"topology": "unconnected"}]
    loaded = load_experiment(write(tmp_path, data))
    plans = host_plans(loaded, make_plan(loaded), 3, "x", tmp_path)
    host = Host(replace(plans[1], patience=0.05, schedule="dataflow"), post=lambda number, packets: True)
    host.ready()
    assert host.advance(2, 5, -1).epoch == 0
    assert {number: state.epoch for number, state in host._states.items()} == {3: 0, 4: 5, 5: 5}
