"""The archipelago's decisions: a pure state machine, events in and instructions out, without any I/O.

A backend performs the instructions and reports events. The schedule here is ``barrier``: the hosts begin an epoch
when all of them have finished the one before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

Status = Literal["finished", "failed", "stopped"]
Phase = Literal["new", "starting", "running", "finishing", "done"]

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
    """A host has stepped its islands through an epoch; its boxes can be fetched from where it is."""

    host: int
    epoch: int


@dataclass(frozen=True, slots=True)
class EpochAbandoned:
    """A host broke an epoch off because it was asked to stop."""

    host: int
    epoch: int


@dataclass(frozen=True, slots=True)
class HostFinished:
    """A host has written the last of its log and its forms."""

    host: int


@dataclass(frozen=True, slots=True)
class HostFailed:
    """A host raised an error, died, or did not answer within its deadline."""

    host: int
    reason: str
    alive: bool


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
    """Let a host step through an epoch, with the boxes that the hosts named have for it from the epoch before."""

    host: int
    epoch: int
    inboxes: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Report:
    """Every host has finished an epoch: tell how the islands stand; boxes of earlier epochs can go."""

    epoch: int


@dataclass(frozen=True, slots=True)
class AskStop:
    """Ask a host to abandon the epoch in hand."""

    host: int


@dataclass(frozen=True, slots=True)
class Finish:
    """Let a host write the last of its log, and its forms if asked."""

    host: int
    forms: bool


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
    hosts, epochs
        How many hosts there are, and how many epochs follow the first population.
    phase
        Where the run stands.
    epoch
        The epoch in hand.
    waiting
        Hosts that have yet to answer, ascending.
    lost
        Hosts that no longer answer, ascending.
    verdict
        The status that the run will conclude with, and why.
    settled
        Whether epoch 0 is done.
    """

    hosts: int
    epochs: int
    phase: Phase = "new"
    epoch: int = 0
    waiting: tuple[int, ...] = ()
    lost: tuple[int, ...] = ()
    verdict: tuple[Status, str] = ("finished", "")
    settled: bool = False


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
        case EpochDone(host, epoch) if state.phase == "running" and epoch == state.epoch:
            return _answered(state, host)
        case EpochAbandoned(host, epoch) if state.phase == "running" and epoch == state.epoch:
            return _answered(state, host, "stopped")
        case HostFinished(host) if state.phase == "finishing":
            return _answered(state, host)
        case HostFailed(host, reason, alive) if state.phase != "done":
            return _failed(state, host, reason, alive=alive)
        case StopAsked() if state.phase in ("starting", "running") and state.verdict[0] == "finished":
            stopping = replace(state, verdict=("stopped", "asked to stop"))
            if state.phase == "starting":
                return _end(stopping)
            return stopping, tuple(AskStop(host) for host in state.waiting)
    return state, ()


def _answered(state: Archipelago, host: int, verdict: Status | None = None) -> Step:
    if host not in state.waiting:
        return state, ()
    if verdict is not None and state.verdict[0] == "finished":
        state = replace(state, verdict=(verdict, "asked to stop"))
    state = replace(state, waiting=tuple(other for other in state.waiting if other != host))
    return _everyone_answered(state) if not state.waiting else (state, ())


def _everyone_answered(state: Archipelago) -> Step:
    if state.phase == "finishing":
        return _end(state)
    if state.verdict[0] != "finished":
        return _finish(state)
    if state.phase == "starting":
        return _advance(replace(state, phase="running"), 0)
    report = Report(state.epoch)
    state = replace(state, settled=True)
    if state.epoch == state.epochs:
        following, instructions = _finish(state)
    else:
        following, instructions = _advance(state, state.epoch + 1)
    return following, (report, *instructions)


def _advance(state: Archipelago, epoch: int) -> Step:
    everyone = tuple(range(state.hosts))
    sources = everyone if epoch > 0 else ()
    instructions = tuple(
        Advance(host, epoch, tuple(source for source in sources if source != host)) for host in everyone
    )
    return replace(state, epoch=epoch, waiting=everyone), instructions


def _finish(state: Archipelago) -> Step:
    """Let every host that still answers write what it has; forms only of a run that did not fail."""
    left = tuple(host for host in range(state.hosts) if host not in state.lost)
    if not left or state.phase == "starting":
        return _end(state)
    forms = state.verdict[0] != "failed"
    return replace(state, phase="finishing", waiting=left), tuple(Finish(host, forms) for host in left)


def _failed(state: Archipelago, host: int, reason: str, *, alive: bool) -> Step:
    first = state.verdict[0] != "failed"
    state = replace(state, verdict=("failed", reason)) if first else state
    lost = state.lost if alive else tuple(sorted({*state.lost, host}))
    state = replace(state, lost=lost, waiting=tuple(other for other in state.waiting if other != host))
    if state.phase in ("new", "starting"):
        return _end(state)
    if not state.waiting:
        return _end(state) if state.phase == "finishing" else _finish(state)
    if state.phase == "running" and first:
        return state, tuple(AskStop(other) for other in state.waiting)
    return state, ()


def _end(state: Archipelago) -> Step:
    status, reason = state.verdict
    return replace(state, phase="done", waiting=()), (Conclude(status, reason, state.settled),)
