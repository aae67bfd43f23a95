"""Several hosts without Ray: each on a thread of its own, posts as direct calls, or late and shuffled ones.

They are a backend, so that the driver itself is at work: a test can lose a host at any event, or break the driver off.
"""

from __future__ import annotations

import random
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path

from experiments import Silent
from genome.errors import InputError
from islands.host import Host
from islands.orders import Box, HostPlan
from islands.wire import opened, sealed
from orchestrator.backends.protocol import Deadlines, Ledger
from orchestrator.drive import Outcome
from orchestrator.folder import open_run
from orchestrator.loading import load_experiment
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
from orchestrator.resume import resumable, resume
from orchestrator.run import run_experiment

QUICK = ("checkpoint.every=2", "checkpoint.spacing=0", "deadlines.epoch=5")
"""Settings for tests: a checkpoint of every other epoch, and hosts that wait for 20 s in vain."""


class BrokenOffError(Exception):
    """The driver is killed, as far as a test can."""


class Storm:
    """Delivers packets one by one, in any order, some of them twice, each after a moment."""

    def __init__(self, hosts: Sequence[Host], seed: int) -> None:
        self._hosts, self._rng = hosts, random.Random(seed)
        self._lock, self._held, self._over = threading.Lock(), [], threading.Event()
        self._thread = threading.Thread(target=self._blow)
        self._thread.start()

    def post(self, host: int, packets: Box) -> bool:
        with self._lock:
            self._held.extend((host, packet) for packet in opened(sealed(packets)))
        return True

    def _blow(self) -> None:
        while not self._over.is_set():
            with self._lock:
                self._rng.shuffle(self._held)
                gone = [self._held.pop() for _ in range(self._rng.randint(0, len(self._held)))]
                gone.extend(self._rng.sample(gone, len(gone) // 3))
            for host, packet in gone:
                self._hosts[host].deliver((packet,))
            time.sleep(self._rng.random() * 0.002)

    def close(self) -> None:
        self._over.set()
        self._thread.join()


@dataclass
class Seat:
    """A host and its thread."""

    host: Host
    pool: ThreadPoolExecutor
    gone: bool = False


Meanwhile = Callable[[Event, "ThreadBackend"], None]


class ThreadBackend:
    """Hosts on threads; see the module's docstring.

    Parameters
    ----------
    hosts
        How many.
    storm
        With a number, posts come late and shuffled.
    meanwhile
        Is called with each event before the driver hears of it.
    """

    def __init__(self, hosts: int, storm: int | None, meanwhile: Meanwhile) -> None:
        self._count, self._storm, self._meanwhile = hosts, storm, meanwhile
        self._weather: Storm | None = None
        self._plans: tuple[HostPlan, ...] = ()
        self._seats: list[Seat] = []
        self._calls: deque[tuple[int, Future[Event | None]]] = deque()
        self._events: deque[Event] = deque()
        self._ledger = Ledger()
        self.rounds = 0

    @property
    def ledger(self) -> Ledger:
        return self._ledger

    @property
    def hosts(self) -> list[Host]:
        return [seat.host for seat in self._seats]

    def open(self) -> int:
        return self._count

    def begin(self, plans: tuple[HostPlan, ...], deadlines: Deadlines) -> None:
        del deadlines
        self._plans, hosts = plans, []
        self._weather = Storm(hosts, self._storm) if self._storm is not None else None
        post = self._weather.post if self._weather else self._directly
        hosts.extend(Host(plan, post=post) for plan in plans)
        self._seats = [Seat(host, ThreadPoolExecutor(1)) for host in hosts]
        self.rounds += 1

    def _directly(self, host: int, packets: Box) -> bool:
        self._seats[host].host.deliver(packets)
        return True

    def perform(self, instruction: Order) -> None:
        seat = self._seats[instruction.host]
        if seat.gone:  # the driver does not know it yet
            return
        if isinstance(instruction, AskStop):
            seat.host.stop(instruction.lost)
            return
        call = seat.pool.submit(self._done, seat.host, instruction)
        if not isinstance(instruction, Steer):
            self._calls.append((instruction.host, call))

    def _done(self, host: Host, what: Order) -> Event | None:
        try:
            match what:
                case Spawn():
                    host.ready()
                    return HostReady(what.host)
                case Advance(_, through, horizon, settled):
                    return self._ledger.advanced(what, host.advance(through, horizon, settled))
                case Save(number, epoch):
                    return self._ledger.saved(number, epoch, host.checkpoint(epoch))
                case Steer(_, epoch, intervention):
                    host.steer(epoch, intervention)
                case Finish(number, forms, settled, through):
                    self._ledger.note(number, through, host.finish(forms, settled, through).summaries)
                    return HostFinished(number)
        except Exception as error:  # noqa: BLE001 - as a backend takes whatever a host raises
            text = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
            return HostFailed(what.host, text, alive=True, part=isinstance(what, Save))
        return None

    def lose(self, host: int) -> None:
        """Lose a host: it answers no more; what it is at it may still do, until all begin anew."""
        self._seats[host].gone = True
        self._calls = deque(entry for entry in self._calls if entry[0] != host)
        self._events = deque(event for event in self._events if event.host != host)
        self._events.append(HostFailed(host, f"host {host} died", alive=False))

    def regroup(self, lost: tuple[int, ...], wanted: int) -> int:
        """Throw all hosts away; there is room for others in place of those that were lost."""
        # More may have gone since the driver was told.
        assert set(lost) <= {place for place, seat in enumerate(self._seats) if seat.gone}
        self._sweep()
        self._ledger.clear()
        return wanted

    def wait(self, seconds: float) -> Event | None:
        """Give the next answer; those of one host come in order."""
        if not self._events and self._calls:
            wait([call for _, call in self._calls], timeout=seconds, return_when="FIRST_COMPLETED")
            oldest = {host: (host, call) for host, call in reversed(self._calls)}
            for entry in [entry for entry in oldest.values() if entry[1].done()]:
                self._calls.remove(entry)
                event = entry[1].result()
                assert event is not None
                self._events.append(event)
        if not self._events:
            return None
        event = self._events.popleft()
        if not self._seats[event.host].gone:
            self._meanwhile(event, self)
        return event

    def interrupt(self) -> None:
        for seat in self._seats:
            seat.host.stop()

    def _sweep(self) -> None:
        for seat in self._seats:
            seat.host.stop(lost=True)
        for seat in self._seats:
            seat.pool.shutdown()
        if self._weather is not None:
            self._weather.close()
            self._weather = None
        self._calls.clear()
        self._events.clear()
        self._seats = []

    def close(self) -> None:
        self._sweep()


def run_on_threads(
    folder: Path,
    data: Path,
    hosts: int,
    *overrides: str,
    storm: int | None = None,
    replay: Path | None = None,
    meanwhile: Meanwhile = lambda event, backend: None,
) -> tuple[Path, Outcome]:
    """Run an experiment on so many hosts; give its log and what came of it.

    Parameters
    ----------
    folder
        Where the run's folder is to stand.
    data
        The experiment.
    storm, meanwhile
        See :class:`ThreadBackend`.
    replay
        The log of a run to repeat.
    """
    loaded = load_experiment(data, (*QUICK, *overrides))
    backend = ThreadBackend(hosts, storm, meanwhile)
    before = None if replay is None else open_run(str(replay.parent))
    outcome = run_experiment(loaded, backend, folder, None, Silent(), before)
    return outcome.folder / "log", outcome


def resume_on_threads(
    folder: Path,
    hosts: int,
    *overrides: str,
    storm: int | None = None,
    meanwhile: Meanwhile = lambda event, backend: None,
) -> tuple[Path, Outcome]:
    """Go on with the run in a folder, on so many hosts."""
    run = open_run(str(folder))
    outcome = resume(run, resumable(run, overrides), ThreadBackend(hosts, storm, meanwhile), Silent())
    return outcome.folder / "log", outcome
