"""A run from beginning to end: checks, folder, the loop of events and instructions, and the verdict."""

from __future__ import annotations

import contextlib
import threading
import time
from collections import deque
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

from evaluators.plugins import guarded
from genome.errors import InputError
from genome.settings import describe
from islands.host import HostPlan
from islands.kinds.registry import resolve_kind
from islands.kinds.trade import check_biology
from islands.log import Event as LogEvent
from islands.log import events_table, write
from islands.migration.channel import Channel
from islands.store import Store, StoreError
from islands.tally import IslandSummary
from orchestrator import archipelago as machine
from orchestrator.backends.protocol import Backend, Deadlines, RunFailedError
from orchestrator.folder import MANIFEST, RunFolder, Runs, choose_name, create, on_disk, remove
from orchestrator.loading import Loaded, load_experiment
from orchestrator.plan import Plan, host_plans, make_plan
from orchestrator.progress import Progress
from orchestrator.signals import Signals

POLL_S: Final = 0.25
PATIENCE: Final = 4
LEAST_EPOCH_S: Final = 600.0
MOST_EPOCH_S: Final = 86_400.0


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of a run.

    Attributes
    ----------
    store
        The run's folder; it does not exist when the run failed before its first populations were scored.
    status, reason
        How it ended, and why.
    islands, generations, evaluations
        How many islands; generations that all of them finished; scorings done until then.
    best
        The best individual bred until then, still a member or not: island, id, fitness; ``None`` when all were invalid.
    wall_s, startup_s
        Wall time from start to end, and of it the time until all hosts stood.
    stepped_s, busy
        Wall time from then until all hosts had come to their last epoch, and the share of it that they spent on
        stepping islands.
    """

    store: Store
    status: machine.Status
    reason: str
    islands: int
    generations: int
    evaluations: int
    best: dict[str, Any] | None
    wall_s: float
    startup_s: float
    stepped_s: float
    busy: float

    @property
    def folder(self) -> Path:
        """The run's folder on the local disk where it stands."""
        return on_disk(self.store)


def seconds_of(plan: Plan) -> dict[str, float]:
    """Build the biology of each group of islands once, as hosts will; give what one evaluation may take in seconds.

    Raises
    ------
    InputError
        For whatever is wrong with their settings and the files that these name, and for a kind that cannot make use of
        what channels bring.
    """
    groups = {spec.group: spec for spec in plan.islands}
    channels = _channels_into(plan)
    seconds = {}
    for name, spec in groups.items():
        with guarded(spec.where("kind"), "an island kind that can be built", describe(spec.kind)):
            biology = resolve_kind(spec.kind, spec.where("kind")).build(spec, time.perf_counter)
            check_biology(biology, spec, channels.get(name, ()))
            seconds[name] = float(biology.seconds)
    return seconds


def _channels_into(plan: Plan) -> dict[str, list[Channel]]:
    """Give for each group of islands the channels of other kinds than migrants that reach one of it, by number."""
    found: dict[str, set[Channel]] = {}
    ends = [(edge.target, edge.channel) for edge in plan.edges]
    ends += [(number, redrawn.channel) for redrawn in plan.redrawn for number, _ in redrawn.members]
    for number, channel in ends:
        if channel.kind != "migrants":
            found.setdefault(plan.islands[number].group, set()).add(channel)
    return {group: sorted(channels, key=lambda channel: channel.number) for group, channels in found.items()}


def prepare(loaded: Loaded) -> tuple[Plan, dict[str, float]]:
    """Make the plan and check all that can be checked before a host stands; give the plan and ``seconds_of`` it.

    Raises
    ------
    InputError
        For the first thing that is wrong, with its line in the file.
    """
    try:
        plan = make_plan(loaded)
        return plan, seconds_of(plan)
    except InputError as error:
        raise loaded.locate(error) from None


def make_backend(loaded: Loaded, address: str | None) -> Backend:
    """Give the backend that an experiment asks for.

    Raises
    ------
    InputError
        When the machine has too few CPUs for its hosts, the address has no form that a driver can take, or one is given
        to the in-process backend.
    """
    from orchestrator.backends.cluster import check_address, hosts_for, machine_cpus
    from orchestrator.backends.inline import InlineBackend
    from orchestrator.backends.ray import RayBackend

    experiment = loaded.experiment
    islands = sum(settings.count for settings in experiment.islands.values())
    if experiment.backend == "inline":
        if address is not None:
            raise InputError("--address", "no address with backend: inline", f"'{address}'", "set backend: ray")
        return InlineBackend()
    if address is not None:
        check_address(address)
    else:
        try:
            hosts_for(experiment.hosts, islands, machine_cpus())
        except InputError as error:
            where = f"{loaded.source}: hosts"
            raise loaded.locate(InputError(where, error.expected, error.got, error.remedy)) from None
    return RayBackend(experiment.hosts, islands, address)


def run_experiment(
    loaded: Loaded,
    backend: Backend,
    runs_dir: Runs,
    name: str | None,
    progress: Progress,
    replay: RunFolder | None = None,
) -> Outcome:
    """Run an experiment.

    Parameters
    ----------
    loaded
        The resolved experiment, checked.
    backend
        Where the hosts are to be.
    runs_dir
        Where run folders stand.
    name
        The run's name, if one was asked for.
    progress
        Is told how it goes.
    replay
        The run that this one is to repeat, if any.

    Raises
    ------
    InputError, RunFailedError
        When it cannot start; there is no folder then.
    KeyboardInterrupt
        On a second Ctrl-C, and on a first one before the run has a folder.
    """
    started, clock = datetime.now(UTC), time.perf_counter()
    plan, seconds = prepare(loaded)
    explicit, name = name is not None, name or loaded.experiment.name
    choose_name(runs_dir, name, explicit=explicit)
    with Signals(backend.interrupt) as signals:
        try:
            hosts = _opened(backend, signals)
            facts = {"backend": loaded.experiment.backend, "hosts": hosts, "islands": len(plan.islands)}
            folder = create(runs_dir, name, loaded, started, facts, explicit=explicit)
            drive: _Drive | None = None
            try:
                drive = _Drive(folder, backend, hosts, seconds, progress, clock, replay)
                return drive.to_the_end(signals.stop)
            except BaseException as error:
                signals.close()
                with contextlib.suppress(StoreError):  # what the run died of may be its store
                    _conclude_badly(folder, drive, error)
                if isinstance(error, StoreError):
                    raise RunFailedError(str(error)) from None
                raise
        finally:
            signals.close()
            progress.close()
            backend.close()


def _opened(backend: Backend, signals: Signals) -> int:
    """Open the backend; a run that was asked to stop meanwhile does not begin."""
    try:
        hosts = backend.open()
    except RunFailedError:
        # A Ctrl-C in a terminal reaches helpers of the backend too, whose failure is then no news.
        if signals.stop.is_set():
            raise KeyboardInterrupt from None
        raise
    signals.listen()
    if signals.stop.is_set():
        raise KeyboardInterrupt
    return hosts


def _conclude_badly(folder: RunFolder, drive: _Drive | None, error: BaseException) -> None:
    """Close the manifest of a run that was broken off hard, with what the driver knows."""
    if not folder.store.exists(MANIFEST) or folder.manifest().get("status") != "running":
        return
    if isinstance(error, KeyboardInterrupt):
        status, reason = "stopped", "broken off by a second Ctrl-C: what the hosts had not written yet is lost"
    else:
        status, reason = "failed", f"{type(error).__name__}: {error}"
    facts = drive.facts() if drive is not None else {}
    folder.update(status=status, ended=datetime.now(UTC).isoformat(timespec="seconds"), error=reason, **facts)


class _Drive:
    """The loop around the state machine, and what the driver remembers: a line an island."""

    def __init__(
        self,
        folder: RunFolder,
        backend: Backend,
        hosts: int,
        seconds: dict[str, float],
        progress: Progress,
        clock: float,
        replay: RunFolder | None,
    ) -> None:
        # The run goes by its own folder from here on, as a replay will.
        loaded = load_experiment(folder.experiment)
        self.loaded = replace(loaded, source=folder.source)
        self.folder, self.backend, self.hosts, self.progress = folder, backend, hosts, progress
        self.plan = make_plan(self.loaded)
        self.deadlines = _deadlines(self.loaded, self.plan, hosts, seconds)
        self.clock = clock
        self.replay = replay
        self.stood: float | None = None
        self.latest: tuple[IslandSummary, ...] = ()
        self.evaluations = 0
        self.stepped_s = 0.0
        self.written = 0

    def to_the_end(self, stop: threading.Event) -> Outcome:
        experiment = self.loaded.experiment
        self.backend.begin(self._host_plans(), self.deadlines)
        self._tell("start", {"hosts": self.hosts, "backend": experiment.backend, "seed": experiment.seed})
        self.progress.begin(self.plan, experiment, self.folder.store)
        state = machine.Archipelago(self.hosts, experiment.length, experiment.schedule)
        events: deque[machine.Event] = deque([machine.Begun()])
        told = False
        while True:
            event = events.popleft() if events else self.backend.wait(POLL_S)
            if stop.is_set() and not told:
                events.append(machine.StopAsked())
                self.progress.note("stopping: the epoch in hand is given up, the log is written (once more: at once)")
                told = True
            if event is None:
                continue
            state, instructions = machine.decide(state, event)
            for instruction in instructions:
                if isinstance(instruction, machine.Conclude):
                    return self._conclude(instruction)
                if isinstance(instruction, machine.Report):
                    self._report(instruction.epoch)
                else:
                    if self.stood is None and isinstance(instruction, machine.Advance):
                        self.stood = time.perf_counter()
                    if isinstance(instruction, machine.Finish) and not self.stepped_s:
                        self.stepped_s = time.perf_counter() - (self.stood or time.perf_counter())
                    self.backend.perform(instruction)

    def _host_plans(self) -> tuple[HostPlan, ...]:
        experiment = self.loaded.experiment
        changes: dict[str, Any] = {
            "epochs": experiment.length,
            "schedule": experiment.schedule,
            "replay": "" if self.replay is None else self.replay.log.place,
            # Longer than the driver waits for a host that hangs: it knows whose fault it is.
            "patience": PATIENCE * self.deadlines.epoch,
        }
        plans = host_plans(self.loaded, self.plan, self.hosts, self.folder.name, self.folder.store)
        return tuple(replace(plan, **changes) for plan in plans)

    def facts(self) -> dict[str, Any]:
        """Give how far the run has come: keys of the manifest and of the outcome."""
        return {
            "wall_s": round(time.perf_counter() - self.clock, 3),
            "startup_s": round((self.stood or time.perf_counter()) - self.clock, 3),
            "generations": max((row.generation for row in self.latest), default=0),
            "evaluations": self.evaluations,
            "best": best_row(self.latest),
            "stepped_s": round(self.stepped_s, 4),
            "busy": round(self.backend.ledger.busy_s / max(self.stepped_s * self.hosts, 1e-9), 4),
        }

    def _report(self, epoch: int) -> None:
        self.latest = self.backend.ledger.summaries(epoch)
        self.evaluations += sum(row.evaluations for row in self.latest)
        self.progress.epoch(epoch, self.latest)

    def _conclude(self, end: machine.Conclude) -> Outcome:
        facts, islands = self.facts(), len(self.plan.islands)
        outcome = Outcome(store=self.folder.store, status=end.status, reason=end.reason, islands=islands, **facts)
        if end.status == "failed" and not end.settled:
            remove(self.folder)
            raise RunFailedError(end.reason)
        self._tell({"finished": "finish", "failed": "failure", "stopped": "stop"}[end.status], {"reason": end.reason})
        ended = datetime.now(UTC).isoformat(timespec="seconds")
        self.folder.update(status=end.status, ended=ended, error=end.reason, **facts)
        return outcome

    def _tell(self, kind: str, detail: dict[str, Any]) -> None:
        """Write an event of the whole run at once, so that the log of a killed run tells of its start."""
        epoch = self.latest[0].epoch if self.latest else None
        event = LogEvent(None, datetime.now(UTC), epoch, kind, detail)
        write(self.folder.log, "events", f"run-{self.written:04d}", events_table(self.folder.name, [event]))
        self.written += 1


def best_row(rows: tuple[IslandSummary, ...]) -> dict[str, Any] | None:
    """Give the best individual that the islands ever bred: island, id, fitness; of equal ones the lowest id."""
    champions = [(row.island, *row.champion) for row in rows if row.champion is not None]
    if not champions:
        return None
    island, fitness, identity = min(champions, key=lambda one: (-one[1], one[2]))
    return {"island": island, "id": identity, "fitness": fitness}


def _deadlines(loaded: Loaded, plan: Plan, hosts: int, seconds: dict[str, float]) -> Deadlines:
    settings, generations = loaded.experiment.deadlines, loaded.experiment.epoch
    if settings.epoch is not None:
        return Deadlines(settings.start, settings.epoch, settings.finish)
    share = -(-len(plan.islands) // hosts)
    heaviest = sorted((spec.population * seconds[spec.group] for spec in plan.islands), reverse=True)[:share]
    epoch = min(max(sum(heaviest) * generations, LEAST_EPOCH_S), MOST_EPOCH_S)
    return Deadlines(settings.start, epoch, settings.finish)
