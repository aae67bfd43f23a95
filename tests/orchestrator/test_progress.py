"""Progress: plain lines for a pipe, a live table for a terminal."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import pytest

from experiments import bits, write
from islands.tally import IslandSummary
from orchestrator.loading import load_experiment
from orchestrator.plan import make_plan
from orchestrator.progress import MOST_ROWS, Barren, LiveTable, PlainLines, clock_text, progress_on


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


@pytest.mark.parametrize("stream", [io.StringIO, Terminal])
def test_an_island_whose_deme_is_all_invalid_is_told_once_with_the_reason(tmp_path, stream) -> None:
    out = stream()
    progress = progress_on(out)
    loaded = load_experiment(write(tmp_path, bits()))
    progress.begin(make_plan(loaded), loaded.experiment, Path("runs/bits"))
    for epoch in range(3):
        good, bad = rows(epoch)
        progress.epoch(epoch, (good, replace(bad, trouble="rules: no axiom")))
    progress.close()
    assert out.getvalue().count("all 9 of south are invalid, most often: rules: no axiom") == 1
    assert "north-0 are invalid" not in out.getvalue()


def test_many_islands_whose_demes_are_all_invalid_do_not_flood_the_terminal() -> None:
    bad = rows(0)[1]
    many = [replace(bad, island=f"isle-{number}", trouble="rules: no axiom") for number in range(MOST_ROWS + 5)]
    lines = Barren().notes(many)
    assert len(lines) == MOST_ROWS + 1
    assert lines[-1] == "note: and all of 5 more islands"
