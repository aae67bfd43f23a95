"""Progress: plain lines for a pipe, a live table for a terminal."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from experiments import bits, write
from islands.host import IslandSummary
from orchestrator.loading import load_experiment
from orchestrator.plan import make_plan
from orchestrator.progress import LiveTable, PlainLines, clock_text, progress_on


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def rows(epoch: int) -> tuple[IslandSummary, ...]:
    figures = [("north-0", 3.5, 2.5, 0), ("south", None, None, 9)]
    return tuple(
        IslandSummary(name, epoch, epoch * 3, 11, best, mean, invalid, 2, None) for name, best, mean, invalid in figures
    )


@pytest.mark.parametrize(("stream", "kind"), [(io.StringIO, PlainLines), (Terminal, LiveTable)])
def test_it_tells_generation_best_mean_invalid_migrants_and_time_left(tmp_path, stream, kind) -> None:
    out = stream()
    progress = progress_on(out)
    assert isinstance(progress, kind)
    loaded = load_experiment(write(tmp_path, bits()))
    progress.begin(make_plan(loaded), loaded.experiment, Path("runs/bits"))
    for epoch in range(3):
        progress.epoch(epoch, rows(epoch))
    progress.note("a [note] as it is")
    progress.close()
    text = out.getvalue()
    last = text.splitlines()[-2] if kind is PlainLines else text
    for part in ("generation", "best", "mean", "invalid", "migrants", "left", "3.5", "2.5", "9"):
        assert part in last
    assert ("12" if kind is PlainLines else "6") in last  # migrants of three epochs, in all or per island
    assert "a [note] as it is" in text


@pytest.mark.parametrize(("seconds", "text"), [(0.4, "0 s"), (59.4, "59 s"), (61, "1:01"), (3725, "1:02:05")])
def test_durations_read_well(seconds, text) -> None:
    assert clock_text(seconds) == text
