"""Runs that are steered and die: what was decided stays so, and the run's own replay has its digest."""

from __future__ import annotations

import json
import signal

import pytest
from ordeal import RAY, Ordeal, slowed
from traps import Trap

from orchestrator.query import ask

CONNECT = "{kind: migrants, from: north-0, to: east, name: over}"


def replayed(ordeal: Ordeal) -> bool:
    """Replay the run in one process, and tell whether the digests are equal."""
    words = ("replay", ordeal.place, "--runs-dir", "again", "--set", "backend=inline", "--json")
    told = ordeal.ended(ordeal.start(*words), 0).told
    assert told["digest"] == ordeal.digest()[0]
    return bool(told["same"])


def commands(ordeal: Ordeal) -> list[tuple[str, int | None]]:
    lines = (ordeal.path / "commands.jsonl").read_text(encoding="utf-8").splitlines()
    return [(told["verb"], told["epoch"]) for told in map(json.loads, lines)]


@pytest.mark.parametrize("backend", [(), RAY], ids=["inline", "ray"])
def test_a_steered_run_that_is_killed_while_paused(place, note, backend: tuple[str, ...]) -> None:
    ordeal = Ordeal(place, slowed(5))
    process = ordeal.run(*backend)
    ordeal.until(ordeal.checkpoints, process)
    for words in (
        ("pause",), ("weight", "ones=3", "--island", "north"), ("remove", "3"),
        ("add-island", "east", "--like", "south"), ("connect", CONNECT),
    ):  # fmt: skip
        ended = ordeal.steer(*words)
        assert ended.code == 0, ended.err
        assert ended.told["accepted"]
    ordeal.until(lambda: ordeal.manifest()["status"] == "paused", process)
    process.kill()
    ordeal.ended(process, -signal.SIGKILL)
    decided = commands(ordeal)
    assert [verb for verb, _ in decided] == ["pause", "weight", "remove", "add-island", "connect"]
    ordeal.ended(ordeal.resume(), 0)
    assert commands(ordeal) == decided
    assert ask(ordeal.store.at("log"), "select count(*) from generations where island = 'east'").rows[0][0] > 0
    assert replayed(ordeal)
    note("steered, driver killed", f"while paused, {'Ray' if backend else 'inline'}; against its replay", None)


@pytest.mark.ray
def test_a_driver_that_is_killed_before_it_answers_a_command(place, note) -> None:
    """It stands in the journal, so it takes effect, and counts once."""
    ordeal = Ordeal(place, slowed(10), Trap("write", "*/outbox/*", who="driver"))
    process = ordeal.run()
    ordeal.until(ordeal.checkpoints, process)
    steered = ordeal.start("steer", ordeal.place, "weight", "ones=3")
    ordeal.ended(process, -signal.SIGKILL)
    assert ordeal.ended(steered, 1).complaint
    (decided,) = commands(ordeal)
    ordeal.ended(ordeal.resume(), 0)
    assert commands(ordeal) == [decided]
    assert replayed(ordeal)
    note("steered, driver killed", "command journalled, not answered; against its replay", None)


def test_steering_while_a_host_dies(place, note) -> None:
    ordeal = Ordeal(place, slowed(10))
    process = ordeal.run(*RAY)
    ordeal.until(ordeal.checkpoints, process)
    ordeal.strike()
    ordeal.hosts(process)[0].kill()
    ended = ordeal.steer("weight", "ones=3")
    assert ended.told["accepted"]
    ordeal.ended(process, 0)
    assert len(ordeal.events("recovery")) == 1
    assert commands(ordeal) == [("weight", ended.told["epoch"])]
    assert replayed(ordeal)
    note("steered as a host dies", "against its replay", ordeal.recovered_s())
