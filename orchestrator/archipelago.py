"""The archipelago's decisions: a pure state machine, events in and instructions out, without any I/O.

A backend performs the instructions and reports events. Hosts are told how far to step, mark by mark: the marks are
epochs, the same for all hosts. What the schedules differ in is when a host is told the next one:

- ``barrier``: all hosts have finished the last mark, and each epoch is a mark;
- ``dataflow`` and ``async``: two calls of each host may be on their way, and the fastest host may be some marks ahead
  of the slowest; hosts that wait for packets may go on beyond their mark where they can.

A host alone waits for nobody, so that its marks may hold several epochs under every schedule. Where they may, they hold
as many as fit into a moment.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

from islands.host import Schedule

Status = Literal["finished", "failed", "stopped"]
Phase = Literal["new", "starting", "running", "finishing", "done"]

CALL_S: Final = 0.25
"""A call holds as many epochs as are expected to fit into this time, at least one."""

MOST_EPOCHS: Final = 32
"""Epochs of a call at most."""

CALLS: Final = 2
"""Calls of one host on their way at a time: while it performs one, the next is there already."""

LEAD: Final = 4
"""Marks that the fastest host may be ahead of the slowest."""

SLACK: Final = 8
"""Epochs, or as many as a call holds, that islands may go on beyond a mark while others wait."""

# -- events ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Begun:
    """The run was asked for."""


@dataclass(frozen=True, slots=True)
class HostReady:
    """A host stands."""

    host: int


@dataclass(frozen=True, slots=True)
class EpochDone:
    """A host has stepped its islands through an epoch that was a mark; ``seconds`` is what the call took."""

    host: int
    epoch: int
    seconds: float = 0.0


@dataclass(frozen=True, slots=True)
class EpochAbandoned:
    """A host broke off because it was asked to stop; ``epoch`` is the last that all of its islands have finished."""

    host: int
    epoch: int


@dataclass(frozen=True, slots=True)
class HostFinished:
    """A host has written the last of its log and its forms."""

    host: int


@dataclass(frozen=True, slots=True)
class HostFailed:
    """A host raised an error, died, or did not answer within its deadline.

    ``epoch`` is the last that all of its islands have finished, where the host could still say so.
    """

    host: int
    reason: str
    alive: bool
    epoch: int = -1


@dataclass(frozen=True, slots=True)
class StopAsked:
    """Somebody wants the run to stop."""


Event: TypeAlias = Begun | HostReady | EpochDone | EpochAbandoned | HostFinished | HostFailed | StopAsked

# -- instructions ------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Spawn:
    """Make a host."""

    host: int


@dataclass(frozen=True, slots=True)
class Advance:
    """Let a host step its islands.

    Attributes
    ----------
    host
        Which.
    through
        The mark: all of its islands are to finish this epoch.
    horizon
        How far they may go while others of them wait for packets.
    settled
        The last mark that all hosts have finished.
    """

    host: int
    through: int
    horizon: int
    settled: int


@dataclass(frozen=True, slots=True)
class Report:
    """Every host has finished an epoch: tell how the islands stand."""

    epoch: int


@dataclass(frozen=True, slots=True)
class AskStop:
    """Ask a host to abandon the epoch in hand."""

    host: int


@dataclass(frozen=True, slots=True)
class Finish:
    """Let a host write the last of its log, and its forms if asked.

    Attributes
    ----------
    host
        Which.
    forms
        Whether to write forms.
    settled
        The last epoch reported.
    through
        The last epoch that every host has finished: where all logs are to end.
    """

    host: int
    forms: bool
    settled: int
    through: int


@dataclass(frozen=True, slots=True)
class Conclude:
    """The run is over; ``settled`` tells whether its first populations were ever scored."""

    status: Status
    reason: str
    settled: bool


Instruction: TypeAlias = Spawn | Advance | Report | AskStop | Finish | Conclude

# -- the machine -------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Archipelago:
    """The run as the orchestrator sees it.

    Attributes
    ----------
    hosts, epochs, schedule
        How many hosts there are, how many epochs follow the first population, and how hosts wait for each other.
    phase
        Where the run stands.
    waiting
        Hosts that have yet to stand, or to finish, ascending.
    lost
        Hosts that no longer answer, ascending.
    verdict
        The status that the run will conclude with, and why.
    marks
        Epochs that hosts were told to step through and that not all have finished, ascending.
    stride
        Epochs from the last mark to the one before it.
    settled
        The last mark that all hosts have finished; -1 before the first.
    calls
        For each host the marks that it was told and has yet to finish, ascending.
    done
        For each host the last epoch that it is known to have finished.
    pace
        For each host the seconds that an epoch of its last call took.
    """

    hosts: int
    epochs: int
    schedule: Schedule = "barrier"
    phase: Phase = "new"
    waiting: tuple[int, ...] = ()
    lost: tuple[int, ...] = ()
    verdict: tuple[Status, str] = ("finished", "")
    marks: tuple[int, ...] = ()
    stride: int = 1
    settled: int = -1
    calls: tuple[tuple[int, ...], ...] = ()
    done: tuple[int, ...] = ()
    pace: tuple[float, ...] = ()

    @property
    def in_step(self) -> bool:
        """Whether hosts wait for each other after each epoch."""
        return self.schedule == "barrier" and self.hosts > 1


Step = tuple[Archipelago, tuple[Instruction, ...]]


def decide(state: Archipelago, event: Event) -> Step:
    """Give the next state and what is to be done.

    An event that means nothing in the present phase (an answer that comes too late) changes nothing.
    """
    match event:
        case Begun() if state.phase == "new":
            everyone = tuple(range(state.hosts))
            return replace(state, phase="starting", waiting=everyone), tuple(Spawn(host) for host in everyone)
        case HostReady(host) if state.phase == "starting":
            return _answered(state, host)
        case EpochDone(host, epoch, seconds) if state.phase == "running" and epoch in state.calls[host][:1]:
            return _epoch_done(state, host, epoch, seconds)
        case EpochAbandoned(host, epoch) if state.phase == "running" and state.calls[host]:
            return _abandoned(state, host, epoch)
        case HostFinished(host) if state.phase == "finishing":
            return _answered(state, host)
        case HostFailed() if state.phase != "done":
            return _failed(state, event)
        case StopAsked() if state.phase in ("starting", "running") and state.verdict[0] == "finished":
            stopping = replace(state, verdict=("stopped", "asked to stop"))
            return _end(stopping) if state.phase == "starting" else _wind_up(stopping)
    return state, ()


# -- starting and finishing --------------------------------------------------------------------------------------


def _answered(state: Archipelago, host: int) -> Step:
    state = replace(state, waiting=tuple(other for other in state.waiting if other != host))
    if state.waiting:
        return state, ()
    if state.phase == "finishing":
        return _end(state)
    nobody: tuple[tuple[int, ...], ...] = ((),) * state.hosts
    return _told(replace(state, phase="running", calls=nobody, done=(-1,) * state.hosts, pace=(0.0,) * state.hosts))


def _through(state: Archipelago) -> int:
    """Give the epoch at which the logs are to end: what a lost host has not reported is not known of all."""
    return state.settled if state.lost else min(state.done)


def _finish(state: Archipelago) -> Step:
    """Let every host that still answers write what it has; forms only of a run that did not fail."""
    left = tuple(host for host in range(state.hosts) if host not in state.lost)
    if not left:
        return _end(state)
    forms, through = state.verdict[0] != "failed", _through(state)
    told = tuple(Finish(host, forms, state.settled, through) for host in left)
    return replace(state, phase="finishing", waiting=left), told


def _end(state: Archipelago) -> Step:
    status, reason = state.verdict
    through = _through(state) if state.done else -1
    report = (Report(through),) if through > state.settled and state.phase == "finishing" else ()
    return replace(state, phase="done", waiting=()), (*report, Conclude(status, reason, through >= 0))


# -- running -----------------------------------------------------------------------------------------------------


def _epoch_done(state: Archipelago, host: int, epoch: int, seconds: float) -> Step:
    # A host that was ahead answers at once: the slowest of them all says what an epoch takes.
    pace = (*state.pace[:host], seconds / max(epoch - state.done[host], 1), *state.pace[host + 1 :])
    state = replace(_called_back(state, host, epoch), pace=pace)
    settled = tuple(mark for mark in state.marks if mark <= min(state.done))
    reports = tuple(Report(mark) for mark in settled)
    if settled:
        state = replace(state, settled=settled[-1], marks=state.marks[len(settled) :])
    following, instructions = _wind_up(state, ask=False) if state.verdict[0] != "finished" else _told(state)
    return following, (*reports, *instructions)


def _called_back(state: Archipelago, host: int, epoch: int) -> Archipelago:
    """Note that a host has answered its oldest call and has come to an epoch."""
    calls = (*state.calls[:host], state.calls[host][1:], *state.calls[host + 1 :])
    done = (*state.done[:host], max(epoch, state.done[host]), *state.done[host + 1 :])
    return replace(state, calls=calls, done=done)


def _told(state: Archipelago) -> Step:
    """Tell hosts their next marks; finish once all have come to the last epoch."""
    if state.settled == state.epochs:
        return _finish(state)
    instructions: list[Instruction] = []
    for host in range(state.hosts):
        while len(state.calls[host]) < (CALLS if state.hosts > 1 and not state.in_step else 1):
            last = max(state.calls[host][-1] if state.calls[host] else -1, state.done[host])
            ahead = [mark for mark in state.marks if mark > last]
            if not ahead:
                state = _marked(state, last)
                ahead = [mark for mark in state.marks if mark > last]
            if not ahead:
                break
            instructions.append(Advance(host, ahead[0], _horizon(state, ahead[0]), state.settled))
            calls = (*state.calls[:host], (*state.calls[host], ahead[0]), *state.calls[host + 1 :])
            state = replace(state, calls=calls)
    return state, tuple(instructions)


def _marked(state: Archipelago, last: int) -> Archipelago:
    """Set a mark after the last one, if hosts may be so far apart."""
    if last == state.epochs or len(state.marks) >= (1 if state.in_step else LEAD):
        return state
    fitting = int(min(CALL_S / max(*state.pace, 1e-9), MOST_EPOCHS))
    # Not two epochs at once before it is known what one takes.
    stride = 1 if state.settled < 0 or state.in_step else max(1, min(2 * state.stride, fitting))
    mark = min(last + stride, state.epochs)
    return replace(state, marks=(*state.marks, mark), stride=stride)


def _horizon(state: Archipelago, through: int) -> int:
    if state.schedule == "barrier" or state.hosts == 1:
        return through
    return min(through + max(SLACK, state.stride), state.epochs)


# -- breaking off ------------------------------------------------------------------------------------------------


def _abandoned(state: Archipelago, host: int, epoch: int) -> Step:
    first = state.verdict[0] == "finished"
    if first:
        state = replace(state, verdict=("stopped", "asked to stop"))
    return _wind_up(_called_back(state, host, epoch), ask=first)


def _failed(state: Archipelago, event: HostFailed) -> Step:
    first = state.verdict[0] != "failed"
    if first:
        state = replace(state, verdict=("failed", event.reason))
    if not event.alive:
        state = replace(state, lost=tuple(sorted({*state.lost, event.host})))
    state = replace(state, waiting=tuple(other for other in state.waiting if other != event.host))
    if state.phase in ("new", "starting"):
        return _end(state)
    if state.phase == "finishing":
        return (state, ()) if state.waiting else _end(state)
    state = _called_back(state, event.host, event.epoch)
    if not event.alive:
        state = replace(state, calls=(*state.calls[: event.host], (), *state.calls[event.host + 1 :]))
    return _wind_up(state, ask=first)


def _wind_up(state: Archipelago, *, ask: bool = True) -> Step:
    """Wait for the calls that are on their way, asking hosts to break them off; then finish."""
    busy = tuple(host for host in range(state.hosts) if state.calls[host])
    if busy:
        return state, tuple(AskStop(host) for host in busy) if ask else ()
    return _finish(state)
