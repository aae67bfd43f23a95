"""What a backend is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, final

from islands.orders import Advanced, HostPlan
from islands.tally import IslandSummary
from orchestrator.messages import Advance, AskStop, EpochAbandoned, EpochDone, Event, Finish, HostFailed, Spawn


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

    @property
    def ledger(self) -> Ledger:
        """Give what the hosts told of their islands."""
        ...

    def interrupt(self) -> None:
        """Be told, possibly from a signal handler, that the run is to stop."""
        ...

    def close(self) -> None:
        """Let go of everything; may be called at any time, more than once."""
        ...


@final
class Ledger:
    """What hosts told of their islands, until it is reported.

    Attributes
    ----------
    busy_s
        Seconds that all hosts together have spent on stepping islands.
    """

    def __init__(self) -> None:
        self.busy_s = 0.0
        self._summaries: dict[tuple[int, int], tuple[IslandSummary, ...]] = {}

    def advanced(self, call: Advance, found: Advanced) -> Event:
        """Take a host's answer to a call and give the event that it is."""
        self.busy_s += found.busy_s
        if found.stopped:
            return EpochAbandoned(call.host, found.epoch)
        if found.trouble:
            return HostFailed(call.host, found.trouble, alive=True, epoch=found.epoch)
        self.note(call.host, call.through, found.summaries)
        return EpochDone(call.host, call.through, found.busy_s + found.waited_s)

    def note(self, host: int, epoch: int, summaries: tuple[IslandSummary, ...]) -> None:
        """Take the summaries of a host's islands at an epoch's end."""
        self._summaries[host, epoch] = summaries

    def summaries(self, epoch: int) -> tuple[IslandSummary, ...]:
        """Give the summaries of an epoch that all hosts have finished, in the order of islands; forget earlier ones."""
        found = tuple(row for key in sorted(self._summaries) if key[1] == epoch for row in self._summaries[key])
        self._summaries = {key: rows for key, rows in self._summaries.items() if key[1] > epoch}
        return found
