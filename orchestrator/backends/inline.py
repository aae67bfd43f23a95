"""The backend in this process: one host, called directly. The same results as on Ray, for tests and debugging."""

from __future__ import annotations

from collections import deque
from typing import final

from genome.errors import InputError
from islands.host import Host
from islands.orders import HostPlan
from orchestrator.backends.protocol import Deadlines, Ledger
from orchestrator.messages import (
    Advance,
    AskStop,
    Event,
    Finish,
    HostFailed,
    HostFinished,
    HostReady,
    Order,
    Save,
    Spawn,
    Steer,
)


@final
class InlineBackend:
    """Hosts as plain objects; an instruction is done when ``perform`` returns, so that deadlines mean nothing here."""

    def __init__(self) -> None:
        self._hosts: dict[int, Host] = {}
        self._events: deque[Event] = deque()
        self._ledger = Ledger()

    @property
    def ledger(self) -> Ledger:
        """Give what the hosts told of their islands."""
        return self._ledger

    def open(self) -> int:
        """Give the number of hosts: one."""
        return 1

    def begin(self, plans: tuple[HostPlan, ...], deadlines: Deadlines) -> None:
        """Take the plans."""
        del deadlines
        self.close()
        self._hosts = {plan.host: Host(plan) for plan in plans}

    def perform(self, instruction: Order) -> None:
        """Do it now and keep the event for ``wait``."""
        host, part = instruction.host, isinstance(instruction, Save)
        try:
            event = self._done(instruction)
        except InputError as error:
            event = HostFailed(host, str(error), alive=True, part=part)
        except Exception as error:  # noqa: BLE001 - whatever a host raises ends the run with a message
            event = HostFailed(host, f"{type(error).__name__}: {error}", alive=True, part=part)
        if event is not None:
            self._events.append(event)

    def _done(self, instruction: Order) -> Event | None:
        match instruction:
            case Spawn(host):
                self._hosts[host].ready()
                return HostReady(host)
            case Advance(host, through, horizon, settled):
                return self._ledger.advanced(instruction, self._hosts[host].advance(through, horizon, settled))
            case AskStop(host, lost):
                self._hosts[host].stop(lost)
                return None
            case Save(host, epoch):
                return self._ledger.saved(host, epoch, self._hosts[host].checkpoint(epoch))
            case Steer(host, epoch, intervention):
                self._hosts[host].steer(epoch, intervention)
                return None
            case Finish(host, forms, settled, through):
                self._ledger.note(host, through, self._hosts[host].finish(forms, settled, through).summaries)
                return HostFinished(host)

    def regroup(self, lost: tuple[int, ...], wanted: int) -> int:
        """Forget the host: another takes its place."""
        del lost, wanted
        self._events.clear()
        self._ledger.clear()
        return 1

    def wait(self, seconds: float) -> Event | None:
        """Give the oldest event."""
        del seconds
        return self._events.popleft() if self._events else None

    def interrupt(self) -> None:
        """Ask every host to stop; safe in a signal handler."""
        for host in self._hosts.values():
            host.stop()

    def close(self) -> None:
        """Forget the hosts."""
        for host in self._hosts.values():
            host.close()
        self._hosts = {}
