"""Hosts on a real Ray die or hang at a moment: the run goes on by itself, in seconds, to the same log."""

from __future__ import annotations

import signal

import psutil
import pytest
from ordeal import RAY, Ordeal, noise, slowed, tortured
from traps import Trap

AT = {
    "while it starts": [Trap("build", "*", who="host")],
    "in epoch 0": [Trap("evaluate", "south", who="host", nth=5)],
    "between two checkpoints": [Trap("evaluate", "south", who="host", nth=100)],
    "in the middle of its part of a checkpoint": [Trap("write", "*/checkpoints/e*/host-*", "half", who="host", nth=2)],
    "just after its part of a checkpoint": [Trap("write", "*/checkpoints/e*/host-*", "after", who="host", nth=2)],
    "during a log move": [Trap("write", "*/log/individuals/e*", "draft", who="host", nth=2)],
    "between two tables of the log": [Trap("write", "*/log/generations/e*", who="host", nth=2)],
    "while it waits for packets": [Trap("wait", who="host", nth=2)],
    "as it delivers packets": [Trap("post", who="host", nth=7)],
    "as it writes forms": [Trap("form", who="host", nth=2)],
    "twice in a row": [
        Trap("evaluate", "south", who="host", nth=100),
        Trap("evaluate", "north-*", who="host", nth=200),
    ],
}
SAMPLE = ("in the middle of its part of a checkpoint", "twice in a row")


@pytest.mark.parametrize("moment", [pytest.param(at, marks=pytest.mark.ray) if at in SAMPLE else at for at in AT])
def test_a_host_that_is_killed(place, note, moment: str) -> None:
    # With barrier, whoever is told to go on has its packets already.
    data = slowed(schedule="dataflow") if "waits" in moment else tortured()
    ordeal = Ordeal(place, data, *AT[moment])
    ended = ordeal.ended(ordeal.run(*RAY), 0)
    marks = ordeal.marks()
    assert len(marks) == len(AT[moment])
    assert all(mark["host"] for mark in marks)
    recoveries = [detail for kind, detail in ordeal.events("recovery")]
    assert 1 <= len(recoveries) <= len(marks)
    assert all("died and could not" in detail["reason"] and len(detail["lost"]) == 1 for detail in recoveries)
    assert [line for line in ended.err.splitlines() if "died and could not" in line], ended.err
    assert noise(ended.err) == []
    assert ended.told["status"] == "finished"
    assert ordeal.same()
    note("host killed", moment, ordeal.recovered_s() if moment != "as it writes forms" else None)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_all_hosts_at_once(place, note, number: signal.Signals) -> None:
    data = slowed(deadlines={"silence": 4})
    ordeal = Ordeal(place, data)
    process = ordeal.run(*RAY)
    ordeal.until(ordeal.checkpoints, process)
    hosts = ordeal.hosts(process)
    assert len(hosts) == 2
    ordeal.strike()
    for host in hosts:
        host.send_signal(number)
    ended = ordeal.ended(process, 0)
    recoveries = [detail for _, detail in ordeal.events("recovery")]
    assert [host.is_running() for host in hosts] == [False, False]
    assert sorted(lost for detail in recoveries for lost in detail["lost"]) == [0, 1], ended.err
    assert ordeal.same()
    note(
        "all hosts " + ("killed" if number == signal.SIGKILL else "stopped (SIGSTOP)"),
        "in mid-run",
        ordeal.recovered_s(),
    )


def test_a_host_that_stops_answering(place, note) -> None:
    """SIGSTOP: the process is there, and says nothing; it must never write again."""
    ordeal = Ordeal(place, slowed(deadlines={"silence": 3}))
    process = ordeal.run(*RAY)
    ordeal.until(ordeal.checkpoints, process)
    host = ordeal.hosts(process)[0]
    ordeal.strike()
    host.suspend()
    ordeal.ended(process, 0)
    assert not psutil.pid_exists(host.pid)
    ((_, detail),) = ordeal.events("recovery")
    assert "has answered nothing for 3 s: it hangs or is gone" in detail["reason"]
    assert detail["epoch"] >= 2
    assert ordeal.same()
    note("host stopped (SIGSTOP)", "in mid-run, silence 3 s", ordeal.recovered_s())


def test_a_driver_that_is_killed_on_ray_resumes_on_other_hosts(place, note) -> None:
    """None of its hosts outlives it; the run goes on on another number of hosts, then in one process."""
    ordeal = Ordeal(place, slowed())
    process = ordeal.run(*RAY)
    ordeal.until(ordeal.checkpoints, process)
    hosts = ordeal.hosts(process)
    process.kill()
    ordeal.ended(process, -signal.SIGKILL)
    assert psutil.wait_procs(hosts, timeout=10)[1] == []
    first = max(ordeal.checkpoints())
    process = ordeal.resume("--set", "hosts=4")
    ordeal.until(lambda: max(ordeal.checkpoints()) > first, process)
    assert len(ordeal.hosts(process)) == 4
    process.kill()
    ordeal.ended(process, -signal.SIGKILL)
    ordeal.ended(ordeal.resume("--set", "backend=inline"), 0)
    assert [detail["hosts"] for _, detail in ordeal.events("resume")] == [4, 1]
    assert ordeal.same()
    note("driver killed on Ray, twice", "in mid-run; 2 hosts, then 4, then inline", None)
