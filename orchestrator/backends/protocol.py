"""What a backend is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from islands.host import HostPlan, IslandSummary
from orchestrator.archipelago import Advance, AskStop, Event, Finish, Spawn


@dataclass(frozen=True, slots=True)
class Deadlines:
    """Seconds that a host may take to start, for an epoch, and to finish."""

    start: float
    epoch: float
    finish: float


class RunFailedError(Exception):
    """The run could not go on; the message says why. The command line exits with 1."""


class Backend(Protocol):
    """Hosts somewhere: a thin shell without decisions of its own."""

    def open(self) -> int:
        """Get hold of what the hosts need, and give how many there will be.

        Raises
        ------
        InputError, RunFailedError
            When it is not to be had.
        """
        ...

    def begin(self, plans: tuple[HostPlan, ...], deadlines: Deadlines) -> None:
        """Take the plans of the hosts that will be spawned."""
        ...

    def perform(self, instruction: Spawn | Advance | AskStop | Finish) -> None:
        """Do what the archipelago decided."""
        ...

    def wait(self, seconds: float) -> Event | None:
        """Give the next event; ``None`` when there is none within that time."""
        ...

    def summaries(self, epoch: int) -> tuple[IslandSummary, ...]:
        """Give the islands' summaries of an epoch that all hosts have finished, and forget earlier ones."""
        ...

    def interrupt(self) -> None:
        """Be told, possibly from a signal handler, that the run is to stop."""
        ...

    def close(self) -> None:
        """Let go of everything; may be called at any time, more than once."""
        ...
