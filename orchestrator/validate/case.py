"""A case is one setting that is run many times; a verdict compares what came of it with a published figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

Outcomes = Sequence[float | None]
"""What the runs of a case gave; ``None`` for one that did not come to its end in the time it had."""


@dataclass(frozen=True, slots=True)
class Case:
    """One setting of a check.

    Attributes
    ----------
    name
        Unique in its check.
    runs
        How often it is run.
    """

    name: str
    runs: int


@dataclass(frozen=True, slots=True)
class Verdict:
    """One comparison.

    Attributes
    ----------
    check, case
        What was compared.
    expected
        The published figure, or the relation that is to hold.
    estimate, low, high
        What was found, with its interval; ``None`` when runs did not come to their end.
    runs
        Behind the estimate.
    ok
        Whether the two agree.
    detail
        What to read beside the figures.
    """

    check: str
    case: str
    expected: str
    estimate: float | None
    low: float | None
    high: float | None
    runs: int
    ok: bool
    detail: str = ""


class Check(Protocol):
    """A published behaviour: its cases, how one run of them goes, and what they are compared with."""

    @property
    def name(self) -> str:
        """As ``--only`` takes it."""
        ...

    @property
    def cases(self) -> tuple[Case, ...]:
        """All of its cases."""
        ...

    @property
    def comparisons(self) -> int:
        """How many verdicts it gives."""
        ...

    @property
    def all_end(self) -> bool:
        """Whether a run that does not come to its end decides its case."""
        ...

    def run(self, case: str, seed: int, *, migration: bool) -> float | None:
        """Run a case once; without ``migration`` its islands stay alone, to see that the check notices."""
        ...

    def judge(self, outcomes: Mapping[str, Outcomes], comparisons: int) -> list[Verdict]:
        """Compare the outcomes of all cases, as one part of so many comparisons."""
        ...
