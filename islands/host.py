"""The host: holds several islands, steps them on one thread, and writes their part of the log.

It is a plain class. The in-process backend calls it as it is; ``islands.actor`` makes a Ray actor of it. What its
islands send to each other stays inside; what they send to islands of other hosts is gathered and posted to these
directly. Which island steps when is the agenda's business (:mod:`islands.agenda`).
"""

from __future__ import annotations

import os
import threading
import time
from collections import defaultdict, deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from datetime import UTC, datetime
from typing import Any, Final, final

from genome.errors import InputError
from growth.protocol import Clock
from islands.agenda import Agenda, Complete, Present, Recorded, Rule, ranks
from islands.arrivals import arrivals_detail, recorded_arrivals
from islands.biologies import Biologies, compile_kernels
from islands.checkpoint import Kept, read_parts, write_part
from islands.forms import best_forms, write_forms
from islands.inputs import inputs_here
from islands.interventions.intervention import Intervention
from islands.island import Island
from islands.lateness import Lateness
from islands.log import LogWriter
from islands.mail import Bell, Porch
from islands.migration.adapters import adapters_into
from islands.migration.channel import Packet
from islands.migration.routes import Routes
from islands.orders import (
    NOWHERE,
    Advanced,
    Box,
    Finished,
    HostPlan,
    Post,
    Saved,
    Start,
    StarvedError,
    Step,
    StoppedError,
)
from islands.spec import IslandSpec
from islands.state import Advance, State
from islands.store import Store
from islands.tally import Tally
from islands.transit import Transit, lacking
from islands.wire import opened

THREAD_VARIABLES: Final = (
    "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS", "NUMBA_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
)  # fmt: skip

POST_S: Final = 0.001
"""Packets are gathered for so long, as long as an island of the host can step and lags behind its others."""

MOST_NAMED: Final = 3
"""Packets that are named when a host has waited in vain."""


def _nowhere(host: int, packets: Box) -> bool:
    raise RuntimeError(f"{len(packets)} packets for host {host}, which this host is not connected to")


@final
class Host:
    """Several islands on one thread; see the module's docstring.

    Parameters
    ----------
    plan
        What to do.
    clock
        For how long packets are gathered, for what generations took, and for what a call says of its time.
    work
        The clock of growth and evaluation, for their columns and for the safety net behind their budgets: time on the
        processor, so that a process that stood still for a while breeds the same.
    calendar
        For the log's events.
    post
        Hands packets to other hosts.
    porch
        Where letters of other hosts come in.
    """

    def __init__(
        self,
        plan: HostPlan,
        clock: Clock = time.perf_counter,
        work: Clock = time.thread_time,
        calendar: Callable[[], datetime] = lambda: datetime.now(UTC),
        post: Post = _nowhere,
        porch: Porch | None = None,
    ) -> None:
        self._plan = plan
        self._clock, self._work = clock, work
        self._post = post
        self._stop, self._alone = threading.Event(), threading.Event()
        self._porch: Porch = porch or Bell()
        self._mail: deque[Box] = deque()
        self._islands: dict[int, Island[Any]] = {}
        self._states: dict[int, State[Any]] = {}
        self._history: dict[int, dict[int, State[Any]]] = {}
        self._gathered: dict[int, list[Packet]] = {}
        self._posted = 0.0
        self._turn: tuple[int, int, float] | None = None
        self._flushed = self._told = -1
        self._broken: Advanced | None = None
        self._busy = self._waited = 0.0
        self._routes = Routes(plan.edges, plan.redrawn, plan.seed)
        self._agenda = Agenda((), Present())
        self._tally = Tally(plan.islands)
        log, begun = Store.open(plan.folder).at("log"), plan.start is not None
        self._log = LogWriter(log, plan.run, plan.islands, calendar, begun=begun)
        self._inputs = ExitStack()
        self._transit = Transit()
        self._lateness = Lateness(self._routes, -1 if plan.start is None else plan.start.epoch)
        self._interventions: dict[int, list[Intervention]] = defaultdict(list)
        for epoch, one in plan.interventions:
            self._interventions[epoch].append(one)

    def ready(self) -> int:
        """Make the islands; to be called once, before all else. Gives the host's number.

        Raises
        ------
        InputError
            When an island's settings do not hold together here: a file or plug-in that this machine lacks; or when the
            checkpoint that it goes on from is damaged.
        """
        pin_threads()
        self._log.warm()
        # For as long as the host is: an island that is steered to other goals is built anew.
        plan = self._inputs.enter_context(inputs_here(self._plan))
        self._islands = self._made(plan)
        # Where nobody waits, nobody is to be kept supplied.
        order = {} if plan.schedule != "dataflow" else ranks(plan.placement, plan.host, plan.edges)
        finished = -1 if plan.start is None else plan.start.epoch
        self._agenda = Agenda(self._islands, self._rule(), order, finished)
        if plan.start is not None:
            self._restore(plan.start)
        return plan.host

    def _restore(self, start: Start) -> None:
        """Go on from a checkpoint."""
        known = {number for part in start.parts for number in part.islands}
        for number, island in self._islands.items():
            # It would wait for ever for packets that nobody sent.
            if number not in known and island.spec.since != start.epoch + 1:
                expected = f"a state of the island {island.spec.name} in the checkpoint of epoch {start.epoch}"
                raise InputError(str(Store.open(self._plan.folder)), expected, "none", "the experiment was changed")
        here = [island for number, island in self._islands.items() if number in known]
        restored = read_parts(Store.open(self._plan.folder), start.parts, here)
        self._flushed = self._told = start.epoch
        self._states = {number: one.state for number, one in restored.items()}
        self._history = {start.epoch: dict(self._states)}
        self._tally.restore({number: one.champion for number, one in restored.items()})
        for one in restored.values():
            for packet in one.pending:
                self._agenda.put(packet)

    def _made(self, plan: HostPlan) -> dict[int, Island[Any]]:
        # Islands of one group differ in nothing that their biology sees, until they are steered, so they share it: ten
        # thousand islands need no ten thousand environments.
        compile_kernels(plan.islands)
        build = Biologies(self._work)
        strangers = _strangers(plan)
        return {
            spec.number: Island(
                spec,
                build(spec),
                plan.seed,
                self._routes,
                self._clock,
                self._pulse,
                adapters_into(spec, strangers.get(spec.number, ()), spec.source),
                build,
            )
            for spec in plan.islands
        }

    def _rule(self) -> Rule:
        if self._plan.schedule != "async":
            return Complete(self._routes)
        if self._plan.replay:
            return Recorded(recorded_arrivals(self._plan.replay, self._plan.islands))
        return Present()

    # -- what may be called from another thread ------------------------------------------------------------------

    def stop(self, lost: bool = False) -> None:
        """Ask for the epoch in hand to be abandoned.

        Parameters
        ----------
        lost
            Whether another host is lost, so that what this one waits for may never come: it gives up its part of a
            checkpoint too, and letters that have not gone out.
        """
        if lost:
            self._alone.set()
        self._stop.set()
        self._porch.ring()

    def step(self) -> Step:
        """Give what the host is at."""
        if self._turn is None:
            return Step("", -1, 0.0)
        number, epoch, started = self._turn
        return Step(self._islands[number].spec.name, epoch, self._clock() - started)

    def deliver(self, packets: Box) -> None:
        """Take packets from another host."""
        self._mail.append(packets)
        self._porch.ring()

    # -- stepping ------------------------------------------------------------------------------------------------

    def advance(self, through: int, horizon: int, settled: int) -> Advanced:
        """Step islands until all have finished an epoch.

        Parameters
        ----------
        through
            That epoch; 0 makes the first populations.
        horizon
            How far islands may go while others wait for packets, at least ``through``.
        settled
            The last epoch that all hosts have finished: the log is written up to it, and nobody will ask for states
            before it.
        """
        self._busy = self._waited = 0.0
        if self._broken is not None:
            return self._broken
        before = self._told
        trouble, stopped = "", False
        try:
            self._settle(settled)
            self._step_through(through, horizon)
        except StoppedError:
            trouble, stopped = "asked to stop", True
        except (InputError, StarvedError) as error:
            trouble = str(error)
        except Exception as error:  # noqa: BLE001 - whatever an island raises ends the run with a message
            trouble = f"{type(error).__name__}: {error}"
        if trouble:
            # What comes after it must not go on with half an epoch.
            self._broken = Advanced(self._agenda.floor, (), 0.0, 0.0, trouble, stopped)
            return self._broken._replace(busy_s=self._busy, waited_s=self._waited)
        self._told = through
        return Advanced(self._agenda.floor, self._tally.since(before, through), self._busy, self._waited)

    def _step_through(self, through: int, horizon: int) -> None:
        while self._agenda.floor < through:
            self._pulse()
            self._collect()
            turn = self._agenda.next(horizon)
            if turn is None:
                self._send()
                self._wait()
                continue
            started, floor = self._clock(), self._agenda.floor
            self._turn = (*turn, started)
            self._take_turn(*turn)
            self._turn, ended = None, self._clock()
            self._busy += ended - started
            if ended - self._posted > POST_S or self._agenda.floor > floor:
                self._send()
        self._send()
        self._see_off()

    def _take_turn(self, number: int, epoch: int) -> None:
        """Step one island and pass on what it sends."""
        island, packets = self._islands[number], self._agenda.take(number)
        self._transit.take(epoch, packets)
        step: Advance[Any]
        if number in self._states:
            asked = self._interventions.get(epoch, ())
            step = island.advance(self._states[number], self._plan.generations, packets, asked)
        else:
            step = island.begin(epoch)
        self._states[number] = step.state
        self._history.setdefault(epoch, {})[number] = step.state
        self._tally.add(number, step)
        self._log.add(number, epoch, step.records)
        if self._plan.schedule == "async" and epoch > 0:
            edges = self._routes.incoming(number, epoch - 1)
            self._log.tell(number, epoch, "arrivals", arrivals_detail(packets, edges, epoch - 1))
            for detail in self._lateness.told(number, epoch, packets):
                self._log.tell(number, epoch, "late", detail)
        self._agenda.done(number)
        placement, here = self._plan.placement, self._plan.host
        for packet in step.departures:
            host = placement[packet.target]
            if host == here:
                self._agenda.put(packet)
            elif host != NOWHERE:
                self._gathered.setdefault(host, []).append(packet)

    def _collect(self) -> None:
        for letter in self._porch.letters():
            for packet in opened(letter):
                self._agenda.put(packet)
        while self._mail:
            for packet in self._mail.popleft():
                self._agenda.put(packet)

    def _send(self) -> None:
        """Post what was gathered; what cannot go yet stays."""
        self._posted = self._clock()
        for host, packets in self._gathered.items():
            if packets and self._post(host, tuple(packets)):
                packets.clear()

    def _wait(self) -> None:
        """Wait for packets, or for the wish to stop."""
        started = self._clock()
        heard = self._mail or self._stop.is_set() or self._porch.wait(self._plan.patience)
        self._waited += self._clock() - started
        if not heard:
            raise StarvedError(self._lacking())

    def _see_off(self) -> None:
        """Wait until all that was posted has gone out: who hears that an epoch is done has its packets to hand."""
        started = self._clock()
        while self._porch.owing:
            if self._alone.is_set():
                raise StoppedError
            if not self._porch.wait(self._plan.patience):
                raise StarvedError(f"waited {self._plan.patience:g} s for a host that takes no letters")
            self._collect()
        self._waited += self._clock() - started

    def _lacking(self) -> str:
        """Say what the host has waited for in vain."""
        lacking = self._agenda.awaited()
        if lacking is None:
            return f"no island of host {self._plan.host} can step, and none waits for packets"
        number, epoch, marks = lacking
        edges = self._routes.incoming(number, epoch - 1)
        names = {(edge.channel.number, edge.source): edge.source_name for edge in edges}
        sources = [
            f"island {names.get((channel, source), source)} of host {self._plan.placement[source]} (epoch {sent})"
            for channel, source, sent in marks[:MOST_NAMED]
        ]
        more = f" and {len(marks) - MOST_NAMED} more" if len(marks) > MOST_NAMED else ""
        name = self._islands[number].spec.name
        waited = f"waited {self._plan.patience:g} s to begin epoch {epoch} of {name}"
        return f"{waited} without news from {', '.join(sources)}{more}"

    def _pulse(self) -> None:
        if self._stop.is_set():
            raise StoppedError
        if self._porch.owing:
            self._collect()

    # -- writing -------------------------------------------------------------------------------------------------

    def _settle(self, settled: int) -> None:
        """Write the log as far as all hosts have come, and forget what nobody asks for any more."""
        every = self._plan.flush_epochs
        for epoch in range((max(self._flushed, 0) // every + 1) * every, settled + 1, every):
            self._log.flush(epoch)
            self._flushed = epoch
        for epoch in [epoch for epoch in self._history if epoch < settled]:
            del self._history[epoch]
        for epoch in [epoch for epoch in self._interventions if epoch < settled]:
            del self._interventions[epoch]
        self._tally.forget(settled)
        self._transit.forget(settled)

    def steer(self, epoch: int, intervention: Intervention) -> None:
        """Take an intervention; no island has begun the epoch in which it takes effect."""
        self._interventions[epoch].append(intervention)

    def checkpoint(self, epoch: int) -> Saved:
        """Write this host's part of the checkpoint of an epoch that all hosts have finished, and the log up to it.

        Raises
        ------
        StarvedError
            When packets that other hosts sent by then do not come.
        StoppedError
            When one of these hosts is lost.
        """
        while any(self._gathered.values()):
            self._send()
            if self._alone.is_set():
                raise StoppedError
        self._see_off()
        pending = self._pending(epoch)
        while lacking(self._routes, epoch, pending):
            if self._alone.is_set():
                raise StoppedError
            if not self._porch.wait(self._plan.patience):
                raise StarvedError(f"waited {self._plan.patience:g} s for packets of epoch {epoch}")
            pending = self._pending(epoch)
        self._log.flush(epoch)
        self._flushed = max(self._flushed, epoch)
        champions, states = self._tally.champions(epoch), self._history[epoch]
        kept = [
            Kept(island, states[number], pending[number], champions[number]) for number, island in self._islands.items()
        ]
        part = write_part(Store.open(self._plan.folder), epoch, self._plan.host, kept)
        return Saved(part, self._log.files)

    def _pending(self, epoch: int) -> dict[int, tuple[Packet, ...]]:
        self._collect()
        return self._transit.pending(epoch, self._islands, self._agenda.present())

    def finish(self, forms: bool, settled: int, through: int) -> Finished:
        """Write what is left of the log up to an epoch and drop the rest; write the best forms, if asked.

        Parameters
        ----------
        forms
            Whether to write forms.
        settled
            The last epoch whose summaries were reported.
        through
            The epoch at which the log is to end; all islands have finished it.
        """
        self._log.flush(through)
        self._log.drop()
        states = self._history.get(through, {})
        files: list[str] = []
        if forms and states:
            folder = Store.open(self._plan.folder).at("forms")
            for number, state in states.items():
                files.extend(self._write_forms(self._islands[number], state, folder))
            self._log.flush()
        self.close()
        return Finished(tuple(files), self._tally.since(settled, through) if through > settled else ())

    def close(self) -> None:
        """Put away what was brought to this machine; nothing steps any more."""
        self._inputs.close()

    def _write_forms(self, island: Island[Any], state: State[Any], folder: Store) -> Sequence[str]:
        def failed(detail: dict[str, Any]) -> None:
            self._log.tell(island.spec.number, state.epoch, "form", detail)

        best = best_forms(island, state.deme, self._plan.best_forms)
        return write_forms(island, state, best, folder, self._plan.run, failed)


def _strangers(plan: HostPlan) -> Mapping[int, Sequence[tuple[str, IslandSpec]]]:
    """Give, for each island that adapters lead to, their names and the islands that they translate from."""
    known = {spec.number: spec for spec in (*plan.islands, *plan.foreign)}
    pairs = [(edge.target, edge.adapter, edge.source) for edge in plan.edges if edge.adapter]
    for channel in plan.redrawn:
        species = channel.species or range(len(channel.members))  # without, each is as of its own: all need it
        members = [(number, kin) for (number, _), kin in zip(channel.members, species, strict=True) if channel.adapter]
        pairs.extend(
            (target, channel.adapter, source)
            for target, kin in members
            for source, other in members
            if source != target and kin != other
        )
    found: dict[int, list[tuple[str, IslandSpec]]] = defaultdict(list)
    here = {spec.number for spec in plan.islands}
    for target, adapter, source in dict.fromkeys(pairs):
        if target in here:
            found[target].append((adapter, known[source]))
    return found


def pin_threads() -> None:
    """Keep the numeric libraries of this process on one thread, so that sums are taken in one order everywhere."""
    from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

    for variable in THREAD_VARIABLES:
        os.environ.setdefault(variable, "1")
    threadpool_limits(limits=1)
