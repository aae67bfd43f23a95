"""The backend on Ray: each host an actor, on a local Ray that comes and goes with the run, or on a cluster.

The driver holds references to boxes and hands them on; it never looks into them.
"""

from __future__ import annotations

import contextlib
import logging
import math
import os
import secrets
import socket
import time
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, final

from genome.errors import InputError
from islands.host import THREAD_VARIABLES, HostPlan, IslandSummary, StoppedError
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
from orchestrator.backends.protocol import Deadlines, RunFailedError

HOSTS_PER_CPU: Final = 4
OBJECT_STORE_BYTES: Final = 100 * 2**20
CONNECT_S: Final = 15.0


def machine_cpus() -> int:
    """Give the CPUs that this process may use: the affinity mask, cut down by a control group's quota."""
    cpus = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)
    with contextlib.suppress(OSError, ValueError):
        quota, period = Path("/sys/fs/cgroup/cpu.max").read_text(encoding="ascii").split()
        if quota != "max":
            cpus = min(cpus, max(1, math.ceil(int(quota) / int(period))))
    return max(1, cpus)


def hosts_for(asked: int | str, islands: int, cpus: int) -> int:
    """Give how many hosts there will be.

    Parameters
    ----------
    asked
        A number, or ``auto`` for as many as CPUs.
    islands
        A host without an island is not made.
    cpus
        CPUs at hand.

    Raises
    ------
    InputError
        When more than four hosts for each CPU are asked for.
    """
    if isinstance(asked, str):
        return min(cpus, islands)
    if asked > HOSTS_PER_CPU * cpus:
        expected = f"at most {HOSTS_PER_CPU * cpus} hosts on {cpus} CPU{'s' if cpus > 1 else ''}"
        raise InputError("hosts", expected, str(asked), "set hosts: auto, or run on a larger machine")
    return min(asked, islands)


@dataclass(frozen=True, slots=True)
class _Pending:
    what: Spawn | Advance | Finish
    deadline: float
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
        self._boxes: dict[tuple[int, int], list[Any]] = {}
        self._summaries: dict[tuple[int, int], tuple[IslandSummary, ...]] = {}
        self._events: deque[Event] = deque()

    def open(self) -> int:
        """Start a local Ray or connect, make sure that the hosts can be placed, and give their number.

        Raises
        ------
        InputError
            When more hosts are asked for than there is room for.
        RunFailedError
            When Ray does not start, or the cluster is not reached or has no CPU free.
        """
        if self._address is None:
            self._cpus = machine_cpus()
            self._count = hosts_for(self._asked, self._islands, self._cpus)
        _settle_environment(local=self._address is None)
        import ray

        if ray.is_initialized():
            raise RunFailedError("Ray is already running in this process; a run needs one of its own")
        if self._address is not None:
            _reach(self._address)
        quiet: dict[str, Any] = {"log_to_driver": False, "logging_level": logging.ERROR}
        local: dict[str, Any] = {
            "address": "local",
            "num_cpus": self._cpus,
            "include_dashboard": False,
            "object_store_memory": OBJECT_STORE_BYTES,
        }
        self._opened = True
        try:
            ray.init(**quiet, **(local if self._address is None else {"address": self._address}))
        except Exception as error:  # noqa: BLE001 - Ray's start raises errors of many kinds
            where = "Ray did not start" if self._address is None else f"no Ray cluster at {self._address}"
            raise RunFailedError(f"{where}: {_one_line(error)}") from None
        if self._address is not None:
            resources: Any = ray.available_resources
            self._cpus = math.floor(resources().get("CPU", 0.0))
            if self._cpus < 1:
                raise RunFailedError(f"the cluster at {self._address} has no CPU free; wait, or make it larger")
            self._count = hosts_for(self._asked, self._islands, self._cpus)
        return self._count

    def begin(self, plans: tuple[HostPlan, ...], deadlines: Deadlines) -> None:
        """Take the plans."""
        self._plans = plans
        self._deadlines = deadlines

    def perform(self, instruction: Spawn | Advance | AskStop | Finish) -> None:
        """Submit it; the event comes from ``wait``."""
        match instruction:
            case Spawn(host):
                from islands.actor import host_actor

                share = math.floor(min(1.0, self._cpus / self._count) * 1e4) / 1e4
                self._actors[host] = host_actor(share).remote(self._plans[host])
                self._expect(self._actors[host].ready.remote(), instruction, self._deadlines.start)
            case Advance(host, epoch, inboxes):
                boxes = [self._boxes[source, epoch - 1][host] for source in inboxes]
                step = self._actors[host].advance.options(num_returns=1 + self._count)
                summary, *out = step.remote(epoch, *boxes)
                self._boxes[host, epoch] = out
                self._expect(summary, instruction, self._deadlines.epoch)
            case AskStop(host):
                from islands.actor import CONTROL

                self._actors[host].stop.options(concurrency_group=CONTROL).remote()
            case Finish(host, forms):
                self._expect(self._actors[host].finish.remote(forms), instruction, self._deadlines.finish)

    def _expect(self, reference: Any, what: Spawn | Advance | Finish, seconds: float) -> None:  # noqa: ANN401
        self._pending[reference] = _Pending(what, time.monotonic() + seconds, seconds)

    def wait(self, seconds: float) -> Event | None:
        """Give the next answer, death, or passed deadline."""
        import ray

        if self._events:
            return self._events.popleft()
        if not self._pending:
            time.sleep(seconds)
            return None
        done, _ = ray.wait(list(self._pending), num_returns=1, timeout=seconds)
        for reference in done:
            self._events.append(self._answer(reference, self._pending.pop(reference)))
        if not done:
            now = time.monotonic()
            for reference, pending in list(self._pending.items()):
                if now > pending.deadline:
                    del self._pending[reference]
                    host = pending.what.host
                    text = f"host {host} did not {_doing(pending.what)} within {pending.seconds:g} s"
                    self._events.append(HostFailed(host, text, alive=False))
        return self._events.popleft() if self._events else None

    def _answer(self, reference: Any, pending: _Pending) -> Event:  # noqa: ANN401 - Ray's references
        import ray

        host = pending.what.host
        try:
            value = ray.get(reference, timeout=30)
        except ray.exceptions.RayTaskError as error:
            cause = error.cause
            if isinstance(cause, StoppedError) and isinstance(pending.what, Advance):
                return EpochAbandoned(host, pending.what.epoch)
            text = str(cause) if isinstance(cause, InputError) else f"{type(cause).__name__}: {cause}"
            return HostFailed(host, f"host {host} could not {_doing(pending.what)}: {text}", alive=True)
        except ray.exceptions.RayActorError as error:
            text = f"host {host} died and could not {_doing(pending.what)} ({_one_line(error)})"
            return HostFailed(host, text, alive=False)
        except ray.exceptions.RayError as error:
            return HostFailed(host, f"host {host} did not {_doing(pending.what)}: {_one_line(error)}", alive=False)
        match pending.what:
            case Spawn():
                return HostReady(host)
            case Advance(_, epoch):
                self._summaries[host, epoch] = value
                return EpochDone(host, epoch)
            case Finish():
                return HostFinished(host)

    def summaries(self, epoch: int) -> tuple[IslandSummary, ...]:
        """Give the summaries in the order of islands."""
        found = tuple(row for plan in self._plans for row in self._summaries[plan.host, epoch])
        self._summaries = {key: rows for key, rows in self._summaries.items() if key[1] >= epoch}
        self._boxes = {key: boxes for key, boxes in self._boxes.items() if key[1] >= epoch}
        return found

    def interrupt(self) -> None:
        """Nothing: the loop sees the wish to stop within its next wait."""

    def close(self) -> None:
        """Shut Ray down, or leave the cluster."""
        if not self._opened:
            return
        self._opened = False
        import ray

        self._pending, self._boxes, self._actors = {}, {}, {}
        ray.shutdown()


def _doing(what: Spawn | Advance | Finish) -> str:
    match what:
        case Spawn():
            return "start"
        case Advance(_, epoch):
            return f"finish epoch {epoch}"
        case Finish():
            return "write its log"


def _settle_environment(*, local: bool) -> None:
    """Set what Ray reads when it is imported and started, except where the user has set it.

    A local Ray gets a token of its own through the environment: without one it would be open to other users of the
    machine, or leave a token file in the home folder.
    """
    settings = {
        "RAY_USAGE_STATS_ENABLED": "0",
        "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO": "0",
        # A host that is asked to stop fails its call on purpose; the boxes of that call are never fetched.
        "RAY_IGNORE_UNHANDLED_ERRORS": "1",
    }
    if local:
        settings |= dict.fromkeys(THREAD_VARIABLES, "1")
        if not any(name in os.environ for name in ("RAY_AUTH_MODE", "RAY_AUTH_TOKEN", "RAY_AUTH_TOKEN_PATH")):
            settings |= {"RAY_AUTH_MODE": "token", "RAY_AUTH_TOKEN": secrets.token_hex(32)}
    for name, value in settings.items():
        os.environ.setdefault(name, value)


def _reach(address: str) -> None:
    """Try the address before Ray does, which would wait for minutes.

    Raises
    ------
    InputError
        When the address has no form that Ray takes.
    RunFailedError
        When nothing answers there.
    """
    if address == "auto" or "://" in address:
        return
    host, _, port = address.rpartition(":")
    if not host or not port.isdecimal():
        raise InputError("--address", "host:port, ray://host:port or auto", f"'{address}'")
    try:
        socket.create_connection((host, int(port)), timeout=CONNECT_S).close()
    except (OSError, OverflowError) as error:
        raise RunFailedError(f"no Ray cluster at {address}: {error}; check the address, or start it") from None


def _one_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[0] if lines else type(error).__name__
