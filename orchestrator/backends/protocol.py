"""What a backend is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, final

from islands.orders import Advanced, HostPlan, Saved
from islands.tally import IslandSummary
from orchestrator.messages import Advance, EpochAbandoned, EpochDone, Event, HostFailed, Order, PartSaved


@dataclass(frozen=True, slots=True)
class Deadlines:
    """Seconds that a host may take to start, for an epoch, to finish, and to say that it is there."""

    start: float
    epoch: float
    finish: float
    silence: float = 60.0


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

    def perform(self, instruction: Order) -> None:
        """Do what the archipelago decided."""
        ...

    def regroup(self, lost: tuple[int, ...], wanted: int) -> int:
        """Make ready for hosts to be spawned anew with other plans; give how many there will be, at most ``wanted``.

        Those that are lost are ended; the processes of others serve again.

        Raises
        ------
        RunFailedError
            When there is room for none.
        """
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
        self._saved: dict[tuple[int, int], Saved] = {}

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

    def saved(self, host: int, epoch: int, part: Saved) -> Event:
        """Take a host's part of a checkpoint and give the event that it is."""
        self._saved[epoch, host] = part
        return PartSaved(host, epoch)

    def parts(self, epoch: int) -> tuple[Saved, ...]:
        """Give the parts of a checkpoint, in the order of hosts; forget them and those before."""
        found = tuple(self._saved[key] for key in sorted(self._saved) if key[0] == epoch)
        self._saved = {key: part for key, part in self._saved.items() if key[0] > epoch}
        return found

    def clear(self) -> None:
        """Forget what hosts told of epochs: they begin anew."""
        self._summaries, self._saved = {}, {}
