"""Runs that are steered while they go on: when commands take effect, and that resumed and replayed runs do the same."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from helm import Helmsman

from experiments import Silent, bits, write
from genome.errors import InputError
from islands.store import Store
from orchestrator.digest import digest
from orchestrator.folder import RunFolder, open_run
from orchestrator.loading import load_experiment
from orchestrator.query import ask
from orchestrator.replay import replay
from orchestrator.resume import resumable, resume
from orchestrator.run import make_backend, run_experiment
from orchestrator.steering.command import Request
from orchestrator.steering.mailbox import post


@pytest.fixture(autouse=True)
def _one_epoch_a_call(monkeypatch) -> None:
    """However quick the machine, a command that comes at an epoch's end takes effect a few epochs later."""
    monkeypatch.setattr("orchestrator.archipelago.CALL_S", 0.0)


def steered(tmp_path: Path, letters: Mapping[int, list[Request]], **changes: Any) -> tuple[RunFolder, Helmsman, str]:
    data = bits(epochs=22, checkpoint={"every": 3, "spacing": 0.0}, **changes)
    loaded = load_experiment(write(tmp_path, data))
    helmsman = Helmsman(letters)
    outcome = run_experiment(loaded, make_backend(loaded, None), tmp_path / "runs", None, helmsman)
    return open_run(str(outcome.folder)), helmsman, outcome.status


def spans(folder: RunFolder) -> dict[str, tuple[int, int, int]]:
    sql = (
        "select island, min(epoch), max(epoch), count(distinct epoch) from generations group by island order by island"
    )
    return {island: tuple(found) for island, *found in ask(folder.log, sql).rows}


def commands(folder: RunFolder) -> list[dict[str, Any]]:
    return [json.loads(line) for line in folder.store.read("commands.jsonl").decode().splitlines()]


ALL = {
    2: [Request("weight", {"values": {"ones": 2.5}}), Request("rate", {"values": {"mutation": 0.5}})],
    4: [Request("add-island", {"name": "west", "like": "south", "set": []})],
    7: [Request("connect", {"channel": {"kind": "migrants", "from": "west", "to": "south", "count": 2}})],
    9: [Request("lock", {"id": 3}), Request("promote", {"id": 3}), Request("remove", {"id": 1})],
    11: [Request("disconnect", {"channel": "migrants-0"}), Request("checkpoint", {})],
    14: [Request("remove-island", {"islands": ["north-1"]})],
    16: [Request("pause", {}), Request("weight", {"values": {"ones": 1}, "islands": ["south"]}), Request("resume", {})],
}


def test_each_command_takes_effect_at_its_epoch_and_a_replay_is_the_run_itself(tmp_path) -> None:
    folder, _, status = steered(tmp_path, ALL)
    assert status == "finished"
    told = commands(folder)
    assert [one["verb"] for one in told] == [request.verb for at in ALL for request in ALL[at]]
    assert {one["outcome"] for one in told} == {"accepted"}
    at = {one["verb"]: one["epoch"] for one in told}
    assert all(one["epoch"] > epoch for one, epoch in zip(told, [e for e in ALL for _ in ALL[e]], strict=True))
    found = spans(folder)
    assert found["west"] == (at["add-island"], 22, 23 - at["add-island"])
    assert found["north-1"] == (0, at["remove-island"] - 1, at["remove-island"])
    assert found["north-0"] == found["north-2"] == found["south"] == (0, 22, 23)
    # All islands are scored again in the first epoch of the new weight, and in no other before the second one.
    sql = "select distinct epoch from evaluations where reason = 'weights' order by epoch"
    weights = [one["epoch"] for one in told if one["verb"] == "weight"]
    assert [epoch for (epoch,) in ask(folder.log, sql).rows] == weights
    sql = "select max(epoch) from migrations where channel = 'migrants-0'"
    assert ask(folder.log, sql).rows == [(at["disconnect"],)]  # what was sent at the end of the epoch before
    outcome = replay(folder, tmp_path / "again", None, (), Silent())
    assert digest(outcome.store.at("log")) == digest(folder.log)


def test_a_steered_run_that_is_stopped_and_resumed_twice_is_the_same(tmp_path) -> None:
    folder, _, status = steered(tmp_path, {**ALL, 17: [Request("stop", {})]})
    assert status == "stopped"
    for epochs in (20, 22):
        loaded = resumable(folder, (f"epochs={epochs}",))
        assert resume(folder, loaded, make_backend(loaded, None), Silent()).status == "finished"
        folder = open_run(str(folder.store))
    assert spans(folder)["south"] == (0, 22, 23)
    outcome = replay(folder, tmp_path / "again", None, (), Silent())
    assert digest(outcome.store.at("log")) == digest(folder.log)


def test_what_cannot_be_meant_is_written_down_as_refused_and_changes_nothing(tmp_path) -> None:
    wrong = [
        Request("weight", {"values": {"twos": 1}}),
        Request("remove-island", {"islands": ["north-7"]}),
        Request("disconnect", {"channel": "nothing"}),
    ]
    folder, _, status = steered(tmp_path, {3: wrong})
    assert status == "finished"
    told = commands(folder)
    assert [(one["verb"], one["epoch"]) for one in told] == [(request.verb, None) for request in wrong]
    assert all("expected" in one["outcome"] and "got" in one["outcome"] for one in told)
    other = tmp_path / "other"
    other.mkdir()
    undisturbed, _, _ = steered(other, {})
    assert digest(undisturbed.log) == digest(folder.log)


def test_a_pause_stands_still_at_a_checkpoint_until_the_run_goes_on(tmp_path) -> None:
    seen = []

    class Looking(Helmsman):
        def note(self, text: str) -> None:
            super().note(text)
            if text.startswith("paused"):
                manifest = json.loads(self.store.read("manifest.json"))
                seen.append((manifest["status"], self.store.names("checkpoints"), manifest["busy"]))
                post(self.store, Request("resume", {}), "2026-01-01T01:00:00.000+00:00", "test")

    loaded = load_experiment(write(tmp_path, bits(epochs=120, checkpoint={"every": 1000, "spacing": 0.0})))
    helmsman = Looking({3: [Request("pause", {})]})
    outcome = run_experiment(loaded, make_backend(loaded, None), tmp_path / "runs", None, helmsman)
    assert (outcome.status, outcome.generations) == ("finished", 360)
    ((status, files, busy),) = seen
    assert 0 < busy <= 1
    paused = commands(open_run(str(outcome.folder)))[0]["epoch"] - 1
    assert (status, files) == ("paused", [f"e{paused:06d}.json"])
    assert json.loads((outcome.folder / "manifest.json").read_text())["status"] == "finished"


@pytest.mark.parametrize("verb", ["weight", "connect"])
def test_a_command_that_comes_in_the_last_epoch_is_too_late(tmp_path, verb) -> None:
    arguments = {"weight": {"values": {"ones": 2}}, "connect": {"channel": {"from": "south", "to": "north-0"}}}[verb]
    data = bits(epochs=4)
    loaded = load_experiment(write(tmp_path, data))
    helmsman = Helmsman({4: [Request(verb, arguments)]})
    outcome = run_experiment(loaded, make_backend(loaded, None), tmp_path / "runs", None, helmsman)
    assert outcome.status == "finished"
    # The run is over by then: nobody writes it down any more, and whoever asked is told so.
    answers = [json.loads((outcome.folder / "outbox" / name).read_text())
               for name in Store.open(outcome.folder).names("outbox")]  # fmt: skip
    assert [(one["accepted"], one["reason"]) for one in answers] in (
        [(False, "the run is finished")],
        [(False, "the run ends with epoch 4, and no earlier one can still be changed")],
    )


def test_a_run_is_not_gone_on_with_when_its_past_was_changed(tmp_path) -> None:
    """Nothing is cut and the manifest stays as it was."""
    folder, _, _ = steered(tmp_path, {**ALL, 17: [Request("stop", {})]})
    before = (digest(folder.log), folder.manifest())
    path = folder.store.local

    def go_on() -> str:
        loaded = resumable(folder, ("epochs=22",))
        return resume(folder, loaded, make_backend(loaded, None), Silent()).status

    def refused(expected: str) -> None:
        with pytest.raises(InputError, match=expected):
            go_on()
        assert (digest(folder.log), folder.manifest()) == before

    for name, change, expected in (
        ("commands.jsonl", lambda text: "", "expected the 14 commands that .* was steered by, got 0 commands"),
        ("commands.jsonl", lambda text: text.replace("2.5", "3.5"), "was steered by, got others"),
        ("commands.jsonl", lambda text: "rubbish\n", "expected a line of JSON"),
        ("experiment.yaml", lambda text: text.replace("population: 12", "population: 11"), "got other islands, chan"),
        ("experiment.yaml", lambda text: text.replace("seed: 7", "seed: 8"), "expected a checkpoint of the run bits"),
    ):
        whole = (path / name).read_text(encoding="utf-8")
        assert change(whole) != whole
        (path / name).write_text(change(whole), encoding="utf-8")
        refused(expected)
        (path / name).write_text(whole, encoding="utf-8")
    moved = path.with_name("renamed")
    path.rename(moved)
    with pytest.raises(InputError, match="expected the folder of the run 'bits' under its own name, got 'renamed'"):
        resumable(open_run(str(moved)), ("epochs=22",))
    moved.rename(path)
    assert go_on() == "finished"


def test_a_run_that_had_come_to_its_end_keeps_its_figures_when_it_is_gone_on_with(tmp_path) -> None:
    folder, _, _ = steered(tmp_path, {})
    before, whole = folder.manifest(), digest(folder.log)
    for asked in ((), ("epochs=22",), ("hosts=1",)):
        with pytest.raises(InputError, match="something left to do, got one that has finished its 22"):
            resumable(folder, asked)
    # As a driver leaves it that is killed while forms are written.
    folder.update(status="running", best=None, generations=0, evaluations=0)
    loaded = resumable(folder, ())
    outcome = resume(folder, loaded, make_backend(loaded, None), Helmsman({}))
    told = ("best", "generations", "evaluations")
    assert [getattr(outcome, name) for name in told] == [before[name] for name in told]
    assert [folder.manifest()[name] for name in told] == [before[name] for name in told]
    assert digest(folder.log) == whole


def test_a_log_file_that_is_damaged_inside_sends_a_run_back_to_a_checkpoint_before_it(tmp_path) -> None:
    folder, _, _ = steered(tmp_path, {17: [Request("stop", {})]})
    path = folder.store.local
    whole = digest(folder.log)
    newest = max((path / "log" / "individuals").glob("e*.parquet"), key=lambda one: one.name[8:14])
    content = bytearray(newest.read_bytes())
    content[len(content) // 3] ^= 0xFF
    newest.write_bytes(bytes(content))
    noted = Helmsman({})
    loaded = resumable(folder, ())
    assert resume(folder, loaded, make_backend(loaded, None), noted).status == "finished"
    assert any("passed over: log/individuals" in note for note in noted.notes)
    other = tmp_path / "other"
    other.mkdir()
    undisturbed, _, _ = steered(other, {})
    assert digest(open_run(str(path)).log) == digest(undisturbed.log)
    assert whole[1] < digest(undisturbed.log)[1]
