"""The host: holds several islands, steps them on one thread, and writes their part of the log.

It is a plain class. The in-process backend calls it as it is; ``islands.actor`` makes a Ray actor of it. What its
islands send to each other stays inside; what they send to islands of other hosts comes out of ``advance`` as one
box for each host, so that a driver can route boxes without looking into them.
"""

from __future__ import annotations

import os
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final, final

from genome.errors import InputError
from genome.mishaps import one_line
from growth.protocol import Clock
from islands.individual import Individual
from islands.island import Advance, Island, State
from islands.kinds.registry import resolve_kind
from islands.log import LogWriter
from islands.migration.channel import Edge, Packet
from islands.migration.routes import Routes
from islands.selection import ranked
from islands.spec import IslandSpec

Box = tuple[Packet, ...]
"""What one host sends to another at an epoch's end."""

THREAD_VARIABLES: Final = (
    "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS", "NUMBA_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
)  # fmt: skip

MOST_REASON: Final = 160
"""Characters of the reason that a summary gives."""


@dataclass(frozen=True, slots=True)
class HostPlan:
    """What one host is to do.

    Attributes
    ----------
    host, hosts
        Its number, and how many there are.
    run, seed
        The run's name and seed.
    folder
        The run's folder.
    islands
        Its islands, in order.
    edges
        Every edge that begins or ends at one of them, in the order of channels, then sources.
    placement
        For each island of the run, by number, the host that holds it.
    generations
        Generations of an epoch.
    flush_epochs
        The log is written every so many epochs.
    best_forms
        How many different forms of each island are written at the end.
    """

    host: int
    hosts: int
    run: str
    seed: int
    folder: str
    islands: tuple[IslandSpec, ...]
    edges: tuple[Edge, ...]
    placement: tuple[int, ...]
    generations: int
    flush_epochs: int
    best_forms: int


@dataclass(frozen=True, slots=True)
class IslandSummary:
    """How an island stands at an epoch's end: what the driver may see of it.

    Attributes
    ----------
    island, epoch, generation
        Which island, and when.
    evaluations, migrants
        Scorings in this epoch, and migrants that were let in at its start.
    best, mean, invalid
        Figures of its members.
    champion
        Fitness and id of the best individual that it ever bred, member still or not; of equal ones the older.
    trouble
        The commonest reason why its members are invalid, when all are; otherwise empty.
    """

    island: str
    epoch: int
    generation: int
    evaluations: int
    best: float | None
    mean: float | None
    invalid: int
    migrants: int
    champion: tuple[float, int] | None
    trouble: str = ""


class StoppedError(Exception):
    """The run was asked to stop: the epoch in hand is abandoned, the states are those of its beginning."""


@final
class Host:
    """Several islands on one thread; see the module's docstring.

    Parameters
    ----------
    plan
        What to do.
    clock, calendar
        For the log's clock columns alone.
    """

    def __init__(
        self,
        plan: HostPlan,
        clock: Clock = time.perf_counter,
        calendar: Callable[[], datetime] = lambda: datetime.now(UTC),
    ) -> None:
        self._plan = plan
        self._clock = clock
        self._stop = threading.Event()
        self._islands: tuple[Island[Any], ...] = ()
        self._states: dict[int, State[Any]] = {}
        self._champions: dict[int, tuple[float, int]] = {}
        self._kept: Box = ()
        self._log = LogWriter(Path(plan.folder) / "log", plan.run, plan.islands, calendar)

    def ready(self) -> int:
        """Make the islands; to be called once, before all else. Gives the host's number.

        Raises
        ------
        InputError
            When an island's settings do not hold together here: a file or plug-in that this machine lacks.
        """
        pin_threads()
        routes = Routes(self._plan.edges, (), self._plan.seed)
        # Islands of one group differ in nothing that their biology sees, so they share it: ten thousand islands
        # need no ten thousand environments.
        groups = {spec.group: spec for spec in self._plan.islands}
        biology = {
            name: resolve_kind(spec.kind, spec.where("kind")).build(spec, self._clock) for name, spec in groups.items()
        }
        self._islands = tuple(
            Island(spec, biology[spec.group], self._plan.seed, routes, self._clock, self._pulse)
            for spec in self._plan.islands
        )
        return self._plan.host

    def stop(self) -> None:
        """Ask for the epoch in hand to be abandoned; may be called from another thread."""
        self._stop.set()

    def advance(self, epoch: int, *inboxes: Box) -> tuple[Any, ...]:
        """Step every island through one epoch.

        Parameters
        ----------
        epoch
            0 makes the first populations; then each epoch follows the one before.
        inboxes
            What the hosts sent at the end of the epoch before, in any order.

        Returns
        -------
        The islands' summaries, then one box for each host of the run; the one for itself is empty.

        Raises
        ------
        StoppedError
            When it was asked to stop; nothing has changed then.
        """
        arrivals: dict[int, list[Packet]] = defaultdict(list)
        for packet in (packet for box in (self._kept, *inboxes) for packet in box):
            arrivals[packet.target].append(packet)
        steps = [self._step(island, epoch, arrivals[island.spec.number]) for island in self._islands]
        boxes: list[list[Packet]] = [[] for _ in range(self._plan.hosts)]
        for island, step in zip(self._islands, steps, strict=True):
            self._states[island.spec.number] = step.state
            self._log.add(island.spec.number, epoch, step.records)
            for packet in step.departures:
                boxes[self._plan.placement[packet.target]].append(packet)
        self._kept = tuple(boxes[self._plan.host])
        boxes[self._plan.host] = []
        if epoch % self._plan.flush_epochs == 0 and epoch > 0:
            self._log.flush()
        summaries = tuple(self._summary(i, s) for i, s in zip(self._islands, steps, strict=True))
        return (summaries, *(tuple(box) for box in boxes))

    def finish(self, write_forms: bool) -> tuple[str, ...]:
        """Write what is left of the log and, if asked, the best forms; give the forms' paths."""
        self._log.flush()
        if not write_forms:
            return ()
        files: list[str] = []
        folder = Path(self._plan.folder) / "forms"
        folder.mkdir(parents=True, exist_ok=True)
        for island in self._islands:
            state = self._states.get(island.spec.number)
            if state is not None:
                files.extend(self._write_forms(island, state.deme, folder))
        self._log.flush()
        return tuple(files)

    def _write_forms(self, island: Island[Any], deme: Sequence[Individual[Any]], folder: Path) -> list[str]:
        files: list[str] = []
        for rank, member in enumerate(best_forms(island, deme, self._plan.best_forms), start=1):
            stem = folder / f"{island.spec.name}-best{rank}"
            facts: dict[str, str | float | bool] = {
                "run": self._plan.run,
                "island": island.spec.name,
                "id": str(member.id),
                "fitness": member.fitness or 0.0,
            }
            try:
                written = island.biology.write_forms(member.genotype, stem, (), facts)
            except InputError as error:
                detail = {"id": member.id, "detail": str(error)}
                self._log.tell(island.spec.number, self._states[island.spec.number].epoch, "form", detail)
                continue
            files.extend(str(path) for path in written)
        return files

    def _step(self, island: Island[Any], epoch: int, arrivals: Sequence[Packet]) -> Advance[Any]:
        if epoch == 0:
            return island.begin()
        state = self._states[island.spec.number]
        if state.epoch != epoch - 1:
            text = f"island {island.spec.name} stands at epoch {state.epoch}, asked for epoch {epoch}"
            raise RuntimeError(text)
        return island.advance(state, self._plan.generations, arrivals)

    def _summary(self, island: Island[Any], step: Advance[Any]) -> IslandSummary:
        last, number = step.records.generations[-1], island.spec.number
        contenders = [(row.fitness, row.id) for row in step.records.born if row.fitness is not None]
        if number in self._champions:
            contenders.append(self._champions[number])
        if contenders:
            self._champions[number] = min(contenders, key=lambda one: (-one[0], one[1]))
        return IslandSummary(
            island=island.spec.name,
            epoch=step.state.epoch,
            generation=step.state.generation,
            evaluations=sum(row.evaluations for row in step.records.generations),
            best=last.best,
            mean=last.mean,
            invalid=last.invalid,
            migrants=sum(crossing.accepted for crossing in step.records.crossings),
            champion=self._champions.get(number),
            trouble=most_frequent_error(step.state.deme) if last.best is None else "",
        )

    def _pulse(self) -> None:
        if self._stop.is_set():
            raise StoppedError


def best_forms(island: Island[Any], deme: Sequence[Individual[Any]], count: int) -> list[Individual[Any]]:
    """Give the best members of different forms, best first; fewer where the deme has no more forms.

    Members whose scores are equal to the last bit count as one form, since different genomes may grow into one: the
    one of the lowest id stands for it. Of a kind without scores genotypes are compared.
    """
    forms: dict[object, Individual[Any]] = {}
    for member in ranked(deme):
        if len(forms) == count or member.fitness is None:
            break
        forms.setdefault(member.scores or island.biology.encode(member.genotype), member)
    return list(forms.values())


def most_frequent_error(deme: Sequence[Individual[Any]]) -> str:
    """Give an error that is typical of a deme: of the commonest reason the commonest text; empty without any."""
    errors = [member.error for member in deme if member.error]
    if not errors:
        return ""
    reasons = [error.partition(":")[0] for error in errors]
    commonest = Counter(reasons).most_common(1)[0][0]
    texts = [error for error, reason in zip(errors, reasons, strict=True) if reason == commonest]
    return one_line(Counter(texts).most_common(1)[0][0], MOST_REASON)


def pin_threads() -> None:
    """Keep the numeric libraries of this process on one thread, so that sums are taken in one order everywhere."""
    from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

    for variable in THREAD_VARIABLES:
        os.environ.setdefault(variable, "1")
    threadpool_limits(limits=1)
