"""The backend in this process: one host, called directly. The same results as on Ray, for tests and debugging."""

from __future__ import annotations

from collections import deque
from typing import final

from genome.errors import InputError
from islands.host import Host, HostPlan, IslandSummary, StoppedError
from orchestrator.archipelago import (
    Advance,
    AskStop,
    EpochAbandoned,
    EpochDone,
    Event,
    Finish,
    HostFailed,
    HostFinished,
    HostReady,
    Spawn,
)
from orchestrator.backends.protocol import Deadlines


@final
class InlineBackend:
    """Hosts as plain objects; an instruction is done when ``perform`` returns, so that deadlines mean nothing here."""

    def __init__(self) -> None:
        self._plans: tuple[HostPlan, ...] = ()
        self._hosts: dict[int, Host] = {}
        self._events: deque[Event] = deque()
        self._boxes: dict[tuple[int, int], tuple[object, ...]] = {}
        self._summaries: dict[tuple[int, int], tuple[IslandSummary, ...]] = {}

    def open(self) -> int:
        """Give the number of hosts: one."""
        return 1

    def begin(self, plans: tuple[HostPlan, ...], deadlines: Deadlines) -> None:
        """Take the plans."""
        del deadlines
        self._plans = plans
        self._hosts = {plan.host: Host(plan) for plan in plans}

    def perform(self, instruction: Spawn | Advance | AskStop | Finish) -> None:
        """Do it now and keep the event for ``wait``."""
        host = instruction.host
        try:
            event = self._done(instruction)
        except StoppedError:
            assert isinstance(instruction, Advance)
            event = EpochAbandoned(host, instruction.epoch)
        except InputError as error:
            event = HostFailed(host, str(error), alive=True)
        except Exception as error:  # noqa: BLE001 - whatever a host raises ends the run with a message
            event = HostFailed(host, f"{type(error).__name__}: {error}", alive=True)
        if event is not None:
            self._events.append(event)

    def _done(self, instruction: Spawn | Advance | AskStop | Finish) -> Event | None:
        match instruction:
            case Spawn(host):
                self._hosts[host].ready()
                return HostReady(host)
            case Advance(host, epoch, inboxes):
                boxes = [self._boxes[source, epoch - 1][host] for source in inboxes]
                summaries, *out = self._hosts[host].advance(epoch, *boxes)  # type: ignore[arg-type]
                self._summaries[host, epoch] = summaries
                self._boxes[host, epoch] = tuple(out)
                return EpochDone(host, epoch)
            case AskStop(host):
                self._hosts[host].stop()
                return None
            case Finish(host, forms):
                self._hosts[host].finish(forms)
                return HostFinished(host)

    def wait(self, seconds: float) -> Event | None:
        """Give the oldest event."""
        del seconds
        return self._events.popleft() if self._events else None

    def summaries(self, epoch: int) -> tuple[IslandSummary, ...]:
        """Give the summaries in the order of islands."""
        found = tuple(row for plan in self._plans for row in self._summaries[plan.host, epoch])
        self._summaries = {key: rows for key, rows in self._summaries.items() if key[1] >= epoch}
        self._boxes = {key: boxes for key, boxes in self._boxes.items() if key[1] >= epoch}
        return found

    def interrupt(self) -> None:
        """Ask every host to stop; safe in a signal handler."""
        for host in self._hosts.values():
            host.stop()

    def close(self) -> None:
        """Forget the hosts."""
        self._hosts = {}
