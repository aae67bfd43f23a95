"""Telling how a run goes: a live table on a terminal, plain lines elsewhere."""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import TYPE_CHECKING, Final, Protocol, TextIO, final

from islands.store import Store
from islands.tally import IslandSummary
from orchestrator.experiment import Experiment
from orchestrator.plan import Plan

if TYPE_CHECKING:
    from rich.live import Live
    from rich.table import Table

MOST_ROWS: Final = 24
"""Islands that the live table shows; of more it shows the best."""


class Progress(Protocol):
    """Is told how a run goes."""

    def begin(self, plan: Plan, experiment: Experiment, folder: Store) -> None:
        """Start: the run begins."""
        ...

    def epoch(self, epoch: int, rows: tuple[IslandSummary, ...]) -> None:
        """All islands have finished an epoch."""
        ...

    def note(self, text: str) -> None:
        """Something is worth a line."""
        ...

    def close(self) -> None:
        """Stop: the run is over."""
        ...


def progress_on(stream: TextIO) -> Progress:
    """Give the progress that suits a stream."""
    return LiveTable(stream) if stream.isatty() else PlainLines(stream)


@final
class Pace:
    """Estimates the time left, from the epochs done since the first population was scored."""

    def __init__(self, epochs: int, generations: int) -> None:
        self._epochs, self._generations = epochs, generations
        self._began = self._settled = time.perf_counter()

    def left(self, epoch: int) -> float:
        """Give the seconds left once an epoch is done; after epoch 0 by the time that one generation took."""
        now = time.perf_counter()
        if epoch == 0:
            self._settled = now
            return (now - self._began) * self._epochs * self._generations
        return (now - self._settled) / epoch * (self._epochs - epoch)


def clock_text(seconds: float) -> str:
    """Write a duration as people read it: ``42 s``, ``3:07``, ``1:02:07``."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    hours, rest = divmod(whole, 3600)
    minutes, second = divmod(rest, 60)
    return f"{hours}:{minutes:02d}:{second:02d}" if hours else f"{minutes}:{second:02d}"


@final
class Barren:
    """Says once of each island that it has no valid member, and why."""

    def __init__(self) -> None:
        self._told: dict[str, None] = {}

    def notes(self, rows: Iterable[IslandSummary]) -> list[str]:
        """Give a line for each island of which nothing was said yet; beyond ``MOST_ROWS`` at once, one for the rest."""
        fresh = [row for row in rows if row.trouble and row.island not in self._told]
        self._told.update((row.island, None) for row in fresh)
        lines = [_barren(row) for row in fresh]
        rest = len(lines) - MOST_ROWS
        return lines if rest <= 0 else [*lines[:MOST_ROWS], f"note: and all of {rest} more islands"]


def _barren(row: IslandSummary) -> str:
    if not row.invalid:
        return f"note: {row.island} has no members: {row.trouble}"
    return f"note: all {row.invalid} of {row.island} are invalid, most often: {row.trouble}"


@final
class PlainLines:
    """A line an epoch."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._epochs = 0
        self._pace = Pace(0, 0)
        self._migrants = 0
        self._barren = Barren()

    def begin(self, plan: Plan, experiment: Experiment, folder: Store) -> None:
        """Say what is about to happen."""
        self._epochs = experiment.length
        self._pace = Pace(experiment.length, experiment.epoch)
        generations = experiment.length * experiment.epoch
        self.note(f"run {folder.name}: {len(plan.islands)} islands, {generations} generations, into {folder}")

    def epoch(self, epoch: int, rows: tuple[IslandSummary, ...]) -> None:
        """Say how the best, the mean and the invalid stand over all islands."""
        best = max((row.best for row in rows if row.best is not None), default=None)
        means = [row.mean for row in rows if row.mean is not None]
        mean = sum(means) / len(means) if means else None
        self._migrants += sum(row.migrants for row in rows)
        left = self._pace.left(epoch)
        invalid = sum(row.invalid for row in rows)
        self.note(
            f"epoch {epoch}/{self._epochs}  generation {max(row.generation for row in rows)}  best {_number(best)}  "
            f"mean {_number(mean)}  invalid {invalid}  migrants {self._migrants}  left {clock_text(left)}"
        )
        for text in self._barren.notes(rows):
            self.note(text)

    def note(self, text: str) -> None:
        """Write a line."""
        print(text, file=self._stream, flush=True)

    def close(self) -> None:
        """Nothing is open."""


@final
class LiveTable:
    """A table that is drawn over itself, a row an island."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._live: Live | None = None
        self._epochs = 0
        self._pace = Pace(0, 0)
        self._migrants: dict[str, int] = {}
        self._title = ""
        self._barren = Barren()

    def begin(self, plan: Plan, experiment: Experiment, folder: Store) -> None:
        """Draw the empty table."""
        from rich.console import Console
        from rich.live import Live

        self._epochs = experiment.length
        self._pace = Pace(experiment.length, experiment.epoch)
        self._title = f"{folder.name}: {len(plan.islands)} islands"
        self._live = Live(self._table(-1, ()), console=Console(file=self._stream), auto_refresh=False)
        self._live.start()

    def epoch(self, epoch: int, rows: tuple[IslandSummary, ...]) -> None:
        """Draw how the islands stand."""
        for row in rows:
            self._migrants[row.island] = self._migrants.get(row.island, 0) + row.migrants
        if self._live is not None:
            self._live.update(self._table(epoch, rows), refresh=True)
        for text in self._barren.notes(rows):
            self.note(text)

    def note(self, text: str) -> None:
        """Write a line above the table."""
        if self._live is not None:
            self._live.console.print(text, markup=False, highlight=False)
        else:
            print(text, file=self._stream, flush=True)

    def close(self) -> None:
        """Leave the table as it stands."""
        if self._live is not None:
            self._live.stop()
            self._live = None

    def _table(self, epoch: int, rows: tuple[IslandSummary, ...]) -> Table:
        from rich.table import Table

        caption = f"epoch {max(epoch, 0)}/{self._epochs}, time left "
        caption += "?" if epoch < 0 else clock_text(self._pace.left(epoch))
        table = Table(title=self._title, caption=caption)
        for heading in ("island", "generation", "best", "mean", "invalid", "migrants"):
            table.add_column(heading, justify="left" if heading == "island" else "right")
        shown = rows
        if len(rows) > MOST_ROWS:
            shown = tuple(sorted(rows, key=lambda row: (row.best is None, -(row.best or 0.0)))[:MOST_ROWS])
        for row in shown:
            migrants = str(self._migrants[row.island])
            figures = (str(row.generation), _number(row.best), _number(row.mean), str(row.invalid), migrants)
            table.add_row(row.island, *figures)
        return table


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.6g}"
