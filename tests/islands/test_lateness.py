"""Late partners: who is late when, told once for each time."""

from __future__ import annotations

import json
from dataclasses import replace

import pyarrow.dataset as ds
from archipelagos import edge
from hosts import resume_on_threads, run_on_threads

from experiments import run, write
from islands.lateness import Lateness
from islands.migration.channel import Channel, Packet
from islands.migration.routes import Redrawn, Routes
from orchestrator.digest import digest

SHOWN = Channel(3, "shown", "partners")


def packet(source: int, epoch: int, channel: int = 3) -> Packet:
    return Packet(channel, source, 0, epoch, "s")


def walk(lateness: Lateness, *epochs: list[Packet], first: int = 1) -> list[list[tuple[str, str, int]]]:
    found = [lateness.told(0, epoch, packets) for epoch, packets in enumerate(epochs, start=first)]
    return [[(one["channel"], one["source"], one["since"]) for one in details] for details in found]


def test_a_source_is_told_of_once_each_time_that_it_is_late() -> None:
    routes = Routes([edge(SHOWN, source, 0) for source in (1, 2)])
    both = [packet(1, 0), packet(2, 0)]
    assert walk(
        Lateness(routes, -1),
        both,
        [packet(1, 1)],  # 2 is late
        [packet(1, 2), packet(2, 1)],  # and is so still
        [packet(2, 2)],  # late still, and now 1 too
        [packet(1, 3), packet(1, 4), packet(2, 4)],
        [packet(1, 5)],
    ) == [[], [("shown", "isle-2", 0)], [], [("shown", "isle-1", 2)], [], [("shown", "isle-2", 4)]]


def test_who_never_came_is_late_from_the_first_epoch_on() -> None:
    assert walk(Lateness(Routes([edge(SHOWN, 1, 0)]), -1), [], [], []) == [[("shown", "isle-1", -1)], [], []]


def test_a_channel_that_does_not_carry_is_not_waited_for() -> None:
    third = replace(SHOWN, every=3)
    lateness = Lateness(Routes([edge(third, 1, 0)]), -1)
    late = [("shown", "isle-1", 0)]
    epochs = [[packet(1, 0)], [], [], [], [], [packet(1, 3)], [packet(1, 6)], [], []]
    assert walk(lateness, *epochs) == [[], [], [], late, [], [], [], [], []]


def test_channels_of_other_kinds_and_edges_that_are_gone_or_not_there_yet_do_not_count() -> None:
    others = [edge(Channel(4, "m"), 1, 0), edge(Channel(5, "c", "components"), 1, 0)]
    gone, coming = edge(SHOWN, 1, 0, until=2), edge(SHOWN, 2, 0, since=3)
    epochs = [[packet(1, 0)], [packet(1, 1)], [], [], []]
    assert walk(Lateness(Routes([gone, coming, *others]), -1), *epochs) == [[], [], [], [("shown", "isle-2", -1)], []]


def test_drawn_edges_are_late_when_they_were_drawn() -> None:
    redrawn = Redrawn(SHOWN, tuple((n, f"isle-{n}") for n in range(5)), 1)
    routes = Routes([], [redrawn], 7)
    found = walk(Lateness(routes, -1), *[[] for _ in range(9)])
    late: set[str] = set()
    for epoch, told in enumerate(found):
        now = {one.source_name for one in routes.incoming(0, epoch)}
        assert {source for _, source, _ in told} == now - late
        late = now


def test_after_a_checkpoint_all_that_was_sent_before_has_come() -> None:
    every = replace(SHOWN, every=4)
    routes = Routes([edge(SHOWN, 1, 0), edge(replace(every, number=6, name="rare"), 2, 0)])
    epochs = [[packet(1, 6)], [], [packet(1, 8)], []]
    assert walk(Lateness(routes, 6), *epochs, first=7) == [
        [], [("shown", "isle-1", 6)], [("rare", "isle-2", 6)], [("shown", "isle-1", 8)],
    ]  # fmt: skip


# -- in a run ----------------------------------------------------------------------------------------------------------


def agreeing(**changes) -> dict:
    """Hosts that flee from guests, and guests that follow."""
    return {
        "name": "agreeing",
        "seed": 3,
        "epochs": 12,
        "epoch": 1,
        "backend": "inline",
        "defaults": {"kind": "bits", "count": 3, "population": 6, "genome": {"length": 12}},
        "islands": {
            "host": {"species": "host", "fitness": {"agreement": {"goal": "minimise"}}},
            "guest": {"species": "guest", "fitness": {"agreement": {"goal": "maximise"}}},
        },
        "channels": [
            {"name": "to-hosts", "kind": "partners", "from": "guest", "to": "host"},
            {"name": "to-guests", "kind": "partners", "from": "host", "to": "guest", "every": 2},
        ],
        **changes,
    }


def events(log, kind: str) -> list[tuple]:
    found = [row for row in ds.dataset(log / "events").to_table().to_pylist() if row["kind"] == kind]
    return sorted((row["island"], row["epoch"], row["detail"]) for row in found)


def expected(log) -> set[tuple]:
    """What the recorded arrivals say: in which epochs a source goes late."""
    numbers = {f"{name}-{n}": 3 * (name == "guest") + n for name in ("host", "guest") for n in range(3)}
    names = {number: name for name, number in numbers.items()}
    found = set()
    heard: dict[tuple[str, int], int] = {}
    late: dict[tuple[str, int], bool] = {}
    for island, epoch, detail in events(log, "arrivals"):
        for _, source, sent, _ in json.loads(detail)["packets"]:
            heard[island, source] = max(sent, heard.get((island, source), -1))
        every = 1 if island.startswith("host") else 2
        for source in range(3, 6) if every == 1 else range(3):
            lacking = heard.get((island, source), -1) < (epoch - 1) // every * every
            if lacking and not late.get((island, source)):
                channel = "to-hosts" if every == 1 else "to-guests"
                found.add((island, epoch, channel, names[source], heard.get((island, source), -1)))
            late[island, source] = lacking
    return found


def test_an_async_run_tells_who_was_late_and_its_replay_tells_the_same(tmp_path) -> None:
    settings = ("schedule=async", "checkpoint.every=99")
    data = write(tmp_path, agreeing())
    log, outcome = run_on_threads(tmp_path, data, 3, *settings, storm=4)
    told = events(log, "late")
    assert outcome.status == "finished"
    read = [(island, epoch, json.loads(detail)) for island, epoch, detail in told]
    rows = {(island, epoch, one["channel"], one["source"], one["since"]) for island, epoch, one in read}
    assert rows == expected(log) != set()
    assert len(rows) == len(told)
    again, _ = run_on_threads(tmp_path, data, 2, *settings, replay=log)
    assert digest(again) == digest(log)
    assert events(again, "late") == told


def test_nobody_is_late_where_islands_wait_or_one_host_steps_them_in_turn(tmp_path) -> None:
    data = write(tmp_path, agreeing())
    for hosts, schedule in ((3, "barrier"), (3, "dataflow"), (1, "async")):
        log, _ = run_on_threads(tmp_path, data, hosts, f"schedule={schedule}", storm=2)
        assert events(log, "late") == []
    assert events(run(tmp_path, agreeing(schedule="async")).folder / "log", "late") == []


def test_a_run_of_one_host_that_goes_on_is_not_late_either(tmp_path) -> None:
    log, _ = run_on_threads(tmp_path, write(tmp_path, agreeing(epochs=5)), 1, "schedule=async")
    log, _ = resume_on_threads(log.parent, 1, "epochs=9")
    assert max(epoch for _, epoch, _ in events(log, "arrivals")) == 9
    assert events(log, "late") == []
