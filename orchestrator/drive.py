"""The loop around the state machine: what hosts tell goes in, what it orders is done; checkpoints, commands, events.

What the driver remembers of a run is a line an island; all else is in the run's folder.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final, NamedTuple, final

from islands.log import Event as LogEvent
from islands.log import events_table, write
from islands.orders import Start
from islands.store import Store, StoreError
from islands.tally import IslandSummary
from orchestrator import messages
from orchestrator.archipelago import Archipelago, decide, ungranted
from orchestrator.backends.protocol import Backend, Deadlines, RunFailedError
from orchestrator.checkpoints import Checkpoint, complete, log_of, newest
from orchestrator.cutting import prune, roll_back
from orchestrator.folder import RunFolder, on_disk, remove
from orchestrator.lease import Lease
from orchestrator.loading import Loaded, load_experiment
from orchestrator.past import facts_of
from orchestrator.plan import Plan, host_plans
from orchestrator.progress import Progress
from orchestrator.query import ask
from orchestrator.steering.command import ISLANDS, RUN, STRUCTURE, Command, Request
from orchestrator.steering.desk import Desk
from orchestrator.steering.restructuring import replayed
from orchestrator.steering.structure import structure_of

POLL_S: Final = 0.25
FAR_S: Final = 2.0
"""Seconds between two looks for commands of a run that is in a bucket, where each look costs a request."""

PATIENCE: Final = 4
LEAST_EPOCH_S: Final = 600.0
MOST_EPOCH_S: Final = 86_400.0
ENDS: Final = {"finished": "finish", "failed": "failure", "stopped": "stop"}


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
    status: messages.Status
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


@final
class Drive:
    """See the module's docstring.

    Parameters
    ----------
    folder
        The run.
    backend, hosts
        Where the hosts are to be, opened, and how many.
    seconds
        What an evaluation may take, by group of islands.
    progress
        Is told how it goes.
    clock
        When the command began.
    replay
        The run that this one is to repeat, if any.
    before
        The checkpoint to go on from; its log is cut to it already.
    lease
        Keeps other processes from the run.
    """

    def __init__(
        self,
        folder: RunFolder,
        backend: Backend,
        hosts: int,
        seconds: dict[str, float],
        progress: Progress,
        clock: float,
        lease: Lease,
        replay: RunFolder | None = None,
        before: Checkpoint | None = None,
    ) -> None:
        # The run goes by its own folder from here on, as a replay will.
        loaded = load_experiment(folder.experiment)
        self.loaded = replace(loaded, source=folder.source)
        self.folder, self.backend, self.hosts, self.progress = folder, backend, hosts, progress
        self.structure = structure_of(self.loaded)
        self.desk = Desk(folder.store, self.loaded)
        self.plan: Plan = self.structure.plan()
        self.deadlines = deadlines_of(self.loaded, self.plan, hosts, seconds)
        self.clock, self.lease, self.replay, self.before = clock, lease, replay, before
        self.stood: float | None = None
        self.latest: tuple[IslandSummary, ...] = ()
        self.evaluations, self.past = 0, LogPast()
        self.stepped_s = 0.0
        self.round, self.looked = 0, 0.0
        self.is_begun = self.is_paused = False
        self.written = len([name for name in folder.log.names("events") if name.startswith("run-")])
        self.is_fresh = before is None and not self.written

    @property
    def epoch(self) -> int:
        """The epoch of the checkpoint that hosts began with; -1 for the start."""
        return -1 if self.before is None else self.before.epoch

    def to_the_end(self, stop: threading.Event) -> Outcome:
        """Drive until the run is over."""
        experiment = self.loaded.experiment
        self._restructure()
        if self.is_fresh:
            self._tell_of_start()
        self._begin()
        self.is_begun = True
        self.progress.begin(self.plan, experiment, self.folder.store)
        state = Archipelago(
            self.hosts,
            experiment.length,
            experiment.schedule,
            every=experiment.checkpoint.every,
            spacing=experiment.checkpoint.spacing,
            settled=self.epoch,
            reached=self.epoch,
            limit=self._limit(),
        )
        state, instructions = decide(state, messages.Begun())
        events: deque[messages.Event] = deque()
        for instruction in instructions:
            events.extend(self._done(instruction))
        if not self.is_fresh:
            # What takes its time, while the hosts start.
            self.past = past_of(self.folder, self.before)
            self.evaluations = self.past.evaluations
            self._tell_of_start()
        told = False
        while True:
            if not events:
                heard = self.backend.wait(POLL_S)
                events.extend(() if heard is None else (heard,))
            if stop.is_set() and not told:
                events.append(messages.StopAsked())
                self.progress.note("stopping: the epoch in hand is given up, the log is written (once more: at once)")
                told = True
            with contextlib.suppress(StoreError):  # what hosts write will tell whether it is gone for good
                self.lease.renew()
            # Before all else: what was heard may let hosts begin the epoch in which a command takes effect.
            events.extendleft(reversed(self._steered(state)))
            if not events:
                continue
            event = events.popleft()
            state, instructions = decide(state, event)
            for instruction in instructions:
                if isinstance(instruction, messages.Conclude):
                    return self._conclude(instruction)
                events.extend(self._done(instruction))

    def _tell_of_start(self) -> None:
        experiment = self.loaded.experiment
        detail = {"hosts": self.hosts, "backend": experiment.backend, "seed": experiment.seed}
        if self.is_fresh:
            self._tell("start", detail)
        else:
            self._tell("resume", {**detail, "epoch": self.epoch})

    def _done(self, instruction: messages.Instruction) -> Sequence[messages.Event]:
        """Do what the archipelago decided."""
        match instruction:
            case messages.Report(epoch):
                self._report(epoch)
            case messages.Seal(epoch):
                self._seal(epoch)
            case messages.Pause(epoch):
                self._paused(epoch)
            case messages.Rewind(lost, reason):
                return (self._rewound(lost, reason),)
            case messages.Spawn() | messages.Advance() | messages.AskStop() | messages.Save() | messages.Finish():
                if self.stood is None and isinstance(instruction, messages.Advance):
                    self.stood = time.perf_counter()
                if isinstance(instruction, messages.Finish) and not self.stepped_s:
                    self.stepped_s = time.perf_counter() - (self.stood or time.perf_counter())
                self.backend.perform(instruction)
        return ()

    # -- hosts -------------------------------------------------------------------------------------------------------

    def _begin(self) -> None:
        """Hand out the plans of all hosts, for what comes after the checkpoint."""
        commands, experiment = self.desk.commands, self.loaded.experiment
        changes: dict[str, Any] = {
            "epochs": experiment.length,
            "schedule": experiment.schedule,
            "replay": "" if self.replay is None else self.replay.log.place,
            # Longer than the driver waits for a host that hangs: it knows whose fault it is.
            "patience": PATIENCE * self.deadlines.epoch,
            "start": None if self.before is None else Start(self.before.epoch, self.before.parts),
            "interventions": tuple(
                (one.epoch, one.intervention())
                for one in commands
                if one.is_accepted and one.verb in ISLANDS and one.epoch is not None and one.epoch > self.epoch
            ),
            "round": self.round,
        }
        place = (self.folder.name, self.folder.store)
        plans = host_plans(self.loaded, self.plan, self.hosts, *place, epoch=self.epoch + 1)
        self.backend.begin(tuple(replace(plan, **changes) for plan in plans), self.deadlines)

    def _restructure(self) -> None:
        """Find out which islands and channels there are after the checkpoint, and use no more hosts than islands."""
        known = [one for one in self.desk.commands if one.epoch is not None and one.epoch <= self.epoch + 1]
        self.structure = replayed(structure_of(self.loaded), known)
        self.plan = self.structure.plan()
        self.hosts = min(self.hosts, len(self.structure.living(self.epoch + 1)))

    def _limit(self) -> int | None:
        """Give the last epoch before islands or channels change, as commands of before decided."""
        later = [one.epoch for one in self.desk.commands if one.is_accepted and one.verb in STRUCTURE]
        return min((epoch - 1 for epoch in later if epoch is not None and epoch > self.epoch + 1), default=None)

    def _rewound(self, lost: tuple[int, ...], reason: str) -> messages.Rewound:
        """Make ready to begin anew from the last checkpoint."""
        store = self.folder.store
        if lost:
            self.progress.note(f"{reason}; going on from the last checkpoint")
        found, doubts = newest(store, self.folder.name, self.loaded.experiment.seed)
        self.before, self.round = found, self.round + 1
        self._restructure()
        try:
            self.hosts = self.backend.regroup(lost, self.hosts)
        finally:
            # Not before: a lost host that was only slow would write to what was cut, until it is ended.
            roll_back(store, found, keep_run_events=True)
        self.past = past_of(self.folder, found)
        self.evaluations = self.past.evaluations
        self._begin()
        detail = {"hosts": self.hosts, "epoch": self.epoch, "reason": reason, "lost": list(lost)}
        detail |= {"damaged": list(doubts)} if doubts else {}
        self._tell("recovery" if lost else "restructure", detail)
        return messages.Rewound(self.epoch, self.hosts, self._limit())

    def _seal(self, epoch: int) -> None:
        """Make a checkpoint whole, and remove those that are too many."""
        saved = self.backend.ledger.parts(epoch)
        checkpoint = Checkpoint(
            run=self.folder.name,
            seed=self.loaded.experiment.seed,
            epoch=epoch,
            parts=tuple(one.part for one in saved),
            log=log_of(self.before, [one.files for one in saved]),
            events=self.written,
            commands=len(self.desk.commands),
            facts=facts_of(self.loaded, self.desk.commands),
        )
        complete(self.folder.store, checkpoint)
        prune(self.folder.store, self.loaded.experiment.checkpoint.keep)

    # -- steering ----------------------------------------------------------------------------------------------------

    def _steered(self, state: Archipelago) -> Sequence[messages.Event]:
        """Take the commands that have come, while there is a host to carry them out."""
        now = time.monotonic()
        if state.phase != "running" or (self.folder.store.local is None and now < self.looked + FAR_S):
            return ()
        self.looked = now
        events: list[messages.Event] = []
        taken: Sequence[Command] = ()
        with contextlib.suppress(StoreError):
            taken = self.desk.look(ungranted(state), self._objection)
        for command in taken:
            assert command.epoch is not None
            self._tell("intervention", {"n": command.number, "verb": command.verb, "epoch": command.epoch})
            if command.verb in ISLANDS:
                for host in range(self.hosts):
                    self.backend.perform(messages.Steer(host, command.epoch, command.intervention()))
            elif command.verb in STRUCTURE:
                events.append(messages.RestructureAsked(command.epoch))
            else:
                if command.verb == "resume" and self.is_paused:
                    self.is_paused = False
                    self.folder.update(status="running")
                events.append(_ASKED[command.verb]())
            self.progress.note(f"steered: {command.verb}, from epoch {command.epoch} on")
        return events

    def _objection(self, request: Request, epoch: int) -> str:
        """Say why a command comes too late."""
        length = self.loaded.experiment.length
        if request.verb in RUN or epoch <= length:
            return ""
        return f"the run ends with epoch {length}, and no earlier one can still be changed"

    def _paused(self, epoch: int) -> None:
        if self.is_paused:
            return
        self.is_paused = True
        self.folder.update(status="paused", **self.facts())
        self.progress.note(f"paused after epoch {epoch}: go on with 'atoll steer RUN resume'")

    # -- telling -----------------------------------------------------------------------------------------------------

    def facts(self) -> dict[str, Any]:
        """Give how far the run has come: keys of the manifest and of the outcome."""
        stepped = self.stepped_s or (0.0 if self.stood is None else time.perf_counter() - self.stood)
        return {
            "wall_s": round(time.perf_counter() - self.clock, 3),
            "startup_s": round((self.stood or time.perf_counter()) - self.clock, 3),
            "generations": max((row.generation for row in self.latest), default=self.past.generations),
            "evaluations": self.evaluations,
            "best": best_row(self.latest) if self.latest else self.past.best,
            "stepped_s": round(stepped, 4),
            "busy": round(self.backend.ledger.busy_s / (stepped * self.hosts), 4) if stepped > 0 else 0.0,
        }

    def _report(self, epoch: int) -> None:
        self.latest = self.backend.ledger.summaries(epoch)
        self.evaluations += sum(row.evaluations for row in self.latest)
        self.progress.epoch(epoch, self.latest)

    def _conclude(self, end: messages.Conclude) -> Outcome:
        store = self.folder.store
        facts, islands = self.facts(), len(self.structure.living(self.epoch + 1))
        outcome = Outcome(store=store, status=end.status, reason=end.reason, islands=islands, **facts)
        with contextlib.suppress(StoreError):
            self.desk.close(f"the run is {end.status}")
        if end.status == "failed" and not end.settled and self.is_fresh:
            remove(self.folder)
            raise RunFailedError(end.reason)
        if end.torn:
            # A lost host that was only slow would write to what is cut, until it is ended.
            self.backend.close()
            found, _ = newest(store, self.folder.name, self.loaded.experiment.seed)
            roll_back(store, found, keep_run_events=True)
        self._tell(ENDS[end.status], {"reason": end.reason})
        ended = datetime.now(UTC).isoformat(timespec="seconds")
        self.folder.update(status=end.status, ended=ended, error=end.reason, **facts)
        return outcome

    def _tell(self, kind: str, detail: dict[str, Any]) -> None:
        """Write an event of the whole run at once, so that the log of a killed run tells of its start."""
        epoch = self.latest[0].epoch if self.latest else None
        event = LogEvent(None, datetime.now(UTC), epoch, kind, detail)
        write(self.folder.log, "events", f"run-{self.written:04d}", events_table(self.folder.name, [event]))
        self.written += 1


_ASKED: Final[dict[str, type[messages.PauseAsked | messages.ResumeAsked | messages.StopAsked | messages.SaveAsked]]] = {
    "pause": messages.PauseAsked,
    "resume": messages.ResumeAsked,
    "stop": messages.StopAsked,
    "checkpoint": messages.SaveAsked,
}


class LogPast(NamedTuple):
    """What the log tells of a run up to a checkpoint: scorings, generations, the best ever bred."""

    evaluations: int = 0
    generations: int = 0
    best: dict[str, Any] | None = None


def past_of(folder: RunFolder, checkpoint: Checkpoint | None) -> LogPast:
    """Ask the log what came until a checkpoint."""
    if checkpoint is None:
        return LogPast()
    until = f"where epoch <= {checkpoint.epoch}"
    counts = f"select coalesce(sum(evaluations), 0), coalesce(max(generation), 0) from generations {until}"  # noqa: S608
    (evaluations, generations), *_ = ask(folder.log, counts).rows
    sql = f"select island, id, fitness from individuals {until} and valid order by fitness desc, id limit 1"  # noqa: S608
    best = [
        {"island": island, "id": identity, "fitness": fitness}
        for island, identity, fitness in ask(folder.log, sql).rows
    ]
    return LogPast(int(evaluations), int(generations), best[0] if best else None)


def best_row(rows: tuple[IslandSummary, ...]) -> dict[str, Any] | None:
    """Give the best individual that the islands ever bred: island, id, fitness; of equal ones the lowest id."""
    champions = [(row.island, *row.champion) for row in rows if row.champion is not None]
    if not champions:
        return None
    island, fitness, identity = min(champions, key=lambda one: (-one[1], one[2]))
    return {"island": island, "id": identity, "fitness": fitness}


def deadlines_of(loaded: Loaded, plan: Plan, hosts: int, seconds: dict[str, float]) -> Deadlines:
    """Give how long hosts may take."""
    settings, generations = loaded.experiment.deadlines, loaded.experiment.epoch
    if settings.epoch is not None:
        return Deadlines(settings.start, settings.epoch, settings.finish, settings.silence)
    share = -(-len(plan.islands) // hosts)
    heaviest = sorted((spec.population * seconds[spec.group] for spec in plan.islands), reverse=True)[:share]
    epoch = min(max(sum(heaviest) * generations, LEAST_EPOCH_S), MOST_EPOCH_S)
    return Deadlines(settings.start, epoch, settings.finish, settings.silence)
