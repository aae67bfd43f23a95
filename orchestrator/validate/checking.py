"""Running the checks, on as many processes as there are CPUs; the outcome is the same for any number of them."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from typing import Final, NamedTuple

from islands.host import pin_threads
from orchestrator.validate.case import Case, Check, Verdict
from orchestrator.validate.leading_ones import LeadingOnes
from orchestrator.validate.rare_migration import RareMigration
from orchestrator.validate.takeover import Takeover

CHECKS: Final[tuple[Check, ...]] = (Takeover(), LeadingOnes(), RareMigration())
BATCH: Final = 10
"""Runs that a process does at a time."""

SEEDS: Final = 1_000_000
"""Between the first seeds of two cases."""


class _Batch(NamedTuple):
    check: Check
    case: Case
    first_seed: int
    runs: int
    migration: bool


def validate(
    checks: Sequence[Check],
    processes: int,
    migration: bool = True,
    tell: Callable[[Verdict], None] = lambda _: None,
) -> list[Verdict]:
    """Run checks and give their verdicts.

    Parameters
    ----------
    checks
        Which ones.
    processes
        How many to run them on; 1 is this one.
    migration
        False switches migration off, to see that the checks notice.
    tell
        Is told each verdict as soon as its check is done.
    """
    comparisons = sum(check.comparisons for check in checks)
    plan = [_batches(check, migration=migration) for check in checks]
    verdicts: list[Verdict] = []
    outcomes = _performed([batch for batches in plan for batch in batches], processes)
    for check, batches in zip(checks, plan, strict=True):
        found: dict[str, list[float | None]] = {case.name: [] for case in check.cases}
        for batch in batches:
            found[batch.case.name].extend(next(outcomes))
        for verdict in check.judge(found, comparisons):
            tell(verdict)
            verdicts.append(verdict)
    return verdicts


def _batches(check: Check, *, migration: bool) -> list[_Batch]:
    return [
        _Batch(check, case, place * SEEDS + first, min(BATCH, case.runs - first), migration)
        for place, case in enumerate(check.cases)
        for first in range(0, case.runs, BATCH)
    ]


def _performed(batches: Sequence[_Batch], processes: int) -> Iterator[list[float | None]]:
    if processes == 1:
        yield from map(_perform, batches)
        return
    # A pool that is left, on Ctrl-C too, ends its processes at once.
    with multiprocessing.get_context("spawn").Pool(processes, initializer=_ready) as pool:
        yield from pool.imap(_perform, batches)


def _ready() -> None:
    # A Ctrl-C in a terminal is the parent's to handle.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    pin_threads()


def _perform(batch: _Batch) -> list[float | None]:
    outcomes: list[float | None] = []
    for seed in range(batch.first_seed, batch.first_seed + batch.runs):
        outcomes.append(batch.check.run(batch.case.name, seed, migration=batch.migration))
        if outcomes[-1] is None and batch.check.all_end:
            # One run that does not end decides the case: the others of the batch need not be waited for.
            return [*outcomes, *[None] * (batch.runs - len(outcomes))]
    return outcomes
