"""Several hosts at once: what islands do hangs neither on where they live nor on when packets come."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor, wait

import pyarrow.dataset as ds
import pytest
from hosts import BrokenOffError, resume_on_threads, run_on_threads

from experiments import bits, write
from orchestrator.digest import digest
from orchestrator.messages import EpochDone, HostFinished, HostReady, PartSaved

TOPOLOGIES = ["ring", "complete", {"name": "random", "degree": 2}, "unconnected"]


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
    log, outcome = run_on_threads(tmp_path, data, 1)
    whole = digest(log)
    assert (outcome.status, whole[1] > 500) == ("finished", True)
    for schedule in ("barrier", "dataflow"):
        for hosts, storm in ((2, None), (3, 1), (4, None), (9, 2)):
            log, outcome = run_on_threads(tmp_path, data, hosts, f"schedule={schedule}", storm=storm)
            assert (digest(log), outcome.status) == (whole, "finished"), (schedule, hosts)
            assert len({path.name.split("-i")[1] for path in (log / "generations").iterdir()}) == hosts


@pytest.mark.parametrize("topology", TOPOLOGIES[:3], ids=str)
def test_a_replay_of_async_is_the_run_itself_on_any_number_of_hosts(tmp_path, topology) -> None:
    data = write(tmp_path, experiment(topology))
    log, outcome = run_on_threads(tmp_path, data, 3, "schedule=async", storm=3)
    assert outcome.status == "finished"
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

    def stop_one(event, backend) -> None:
        if isinstance(event, EpochDone):
            done[event.host] = event.epoch
        if min(done) >= 4:
            backend.hosts[1].stop()

    settings = (f"schedule={schedule}", "epochs=400")
    log, outcome = run_on_threads(tmp_path, data, 3, *settings, meanwhile=stop_one)
    assert (outcome.status, outcome.reason) == ("stopped", "asked to stop")
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


class Losing:
    """Loses hosts: at each of some moments the one that the event is of."""

    def __init__(self, *moments) -> None:
        self.moments, self.struck = list(moments), []

    def __call__(self, event, backend) -> None:
        if self.moments and self.moments[0](event, backend):
            self.moments.pop(0)
            self.struck.append(type(event).__name__)
            backend.lose(event.host)


def after(kind, epoch=-1, rounds=1):
    """Give a moment: the first event of a kind, of an epoch or a later one, in a round or a later one."""
    return lambda event, backend: (
        isinstance(event, kind) and getattr(event, "epoch", epoch) >= epoch and backend.rounds >= rounds
    )


LOSSES = {
    "starting": [after(HostReady)],
    "before any checkpoint": [after(EpochDone, 0)],
    "saving": [after(PartSaved, 1)],
    "going on": [after(EpochDone, 4)],
    "twice": [after(EpochDone, 2), after(EpochDone, 4, rounds=2)],
    "as it begins anew": [after(EpochDone, 3), after(HostReady, rounds=2)],
    "finishing": [after(HostFinished)],
    "two at once": [after(EpochDone, 4), after(EpochDone, 0)],
}


@pytest.mark.parametrize("place", range(len(TOPOLOGIES)))
def test_a_run_that_loses_hosts_has_the_digest_of_an_undisturbed_one(tmp_path, place) -> None:
    data = write(tmp_path, experiment(TOPOLOGIES[place]))
    whole = digest(run_on_threads(tmp_path, data, 1)[0])
    for turn, (name, moments) in enumerate(LOSSES.items(), start=place):
        losing, hosts, storm = Losing(*moments), (2, 3, 9)[turn % 3], (None, turn)[turn % 2]
        schedule = ("barrier", "dataflow")[turn // 2 % 2]
        log, outcome = run_on_threads(tmp_path, data, hosts, f"schedule={schedule}", storm=storm, meanwhile=losing)
        assert (digest(log), outcome.status) == (whole, "finished"), (schedule, name)
        assert losing.moments == []
        assert 1 <= len(rows(log, "events", "recovery")) <= len(losing.struck)


def test_a_run_of_async_that_loses_hosts_replays_from_its_own_log(tmp_path) -> None:
    data = write(tmp_path, experiment("complete"))
    for turn, moments in enumerate(LOSSES.values()):
        storm = (None, turn)[turn % 2]
        log, _ = run_on_threads(tmp_path, data, 3, "schedule=async", storm=storm, meanwhile=Losing(*moments))
        again, _ = run_on_threads(tmp_path, data, 2, "schedule=async", replay=log)
        assert digest(again) == digest(log)
        seen = [(row["island"], row["epoch"]) for row in rows(log, "events", "arrivals")]
        assert sorted(seen) == sorted(set(seen))
        assert len(seen) == 9 * 6


class BreakingOff:
    """Breaks the driver off at a moment, or asks a host to stop."""

    def __init__(self, moment, stop: bool = False) -> None:
        self.moment, self.stop = moment, stop

    def __call__(self, event, backend) -> None:
        if self.moment(event, backend):
            if not self.stop:
                raise BrokenOffError
            backend.hosts[event.host].stop()


BREAKS = [after(HostReady), after(EpochDone, 0), after(PartSaved, 1), after(EpochDone, 3), after(HostFinished)]


@pytest.mark.parametrize("place", range(len(TOPOLOGIES)))
def test_a_run_that_was_broken_off_goes_on_to_the_same_digest_on_any_number_of_hosts(tmp_path, place) -> None:
    data, hosts = write(tmp_path, experiment(TOPOLOGIES[place])), (1, 2, 4)
    whole = digest(run_on_threads(tmp_path, data, 1)[0])
    for turn, moment in enumerate(BREAKS, start=place):
        folder, schedule = tmp_path / str(turn), ("barrier", "dataflow")[turn % 2]
        with pytest.raises(BrokenOffError):
            run_on_threads(folder, data, hosts[turn % 3], f"schedule={schedule}", meanwhile=BreakingOff(moment))
        again = BreakingOff(after(HostFinished))
        if turn % 3 == 0:  # and once more, later on
            with pytest.raises(BrokenOffError):
                resume_on_threads(folder / "bits", hosts[(turn + 1) % 3], storm=turn, meanwhile=again)
        log, outcome = resume_on_threads(folder / "bits", hosts[(turn + 2) % 3])
        assert (digest(log), outcome.status) == (whole, "finished")


@pytest.mark.parametrize("schedule", ["barrier", "dataflow"])
def test_a_run_that_was_stopped_goes_on_to_the_same_digest(tmp_path, schedule) -> None:
    data = write(tmp_path, experiment("ring"))
    whole = digest(run_on_threads(tmp_path, data, 1, "epochs=20")[0])
    stop = BreakingOff(after(EpochDone, 3), stop=True)
    log, outcome = run_on_threads(
        tmp_path / "stopped", data, 3, f"schedule={schedule}", "epochs=20", storm=1, meanwhile=stop
    )
    assert outcome.status == "stopped"
    assert digest(log) != whole
    log, outcome = resume_on_threads(log.parent, 2)
    assert (digest(log), outcome.status) == (whole, "finished")


def test_a_host_that_waits_for_a_lost_one_gives_its_part_of_a_checkpoint_up(tmp_path) -> None:
    from dataclasses import replace

    from islands.host import Host
    from islands.orders import StoppedError
    from orchestrator.loading import load_experiment
    from orchestrator.plan import host_plans, make_plan

    loaded = load_experiment(write(tmp_path, experiment("ring")))
    plans = host_plans(loaded, make_plan(loaded), 3, "x", tmp_path)
    host = Host(replace(plans[1], patience=60.0), post=lambda number, packets: True)
    host.ready()
    assert host.advance(0, 0, -1).epoch == 0
    with ThreadPoolExecutor(1) as pool:
        part = pool.submit(host.checkpoint, 0)
        host.stop()
        assert not wait([part], timeout=0.2).done  # nobody is lost: what it waits for will come
        host.stop(lost=True)
        with pytest.raises(StoppedError):
            part.result(timeout=10)


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
