"""The backend on Ray: each host an actor, on a local Ray that comes and goes with the run, or on a cluster.

Hosts know each other's actors and post to each other directly: the driver sees no packet.
"""

from __future__ import annotations

import contextlib
import logging
import math
import os
import signal
import tempfile
import time
from collections import deque
from dataclasses import dataclass, replace
from typing import Any, Final, final

from genome.errors import InputError
from islands.orders import HostPlan, Step
from orchestrator.backends.apart import sessions_of_their_own
from orchestrator.backends.cluster import hosts_for, hush, machine_cpus, reach, send_home_helpers, settle_environment
from orchestrator.backends.protocol import Deadlines, Ledger, RunFailedError
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
from orchestrator.preflight import preflight

OBJECT_STORE_BYTES: Final = 100 * 2**20

PING_S: Final = 5.0
"""Seconds between two questions to a busy host whether it is there."""

ROOM_S: Final = 10.0
"""A CPU of a host that was ended is free again within this time, unless its machine is gone."""

MOST_NAMED: Final = 3
"""Islands of a host that died which are named."""

ANSWER_S: Final = 5.0
"""A host that is asked what it is at says so within this time, however busy it is, unless it hangs for good."""


@dataclass(frozen=True, slots=True)
class _Pending:
    what: Spawn | Advance | Save | Finish
    seconds: float


@final
class RayBackend:
    """Hosts as Ray actors.

    Parameters
    ----------
    asked
        How many hosts were asked for: a number, or ``auto``.
    islands
        How many islands there are.
    address
        A running cluster's address; ``None`` starts a local Ray.
    """

    def __init__(self, asked: int | str, islands: int, address: str | None = None) -> None:
        self._asked = asked
        self._islands = islands
        self._count = 0
        self._cpus = 0
        self._address = address
        self._opened = False
        self._plans: tuple[HostPlan, ...] = ()
        self._deadlines = Deadlines(0, 0, 0)
        self._actors: dict[int, Any] = {}
        self._pending: dict[Any, _Pending] = {}
        self._addresses: dict[int, Any] = {}
        self._told: dict[int, int] = {}
        # When the oldest call of each host began.
        self._since: dict[int, float] = {}
        # Where the letterboxes of a local Ray stand: here, so that they go with the driver whatever becomes of hosts.
        self._mail: tempfile.TemporaryDirectory[str] | None = None
        self._connected = False
        self._pings: dict[int, tuple[float, Any]] = {}
        self._share = 1.0
        self._events: deque[Event] = deque()
        self._ledger = Ledger()

    @property
    def ledger(self) -> Ledger:
        """Give what the hosts told of their islands."""
        return self._ledger

    def open(self) -> int:
        """Start a local Ray or connect, make sure that the hosts can be placed, and give their number.

        Raises
        ------
        InputError
            When more hosts are asked for than there is room for.
        RunFailedError
            When Ray does not start, or the cluster is not reached or has no CPU free.
        KeyboardInterrupt
            On a SIGTERM while Ray starts.
        """
        if self._address is None:
            self._cpus = machine_cpus()
            self._count = hosts_for(self._asked, self._islands, self._cpus)
        settle_environment(local=self._address is None)
        import ray

        if ray.is_initialized():
            raise RunFailedError("Ray is already running in this process; a run needs one of its own")
        if self._address is not None:
            reach(self._address)
        quiet: dict[str, Any] = {"log_to_driver": False, "logging_level": logging.ERROR}
        local: dict[str, Any] = {
            "address": "local",
            "num_cpus": self._cpus,
            "include_dashboard": False,
            "object_store_memory": OBJECT_STORE_BYTES,
        }
        self._opened = True
        hush()
        try:
            with sessions_of_their_own():
                ray.init(**quiet, **(local if self._address is None else {"address": self._address}))
        except SystemExit:
            # Ray has a handler of its own for a SIGTERM that comes while it starts.
            raise KeyboardInterrupt from None
        except Exception as error:  # noqa: BLE001 - Ray's start raises errors of many kinds
            where = "Ray did not start" if self._address is None else f"no Ray cluster at {self._address}"
            raise RunFailedError(f"{where}: {_one_line(error)}") from None
        if self._address is None:
            send_home_helpers()
        if self._address is not None:
            resources: Any = ray.available_resources
            self._cpus = math.floor(resources().get("CPU", 0.0))
            if self._cpus < 1:
                raise RunFailedError(f"the cluster at {self._address} has no CPU free; wait, or make it larger")
            self._count = hosts_for(self._asked, self._islands, self._cpus)
        return self._count

    def begin(self, plans: tuple[HostPlan, ...], deadlines: Deadlines) -> None:
        """Take the plans; on a cluster, the first time, ask each of its machines whether it can take part.

        Raises
        ------
        RunFailedError
            When one cannot.
        """
        first = not self._plans
        self._plans = plans
        self._deadlines = deadlines
        if first and self._address is not None:
            preflight(plans)

    def perform(self, instruction: Order) -> None:
        """Submit it; the event comes from ``wait``."""
        match instruction:
            case Spawn(host):
                from islands.actor import host_actor

                self._share = math.floor(min(1.0, self._cpus / self._count) * 1e4) / 1e4
                if self._address is None and self._mail is None:
                    self._mail = tempfile.TemporaryDirectory(prefix="atoll-")
                mail = "" if self._mail is None else self._mail.name
                if host in self._actors:
                    call = self._actors[host].restart.remote(self._plans[host], mail)
                else:
                    self._actors[host] = host_actor(self._share).remote(self._plans[host], mail)
                    call = self._actors[host].ready.remote()
                self._expect(call, instruction, self._deadlines.start)
            case Advance(host, through, horizon, settled):
                self._connect()
                call = self._actors[host].advance.remote(through, horizon, settled)
                self._expect(call, instruction, self._patience(host, through))
            case AskStop(host, lost):
                from islands.actor import CONTROL

                self._actors[host].stop.options(concurrency_group=CONTROL).remote(self._plans[host].round, lost)
            case Save(host, epoch):
                self._expect(self._actors[host].checkpoint.remote(epoch), instruction, self._deadlines.finish)
            case Steer(host, epoch, intervention):
                self._actors[host].steer.remote(epoch, intervention)
            case Finish(host, forms, settled, through):
                call = self._actors[host].finish.remote(forms, settled, through)
                self._expect(call, instruction, self._deadlines.finish)

    def _connect(self) -> None:
        """Let every host know those that it exchanges with, before the first of them steps."""
        if self._connected:
            return
        self._connected = True
        everyone = {host: (actor, self._addresses[host]) for host, actor in self._actors.items()}
        for host, actor in self._actors.items():
            actor.connect.remote({other: everyone[other] for other in self._plans[host].neighbours})

    def _patience(self, host: int, through: int) -> float:
        """Give how long a call may take; calls of several epochs are made where these took a moment together."""
        epochs = through - self._told.get(host, -1)
        self._told[host] = through
        return self._deadlines.epoch * min(epochs, 2)

    def _expect(self, reference: Any, what: Spawn | Advance | Save | Finish, seconds: float) -> None:  # noqa: ANN401
        if all(pending.what.host != what.host for pending in self._pending.values()):
            self._since[what.host] = time.monotonic()
        self._pending[reference] = _Pending(what, seconds)

    def wait(self, seconds: float) -> Event | None:
        """Give the next answer, death, or passed deadline."""
        import ray

        if self._events:
            return self._events.popleft()
        if not self._pending:
            time.sleep(seconds)
            return None
        # Of each host the oldest call alone: answers to two calls may come in any order.
        oldest = {pending.what.host: reference for reference, pending in reversed(self._pending.items())}
        done, _ = ray.wait(list(oldest.values()), num_returns=1, timeout=seconds)
        for reference in done:
            pending = self._pending.pop(reference)
            # A host's calls come one after the other: the next one's time begins here.
            self._since[pending.what.host] = time.monotonic()
            self._events.append(self._answer(reference, pending))
        for host, reference in oldest.items():
            if reference in self._pending:
                if time.monotonic() > self._since[host] + self._pending[reference].seconds:
                    self._overdue(host, self._pending[reference])
                elif self._is_silent(host):
                    text = f"host {host} has answered nothing for {self._deadlines.silence:g} s: it hangs or is gone"
                    self._give_up(host, text)
        return self._events.popleft() if self._events else None

    def _is_silent(self, host: int) -> bool:
        """Ask a host now and then whether it is there; tell whether it has not answered for too long."""
        import ray

        from islands.actor import CONTROL

        now, every = time.monotonic(), min(PING_S, self._deadlines.silence / 4)
        asked, question = self._pings.get(host, (self._since[host], None))
        if question is None:
            if host in self._addresses and now > asked + every:
                self._pings[host] = (now, self._actors[host].step.options(concurrency_group=CONTROL).remote())
            return False
        if ray.wait([question], timeout=0)[0]:
            self._pings[host] = (now, None)
            return False
        return now > asked + self._deadlines.silence

    def _give_up(self, host: int, text: str) -> None:
        self._pending = {other: one for other, one in self._pending.items() if one.what.host != host}
        self._events.append(HostFailed(host, text, alive=False))

    def _overdue(self, host: int, pending: _Pending) -> None:
        """Give a host up that has not answered in time, unless it is others that it waits for."""
        step = self._step_of(host) if isinstance(pending.what, Advance) else None
        if step is not None and not step.island:
            self._since[host] = time.monotonic()
            return
        text = f"host {host} did not {_doing(pending.what)} within {pending.seconds:g} s"
        if step is not None:
            text += f" (it has been in epoch {step.epoch} of island {step.island} for {step.seconds:.1f} s)"
        self._give_up(host, text)

    def _step_of(self, host: int) -> Step | None:
        """Ask a host what it is at; ``None`` when it does not even say that."""
        import ray

        from islands.actor import CONTROL

        asked = self._actors[host].step.options(concurrency_group=CONTROL).remote()
        try:
            found = ray.get(asked, timeout=ANSWER_S)
        except ray.exceptions.RayError:
            return None
        assert isinstance(found, Step)
        return found

    def _answer(self, reference: Any, pending: _Pending) -> Event:  # noqa: ANN401 - Ray's references
        import ray

        host = pending.what.host
        try:
            value = ray.get(reference, timeout=30)
        except ray.exceptions.RayTaskError as error:
            cause = error.cause
            text = str(cause) if isinstance(cause, InputError) else f"{type(cause).__name__}: {cause}"
            part = isinstance(pending.what, Save)
            return HostFailed(host, f"host {host} could not {_doing(pending.what)}: {text}", alive=True, part=part)
        except ray.exceptions.RayActorError as error:
            text = f"host {host} died and could not {_doing(pending.what)} ({_one_line(error)}{self._holding(host)})"
            return HostFailed(host, text, alive=False)
        except ray.exceptions.RayError as error:
            return HostFailed(host, f"host {host} did not {_doing(pending.what)}: {_one_line(error)}", alive=False)
        match pending.what:
            case Spawn():
                self._addresses[host] = value
                return HostReady(host)
            case Advance():
                event = self._ledger.advanced(pending.what, value)
                if isinstance(event, HostFailed):
                    event = replace(event, reason=f"host {host} could not {_doing(pending.what)}: {event.reason}")
                return event
            case Save(_, epoch):
                return self._ledger.saved(host, epoch, value)
            case Finish():
                self._ledger.note(host, pending.what.through, value.summaries)
                return HostFinished(host)

    def _holding(self, host: int) -> str:
        """Name some of a host's islands: what kills it may be one of them."""
        names = [spec.name for spec in self._plans[host].islands]
        more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
        return f"; it held {', '.join(names[:MOST_NAMED])}{more}"

    def regroup(self, lost: tuple[int, ...], wanted: int) -> int:
        """End the actors that are lost, and give how many hosts there is room for.

        Raises
        ------
        RunFailedError
            When there is room for none.
        """
        for host in lost:
            self._end(host)
        left = [self._actors[host] for host in sorted(self._actors)]
        self._actors = dict(enumerate(left[:wanted]))
        self._pending, self._addresses, self._told, self._since, self._pings = {}, {}, {}, {}, {}
        self._connected = False
        self._events.clear()
        self._ledger.clear()
        missing = wanted - len(self._actors)
        fresh = self._room(missing) if missing else 0
        if not self._actors and not fresh:
            raise RunFailedError("no host is left, and Ray has no room for another; go on later with atoll resume")
        return len(self._actors) + fresh

    def _room(self, missing: int) -> int:
        """Give for how many more hosts there are CPUs, at most so many; what was just freed takes a moment to be so."""
        import ray

        resources: Any = ray.available_resources
        ends = time.monotonic() + ROOM_S
        while True:
            room = math.floor(resources().get("CPU", 0.0) / self._share + 1e-6)
            if room >= missing or time.monotonic() > ends:
                return int(min(room, missing))
            time.sleep(0.1)

    def _end(self, host: int) -> None:
        """End a host for good, also one that hangs or was stopped by a signal: it must never write again."""
        import ray

        actor, address = self._actors.pop(host), self._addresses.get(host)
        with contextlib.suppress(Exception):
            ray.kill(actor, no_restart=True)
        here = ray.get_runtime_context().get_node_id()
        if address is not None and address.machine == here and address.process:
            with contextlib.suppress(OSError):
                os.kill(address.process, signal.SIGKILL)

    def interrupt(self) -> None:
        """Nothing: the loop sees the wish to stop within its next wait."""

    def close(self) -> None:
        """Shut Ray down, or leave the cluster."""
        if not self._opened:
            return
        self._opened = False
        import ray

        self._pending, self._actors = {}, {}
        ray.shutdown()
        if self._mail is not None:
            self._mail.cleanup()
            self._mail = None


def _doing(what: Spawn | Advance | Save | Finish) -> str:
    match what:
        case Spawn():
            return "start"
        case Advance(_, through):
            return f"finish epoch {through}"
        case Save(_, epoch):
            return f"write its part of the checkpoint of epoch {epoch}"
        case Finish():
            return "write its log"


def _one_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[0] if lines else type(error).__name__
