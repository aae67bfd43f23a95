"""The archipelago's decisions: a pure state machine, events in and instructions out, without any I/O.

A backend performs the instructions and reports events (:mod:`orchestrator.messages`). Hosts are told how far to step,
mark by mark: the marks are epochs, the same for all hosts. What the schedules differ in is when a host is told the next
one:

- ``barrier``: all hosts have finished the last mark, and each epoch is a mark;
- ``dataflow`` and ``async``: two calls of each host may be on their way, and the fastest host may be some marks ahead
  of the slowest; hosts that wait for packets may go on beyond their mark where they can.

A host alone waits for nobody, so that its marks may hold several epochs under every schedule. Where they may, they hold
as many as fit into a moment.

An epoch that all hosts have finished is settled, and a checkpoint stands for a settled epoch. When a host is lost, all
begin anew from the last checkpoint; so they do, from one made for it, when islands or channels change.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, Literal

from islands.orders import Schedule
from orchestrator.messages import (
    Advance,
    AskStop,
    Begun,
    Conclude,
    EpochAbandoned,
    EpochDone,
    Event,
    Finish,
    HostFailed,
    HostFinished,
    HostReady,
    Instruction,
    PartSaved,
    Pause,
    PauseAsked,
    Report,
    RestructureAsked,
    ResumeAsked,
    Rewind,
    Rewound,
    Save,
    SaveAsked,
    Seal,
    Spawn,
    Status,
    StopAsked,
)

Phase = Literal["new", "starting", "running", "saving", "finishing", "rewinding", "regrouping", "done"]
"""``rewinding`` while hosts give up what they are at, ``regrouping`` from the order to rewind until it is done."""

CALL_S: Final = 0.5
"""A call holds as many epochs as are expected to fit into this time, at least one."""

MOST_EPOCHS: Final = 32
"""Epochs of a call at most."""

CALLS: Final = 2
"""Calls of one host on their way at a time: while it performs one, the next is there already."""

LEAD: Final = 4
"""Marks that the fastest host may be ahead of the slowest."""

SLACK: Final = 8
"""Epochs, or as many as a call holds, that islands may go on beyond a mark while others wait."""

MOST_LOSSES: Final = 3
"""So often in a row hosts may be lost without the run coming any further."""


@dataclass(frozen=True, slots=True)
class Archipelago:
    """The run as the orchestrator sees it.

    Attributes
    ----------
    hosts, epochs, schedule
        How many hosts there are, how many epochs follow the first population, and how hosts wait for each other.
    every, spacing
        A checkpoint is made after so many epochs, and as many more as are expected to take ``spacing`` seconds.
    phase
        Where the run stands.
    waiting
        Hosts that have yet to stand, to write their part of a checkpoint, or to finish, ascending. Each of them answers
        once, also when nobody needs the answer any more.
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
    saved
        The epoch of the last checkpoint; -1 for none.
    saving
        That of the checkpoint that hosts are writing, while they go on; ``None`` also when it was given up.
    granted
        The last epoch that any host may have begun.
    limit
        The last epoch before islands or channels change.
    paused, save_asked
        What somebody asked for.
    trouble
        Why the hosts begin anew.
    losses, reached
        How often hosts were lost since the run came further than ``reached``, the last epoch that was settled then.
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
    every: int = 4
    spacing: float = 0.0
    phase: Phase = "new"
    waiting: tuple[int, ...] = ()
    lost: tuple[int, ...] = ()
    verdict: tuple[Status, str] = ("finished", "")
    marks: tuple[int, ...] = ()
    stride: int = 1
    settled: int = -1
    saved: int = -1
    saving: int | None = None
    granted: int = -1
    limit: int | None = None
    paused: bool = False
    save_asked: bool = False
    trouble: str = ""
    losses: int = 0
    reached: int = -1
    calls: tuple[tuple[int, ...], ...] = ()
    done: tuple[int, ...] = ()
    pace: tuple[float, ...] = ()

    @property
    def in_step(self) -> bool:
        """Whether hosts wait for each other after each epoch."""
        return self.schedule == "barrier" and self.hosts > 1

    @property
    def goal(self) -> int:
        """The epoch that hosts may come to as things are."""
        return self.epochs if self.limit is None else min(self.limit, self.epochs)


Step = tuple[Archipelago, tuple[Instruction, ...]]


def decide(state: Archipelago, event: Event) -> Step:
    """Give the next state and what is to be done.

    An event that means nothing in the present phase (an answer that comes too late) changes nothing.
    """
    if state.phase == "done":
        return state, ()
    match event:
        case Begun() if state.phase == "new":
            return _spawned(state)
        case HostFailed():
            return _failed(state, event)
        case Rewound() if state.phase == "regrouping":
            return _rewound(state, event)
        case HostReady(host) | HostFinished(host) | PartSaved(host) | EpochDone(host) | EpochAbandoned(host):
            return _answered(state, host, event)
        case StopAsked() if state.verdict[0] == "finished" and state.phase not in ("new", "saving", "finishing"):
            return _stopping(state)
        case PauseAsked() if state.phase not in ("new", "saving", "finishing") and not state.paused:
            return _go_on(replace(state, paused=True))
        case ResumeAsked() if state.paused:
            return _go_on(replace(state, paused=False))
        case SaveAsked():
            return _go_on(replace(state, save_asked=True))
        case RestructureAsked(epoch):
            limit = epoch - 1 if state.limit is None else min(state.limit, epoch - 1)
            return _go_on(replace(state, limit=limit))
    return state, ()


def ungranted(state: Archipelago) -> int:
    """Give the first epoch that no host can have begun: where a command may take effect."""
    return max(state.granted, state.settled) + 1


# -- starting ----------------------------------------------------------------------------------------------------------


def _spawned(state: Archipelago) -> Step:
    everyone = tuple(range(state.hosts))
    nobody: tuple[tuple[int, ...], ...] = ((),) * state.hosts
    state = replace(
        state, phase="starting", waiting=everyone, calls=nobody, done=(state.settled,) * state.hosts,
        pace=(0.0,) * state.hosts, granted=state.settled, saved=state.settled,
    )  # fmt: skip
    return state, tuple(Spawn(host) for host in everyone)


def _rewound(state: Archipelago, event: Rewound) -> Step:
    """Begin anew from a checkpoint."""
    # What islands or channels are changed from was saved for it: one that never stands must not be tried for ever.
    futile = state.losses + 1 if not state.lost and event.epoch < state.saved else state.losses
    if futile > MOST_LOSSES and state.verdict[0] == "finished":
        text = f"the checkpoint of epoch {state.saved} did not stand, {futile} times in a row"
        state = replace(state, verdict=("failed", text))
    state = replace(
        state, hosts=event.hosts, settled=event.epoch, lost=(), marks=(), stride=1, saving=None, limit=event.limit,
        done=(event.epoch,) * event.hosts, losses=futile,
    )  # fmt: skip
    return _spawned(state) if state.verdict[0] == "finished" else _end(state)


# -- answers -----------------------------------------------------------------------------------------------------------


def _answered(state: Archipelago, host: int, event: Event) -> Step:
    """Take an answer of a host to what it was told."""
    if host >= state.hosts or host in state.lost:
        return state, ()
    match event:
        case EpochDone(_, epoch, seconds) if epoch in state.calls[host][:1]:
            # A host that was ahead answers at once: the slowest of them all says what an epoch takes.
            paced = seconds / max(epoch - state.done[host], 1)
            pace = (*state.pace[:host], paced, *state.pace[host + 1 :])
            state = replace(_called_back(state, host, epoch), pace=pace)
            if state.phase != "rewinding":
                state, reports = _settled(state)
                following, instructions = _go_on(state)
                return following, (*reports, *instructions)
        case EpochAbandoned(_, epoch) if state.calls[host]:
            first = state.verdict[0] == "finished" and state.phase != "rewinding"
            if first:
                state = replace(state, verdict=("stopped", "asked to stop"))
            state = _called_back(state, host, epoch)
            following, instructions = _go_on(state)
            return following, ((*_stops(state), *instructions) if first else instructions)
        case PartSaved(_, epoch) if host in state.waiting and state.saving in (None, epoch):
            return _part_saved(_heard(state, host))
        case HostReady() if state.phase in ("starting", "rewinding"):
            return _go_on(_heard(state, host))
        case HostFinished() if state.phase in ("finishing", "rewinding"):
            return _go_on(_heard(state, host))
    return _go_on(state) if state.phase == "rewinding" else (state, ())


def _heard(state: Archipelago, host: int) -> Archipelago:
    return replace(state, waiting=tuple(other for other in state.waiting if other != host))


def _called_back(state: Archipelago, host: int, epoch: int) -> Archipelago:
    """Note that a host has answered its oldest call and has come to an epoch."""
    calls = (*state.calls[:host], state.calls[host][1:], *state.calls[host + 1 :])
    done = (*state.done[:host], max(epoch, state.done[host]), *state.done[host + 1 :])
    return replace(state, calls=calls, done=done)


def _settled(state: Archipelago) -> tuple[Archipelago, tuple[Report, ...]]:
    """Note marks that all hosts have finished."""
    settled = tuple(mark for mark in state.marks if mark <= min(state.done))
    if settled:
        state = replace(state, settled=settled[-1], marks=state.marks[len(settled) :])
        if state.settled > state.reached:
            state = replace(state, reached=state.settled, losses=0)
    return state, tuple(Report(mark) for mark in settled)


def _part_saved(state: Archipelago) -> Step:
    if state.waiting or state.saving is None:
        return _go_on(state)
    seal = Seal(state.saving)
    following, instructions = _go_on(replace(state, saved=state.saving, saving=None))
    return following, (seal, *instructions)


# -- going on ----------------------------------------------------------------------------------------------------------


def _go_on(state: Archipelago) -> Step:
    """Do what is next: wait, save, grant epochs, begin anew, or finish."""
    if state.phase == "starting":
        if state.waiting:
            return state, ()
        state = replace(state, phase="running")
    if state.phase == "rewinding":
        return (state, ()) if _busy(state) else _regrouped(state)
    if state.phase == "finishing":
        return (state, ()) if state.waiting else _end(state)
    if state.phase not in ("running", "saving"):
        return state, ()
    if state.verdict[0] != "finished" or state.phase == "saving":
        return (state, ()) if _busy(state) else _finish(state)
    state, saves = _saves(state)
    if state.settled >= state.goal and not any(state.calls):
        following, instructions = _at_goal(state)
    elif state.paused:
        still = not any(state.calls) and state.saving is None
        following, instructions = state, (Pause(state.settled),) if still else ()
    else:
        following, instructions = _granted(state)
    return following, (*saves, *instructions)


def _saves(state: Archipelago) -> Step:
    """Let hosts write a checkpoint of the epoch that is settled, if one is due."""
    ahead = state.settled - state.saved
    still = not any(state.calls) and (state.paused or (state.limit is not None and state.settled >= state.limit))
    due = ahead >= state.every and ahead * max(state.pace) >= state.spacing
    if state.saving is not None or ahead <= 0 or not (due or still or state.save_asked):
        return state, ()
    everyone = tuple(range(state.hosts))
    state = replace(state, saving=state.settled, waiting=everyone, save_asked=False)
    return state, tuple(Save(host, state.settled) for host in everyone)


def _at_goal(state: Archipelago) -> Step:
    """All hosts have come as far as they may: to the end, or to where islands or channels change."""
    if state.saving is not None:
        return state, ()
    if state.settled >= state.epochs:
        return _finish(state)
    return _go_on(replace(state, phase="rewinding", trouble="islands or channels change"))


def _granted(state: Archipelago) -> Step:
    """Tell hosts their next marks."""
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
            horizon = _horizon(state, ahead[0])
            instructions.append(Advance(host, ahead[0], horizon, state.settled))
            calls = (*state.calls[:host], (*state.calls[host], ahead[0]), *state.calls[host + 1 :])
            state = replace(state, calls=calls, granted=max(state.granted, horizon))
    return state, tuple(instructions)


def _marked(state: Archipelago, last: int) -> Archipelago:
    """Set a mark after the last one, if hosts may be so far apart."""
    if last >= state.goal or len(state.marks) >= (1 if state.in_step else LEAD):
        return state
    fitting = int(min(CALL_S / max(*state.pace, 1e-9), MOST_EPOCHS))
    # Not two epochs at once before it is known what one takes.
    known = all(state.pace)
    stride = max(1, min(2 * state.stride, fitting)) if known and not state.in_step else 1
    mark = min(last + stride, state.goal)
    return replace(state, marks=(*state.marks, mark), stride=stride)


def _regrouped(state: Archipelago) -> Step:
    """Nobody is at anything any more: begin anew, or end where that is wanted by now."""
    if state.verdict[0] != "finished":
        return _end(state)
    return replace(state, phase="regrouping"), (Rewind(state.lost, state.trouble),)


def _horizon(state: Archipelago, through: int) -> int:
    if state.schedule == "barrier" or state.hosts == 1:
        return through
    return min(through + max(SLACK, state.stride), state.goal)


# -- losing hosts ------------------------------------------------------------------------------------------------------


def _failed(state: Archipelago, event: HostFailed) -> Step:
    """Begin anew without a host that is lost; what a host raises, it would raise again."""
    if event.host >= state.hosts or event.host in state.lost or state.phase == "regrouping":
        return state, ()
    if state.phase == "new":
        return _end(replace(state, verdict=("failed", event.reason)))
    if event.alive:
        is_call = bool(state.calls[event.host]) and not event.part
        state = _called_back(state, event.host, event.epoch) if is_call else _heard(state, event.host)
        # Where a host is lost already, others raise because of that.
        return _go_on(state) if state.lost else _break_off(state, event.reason)
    before = state
    state = _heard(state, event.host)
    calls = (*state.calls[: event.host], (), *state.calls[event.host + 1 :])
    state = replace(state, calls=calls, lost=tuple(sorted({*state.lost, event.host})))
    if state.verdict[0] != "finished" or before.phase == "rewinding":
        following, instructions = _go_on(replace(state, saving=None))
        return following, instructions or _stops(following)
    if state.losses >= MOST_LOSSES:
        again = f"{event.reason}; it is the {state.losses + 1}th loss in a row without an epoch in between"
        return _break_off(state, again)
    state = replace(state, phase="rewinding", trouble=event.reason, losses=state.losses + 1, saving=None)
    following, instructions = _go_on(state)
    return following, instructions or _stops(state)


def _busy(state: Archipelago) -> tuple[int, ...]:
    return tuple(
        host
        for host in range(state.hosts)
        if host not in state.lost and (state.calls[host] or host in state.waiting)
    )  # fmt: skip


def _stops(state: Archipelago) -> tuple[Instruction, ...]:
    """Ask hosts to stop; those that write their part of a checkpoint and wait for one that is lost, too."""
    if state.lost:
        return tuple(AskStop(host, lost=True) for host in _busy(state))
    return tuple(AskStop(host) for host in range(state.hosts) if state.calls[host])


# -- breaking off and finishing ----------------------------------------------------------------------------------------


def _stopping(state: Archipelago) -> Step:
    state = replace(state, verdict=("stopped", "asked to stop"))
    if state.phase == "starting":
        return _end(state)
    if state.phase == "rewinding":
        # Hosts were asked to give up already, and the log must not be cut while they write to it.
        return _go_on(state)
    following, instructions = _go_on(state)
    return following, (*_stops(state), *instructions)


def _break_off(state: Archipelago, reason: str) -> Step:
    """Fail, once all hosts have given up what they are at."""
    first = state.verdict[0] != "failed"
    if first:
        state = replace(state, verdict=("failed", reason))
    if state.phase == "starting":
        return _end(state)
    state = replace(state, saving=None)
    following, instructions = _go_on(state)
    return following, ((*_stops(state), *instructions) if first else instructions)


def _through(state: Archipelago) -> int:
    """Give the epoch at which the logs are to end: what a lost host has not reported is not known of all."""
    return state.settled if state.lost else min(state.done)


def _finish(state: Archipelago) -> Step:
    """Let every host write what it has: a checkpoint, the log, and forms; no forms of a run that failed."""
    left = tuple(host for host in range(state.hosts) if host not in state.lost)
    if not left:
        return _end(state)
    through, failed = _through(state), state.verdict[0] == "failed"
    if through > state.saved and not failed and not state.lost:
        saving = replace(state, phase="saving", saving=through, waiting=left)
        return saving, tuple(Save(host, through) for host in left)
    told = tuple(Finish(host, not failed, state.settled, through) for host in left)
    return replace(state, phase="finishing", waiting=left), told


def _end(state: Archipelago) -> Step:
    status, reason = state.verdict
    through = _through(state) if state.done else -1
    report = (Report(through),) if through > state.settled and state.phase == "finishing" else ()
    end = Conclude(status, reason, max(through, state.reached) >= 0, torn=bool(state.lost))
    return replace(state, phase="done", waiting=()), (*report, end)
