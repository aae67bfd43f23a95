"""The backend on Ray: each host an actor, on a local Ray that comes and goes with the run, or on a cluster.

The driver holds references to boxes and hands them on; it never looks into them.
"""

from __future__ import annotations

import logging
import math
import time
from collections import deque
from dataclasses import dataclass
from typing import Any, Final, final

from genome.errors import InputError
from islands.host import HostPlan, IslandSummary, StoppedError
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
from orchestrator.backends.apart import sessions_of_their_own
from orchestrator.backends.cluster import hosts_for, machine_cpus, reach, settle_environment
from orchestrator.backends.protocol import Deadlines, RunFailedError

OBJECT_STORE_BYTES: Final = 100 * 2**20


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
        try:
            with sessions_of_their_own():
                ray.init(**quiet, **(local if self._address is None else {"address": self._address}))
        except SystemExit:
            # Ray has a handler of its own for a SIGTERM that comes while it starts.
            raise KeyboardInterrupt from None
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


def _one_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[0] if lines else type(error).__name__
