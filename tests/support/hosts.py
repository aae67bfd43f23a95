"""Several hosts without Ray: each on a thread of its own, posts as direct calls, or late and shuffled ones."""

from __future__ import annotations

import random
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import replace
from pathlib import Path

from islands.host import Host
from islands.orders import Box, HostPlan
from islands.wire import opened, sealed
from orchestrator.archipelago import (
    Advance,
    Archipelago,
    AskStop,
    Begun,
    Conclude,
    Event,
    Finish,
    HostFinished,
    HostReady,
    Report,
    Spawn,
    decide,
)
from orchestrator.backends.protocol import Ledger
from orchestrator.experiment import Experiment
from orchestrator.folder import create
from orchestrator.loading import load_experiment
from orchestrator.plan import host_plans, make_plan


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


def run_on_threads(
    folder: Path,
    data: Path,
    hosts: int,
    *overrides: str,
    storm: int | None = None,
    replay: Path | None = None,
    meanwhile: Callable[[Event, list[Host]], None] = lambda event, hosts: None,
) -> tuple[Path, Conclude]:
    """Run an experiment on so many hosts; give its log and its conclusion.

    Parameters
    ----------
    folder
        Where the run's folder is to stand.
    data
        The experiment.
    storm
        With a number, posts come late and shuffled.
    replay
        The log of a run to repeat.
    meanwhile
        Is called after each event.
    """
    from datetime import UTC, datetime

    loaded = load_experiment(data, overrides)
    experiment: Experiment = loaded.experiment
    made = create(folder, f"on-{hosts}", loaded, datetime.now(UTC), {}, explicit=False)
    changes = {
        "epochs": experiment.length,
        "schedule": experiment.schedule,
        "replay": "" if replay is None else str(replay),
        "patience": 20.0,
    }
    plans = [replace(plan, **changes) for plan in host_plans(loaded, make_plan(loaded), hosts, made.name, made.path)]
    made_hosts: list[Host] = []

    def directly(host: int, packets: Box) -> bool:
        made_hosts[host].deliver(packets)
        return True

    weather = Storm(made_hosts, storm) if storm is not None else None
    made_hosts.extend(Host(plan, post=weather.post if weather else directly) for plan in plans)
    try:
        return made.path / "log", _driven(made_hosts, plans, experiment, meanwhile)
    finally:
        if weather is not None:
            weather.close()


def _answers(calls: deque) -> list[Event]:
    """Wait for answers; those of one host come in order."""
    wait([call for _, call in calls], timeout=60, return_when="FIRST_COMPLETED")
    oldest = {host: (host, call) for host, call in reversed(calls)}
    done = [entry for entry in oldest.values() if entry[1].done()]
    for entry in done:
        calls.remove(entry)
    return [call.result() for _, call in done]


def _driven(
    hosts: list[Host],
    plans: Sequence[HostPlan],
    experiment: Experiment,
    meanwhile: Callable[[Event, list[Host]], None],
) -> Conclude:
    ledger = Ledger()
    state = Archipelago(len(hosts), experiment.length, experiment.schedule)
    pools = [ThreadPoolExecutor(1) for _ in plans]
    events: deque[Event] = deque([Begun()])
    calls: deque = deque()

    def perform(what: Spawn | Advance | Finish) -> Event:
        host = hosts[what.host]
        match what:
            case Spawn():
                host.ready()
                return HostReady(what.host)
            case Advance(_, through, horizon, settled):
                return ledger.advanced(what, host.advance(through, horizon, settled))
            case Finish(_, forms, settled, through):
                host.finish(forms, settled, through)
                return HostFinished(what.host)

    try:
        while True:
            while not events:
                assert calls, "the machine waits for nobody"
                events.extend(_answers(calls))
            event = events.popleft()
            state, instructions = decide(state, event)
            for instruction in instructions:
                match instruction:
                    case Conclude():
                        return instruction
                    case AskStop(host):
                        hosts[host].stop()
                    case Report(epoch):
                        ledger.summaries(epoch)
                    case _:
                        calls.append((instruction.host, pools[instruction.host].submit(perform, instruction)))
            meanwhile(event, hosts)
    finally:
        for host in hosts:
            host.stop()
        for pool in pools:
            pool.shutdown()
