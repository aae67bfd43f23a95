"""Being asked to stop, in this process: by every signal, at every time, once and twice."""

from __future__ import annotations

import json
import os
import signal
import sys

import pyarrow.dataset as ds
import pytest

from experiments import Silent, bits, run, write
from islands.host import Host
from orchestrator.backends.inline import InlineBackend
from orchestrator.backends.protocol import RunFailedError
from orchestrator.loading import load_experiment
from orchestrator.run import run_experiment
from orchestrator.signals import HEARD, Signals


@pytest.fixture(autouse=True)
def _handlers_are_given_back():
    before = [signal.getsignal(number) for number in HEARD]
    yield
    assert [signal.getsignal(number) for number in HEARD] == before


def strike(number: int) -> None:
    os.kill(os.getpid(), number)


def in_epoch_two(monkeypatch, *numbers: int, epoch: int = 2) -> None:
    real = Host._take_turn

    def struck(self, *turn):
        if turn == (0, epoch):
            for number in numbers:
                strike(number)
        return real(self, *turn)

    monkeypatch.setattr(Host, "_take_turn", struck)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_each_signal_stops_cleanly_also_where_the_backend_took_it_for_itself(tmp_path, monkeypatch, number) -> None:
    """Ray's start sets a handler of its own for SIGTERM."""

    def as_ray_does(self) -> int:
        signal.signal(number, lambda *_: sys.exit(1))
        return 1

    monkeypatch.setattr(InlineBackend, "open", as_ray_does)
    in_epoch_two(monkeypatch, number)
    outcome = run(tmp_path)
    assert (outcome.status, outcome.generations) == ("stopped", 3)
    manifest = json.loads((outcome.folder / "manifest.json").read_text(encoding="utf-8"))
    assert (manifest["status"], manifest["evaluations"]) == ("stopped", outcome.evaluations)
    assert ds.dataset(outcome.folder / "log" / "generations").count_rows() == 4 * 4
    assert list((outcome.folder / "forms").iterdir())


@pytest.mark.parametrize("fails", [False, True])
def test_a_run_that_is_stopped_before_it_has_a_folder_makes_none(tmp_path, monkeypatch, fails) -> None:
    def struck(self) -> int:
        strike(signal.SIGINT)
        if fails:  # a helper that was in the same process group
            raise RunFailedError("no cluster")
        return 1

    monkeypatch.setattr(InlineBackend, "open", struck)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path)
    assert not (tmp_path / "runs").exists()


def test_a_run_that_is_broken_off_keeps_what_the_driver_knows(tmp_path, monkeypatch) -> None:
    whole = run(tmp_path, name="whole")
    in_epoch_two(monkeypatch, signal.SIGHUP, signal.SIGINT, epoch=3)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, name="broken")
    manifest = json.loads((tmp_path / "runs" / "broken" / "manifest.json").read_text(encoding="utf-8"))
    finished = json.loads((whole.folder / "manifest.json").read_text(encoding="utf-8"))
    assert manifest.keys() == finished.keys()
    assert (manifest["status"], manifest["generations"]) == ("stopped", 6)
    assert manifest["error"].startswith("broken off by a second Ctrl-C")
    table = ds.dataset(whole.folder / "log" / "generations").to_table(columns=["epoch", "evaluations"]).to_pylist()
    assert manifest["evaluations"] == sum(row["evaluations"] for row in table if row["epoch"] < 3)
    assert manifest["best"].keys() == {"island", "id", "fitness"}
    assert manifest["ended"]


def test_a_driver_that_breaks_tells_why_in_the_manifest(tmp_path) -> None:
    class Breaks(Silent):
        def epoch(self, epoch, rows) -> None:
            raise ValueError("no such colour")

    loaded = load_experiment(write(tmp_path, bits()))
    with pytest.raises(ValueError, match="no such colour"):
        run_experiment(loaded, InlineBackend(), tmp_path / "runs", None, Breaks())
    manifest = json.loads((tmp_path / "runs" / "bits" / "manifest.json").read_text(encoding="utf-8"))
    assert (manifest["status"], manifest["error"]) == ("failed", "ValueError: no such colour")


def test_a_hang_up_is_not_heard_under_nohup() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with Signals(lambda: None) as signals:
            strike(signal.SIGHUP)
            assert not signals.stop.is_set()
            strike(signal.SIGTERM)
            assert signals.stop.is_set()
            signals.close()
            strike(signal.SIGINT)
    finally:
        signal.signal(signal.SIGHUP, before)
