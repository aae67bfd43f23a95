"""The actor around a host, without Ray: letters as calls from actor to actor, as between machines."""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest

import islands.actor
from experiments import bits, run, write
from islands.actor import UNANSWERED, HostActor
from islands.migration.channel import Packet
from islands.wire import opened
from orchestrator.digest import digest
from orchestrator.loading import load_experiment
from orchestrator.plan import host_plans, make_plan


class Far:
    """As Ray's handle of an actor elsewhere: ``deliver.options(...).remote(letter)``."""

    def __init__(self, actor: HostActor, answers: bool = True) -> None:
        self.actor, self.answers, self.calls = actor, answers, []
        self.deliver = self

    def options(self, **given):
        self.calls.append(given)
        return self

    def remote(self, letter: bytes, turn: int) -> None:
        if self.answers:
            self.actor.deliver(letter, turn)


@pytest.fixture
def pair(tmp_path, monkeypatch):
    """Make two actors of one experiment, on two machines."""
    interval, machines = sys.getswitchinterval(), iter("ab")
    monkeypatch.setattr(islands.actor, "_machine", lambda: next(machines))

    def make(schedule: str) -> list[HostActor]:
        loaded = load_experiment(write(tmp_path, bits()))
        plans = host_plans(loaded, make_plan(loaded), 2, "far", tmp_path)
        return [HostActor(replace(plan, schedule=schedule, epochs=4, patience=20.0)) for plan in plans]

    yield make
    sys.setswitchinterval(interval)


def test_actors_on_different_machines_call_each_other(tmp_path, pair) -> None:
    actors = pair("dataflow")
    addresses = [actor.ready() for actor in actors]
    far = [Far(actor) for actor in actors]
    for number, actor in enumerate(actors):
        actor.connect({1 - number: (far[1 - number], addresses[1 - number])})
    with ThreadPoolExecutor(2) as pool:
        told = list(pool.map(lambda actor: actor.advance(4, 4, -1), actors))
    assert [(one.epoch, one.trouble) for one in told] == [(4, "")] * 2
    assert far[0].calls
    for actor in actors:
        actor.finish(forms=False, settled=-1, through=4)
    assert digest(tmp_path / "log") == digest(run(tmp_path).folder / "log")


def test_letters_that_nobody_waits_for_are_held_back_while_too_many_are_on_their_way(pair, monkeypatch) -> None:
    import ray

    answered: list[int] = []
    monkeypatch.setattr(ray, "wait", lambda refs, num_returns, timeout: (refs[: len(answered)], refs[len(answered) :]))
    actors = pair("async")
    addresses = [actor.ready() for actor in actors]
    far = Far(actors[1], answers=False)
    for number, actor in enumerate(actors):
        actor.connect({1 - number: (far, addresses[1 - number])})
    packets = (Packet(0, 0, 3, 0, ""),)
    assert [actors[0]._post(1, packets) for _ in range(UNANSWERED + 1)] == [True] * UNANSWERED + [False]
    answered.append(1)
    assert actors[0]._post(1, packets)


def test_actors_on_one_machine_write_to_each_other_s_letterboxes(pair, monkeypatch, tmp_path) -> None:
    monkeypatch.setattr(islands.actor, "_machine", lambda: "here")
    actors = pair("barrier")
    addresses = [actor.ready() for actor in actors]
    far = Far(actors[0])
    for number, actor in enumerate(actors):
        actor.connect({1 - number: (far, addresses[1 - number])})
    actors[0]._post(1, (Packet(0, 0, 3, 0, ""),))
    actors[0]._host._see_off()
    assert actors[1]._letterbox.wait(10.0)
    actors[1]._letterbox.wait(0.1)
    assert [opened(letter) for letter in actors[1]._letterbox.letters()] == [(Packet(0, 0, 3, 0, ""),)]
    assert far.calls == []
    for actor in actors:
        actor._letterbox.close()
