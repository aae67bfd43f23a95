"""The state machine: events in, instructions out, compared as lists."""

from __future__ import annotations

import random

import pytest

from orchestrator.archipelago import (
    CALL_S,
    CALLS,
    LEAD,
    MOST_EPOCHS,
    SLACK,
    Advance,
    Archipelago,
    AskStop,
    Begun,
    Conclude,
    EpochAbandoned,
    EpochDone,
    Finish,
    HostFailed,
    HostFinished,
    HostReady,
    Report,
    Spawn,
    StopAsked,
    decide,
)

FORMS, NO_FORMS = True, False
SETTLED, UNSETTLED = True, False
SLOW = 10 * CALL_S


def play(state, *events):
    told = []
    for event in events:
        state, instructions = decide(state, event)
        told.append(list(instructions))
    return state, told


def running(hosts=2, epochs=3, schedule="barrier"):
    return play(Archipelago(hosts, epochs, schedule), Begun(), *(HostReady(host) for host in range(hosts)))[0]


def test_a_run_from_beginning_to_end() -> None:
    state, told = play(
        Archipelago(2, 1),
        Begun(),
        HostReady(1),
        HostReady(0),
        EpochDone(0, 0),
        EpochDone(1, 0),
        EpochDone(1, 1),
        EpochDone(0, 1),
        HostFinished(0),
        HostFinished(1),
    )
    assert told == [
        [Spawn(0), Spawn(1)],
        [],
        [Advance(0, 0, 0, -1), Advance(1, 0, 0, -1)],
        [],
        [Report(0), Advance(0, 1, 1, 0), Advance(1, 1, 1, 0)],
        [],
        [Report(1), Finish(0, FORMS, 1, 1), Finish(1, FORMS, 1, 1)],
        [],
        [Conclude("finished", "", SETTLED)],
    ]
    assert state.phase == "done"


def test_no_epochs_score_the_first_population_alone() -> None:
    _, told = play(Archipelago(1, 0), Begun(), HostReady(0), EpochDone(0, 0), HostFinished(0))
    assert told[2:] == [[Report(0), Finish(0, FORMS, 0, 0)], [Conclude("finished", "", SETTLED)]]


def test_the_barrier_waits_for_the_last_host() -> None:
    state, told = play(running(3), EpochDone(2, 0), EpochDone(0, 0))
    assert told == [[], []]
    assert play(state, EpochDone(1, 0))[1][0][0] == Report(0)


@pytest.mark.parametrize("schedule", ["dataflow", "async"])
def test_other_schedules_let_hosts_run_ahead_by_a_bounded_lead(schedule) -> None:
    state, _ = play(Archipelago(2, 99, schedule), Begun(), HostReady(0))
    state, told = play(state, HostReady(1), *(EpochDone(0, mark, SLOW) for mark in range(LEAD)))
    assert told[0] == [Advance(host, mark, mark + SLACK, -1) for host in (0, 1) for mark in range(CALLS)]
    assert told[1:] == [[Advance(0, mark, mark + SLACK, -1)] for mark in range(CALLS, LEAD)] + [[], []]
    _, told = play(state, EpochDone(1, 0, SLOW))
    assert told == [[Report(0), Advance(0, LEAD, LEAD + SLACK, 0), Advance(1, CALLS, CALLS + SLACK, 0)]]


def test_calls_hold_as_many_epochs_as_fit_into_a_moment() -> None:
    state, through = running(1, 10**6), []
    for _ in range(12):
        (mark,) = state.calls[0][:1]
        through.append(mark - max(state.settled, -1))
        state, _ = decide(state, EpochDone(0, mark, 1e-9))
    assert through[:4] == [1, 2, 4, 8]
    assert max(through) == through[-1] == MOST_EPOCHS
    for _ in range(3):
        (mark,) = state.calls[0][:1]
        state, _ = decide(state, EpochDone(0, mark, SLOW * MOST_EPOCHS))
    assert state.stride == 1


def test_the_slowest_host_says_what_an_epoch_takes() -> None:
    """One that was ahead answers at once, and its next call must not be long for that."""
    state = running(2, 10**6, "dataflow")
    for _ in range(20):
        (mark,) = state.calls[1][:1]
        state, _ = decide(state, EpochDone(1, mark, SLOW))
        (mark,) = state.calls[0][:1]
        state, _ = decide(state, EpochDone(0, mark, 0.0))
    assert state.stride == 1


def test_epochs_are_never_more_than_asked_for() -> None:
    state, marks = running(1, 7), []
    while state.phase == "running":
        marks.append(state.calls[0][0])
        state, told = decide(state, EpochDone(0, marks[-1], 0.0))
    assert marks[-1] == 7
    assert told == (Report(7), Finish(0, FORMS, 7, 7))


def test_a_stop_abandons_the_epoch_and_lets_all_hosts_write_up_to_a_common_one() -> None:
    state, _ = play(running(3, 50, "dataflow"), *(EpochDone(host, 0, SLOW) for host in range(3)))
    _, told = play(
        state,
        EpochDone(0, 1, SLOW),
        StopAsked(),
        EpochDone(0, 2, SLOW),
        EpochAbandoned(0, 4),
        EpochAbandoned(1, 3),
        EpochAbandoned(1, 3),
        EpochAbandoned(2, 2),
        EpochAbandoned(2, 2),
        HostFinished(0),
        HostFinished(1),
        HostFinished(2),
    )
    assert told[1:] == [
        [AskStop(0), AskStop(1), AskStop(2)],
        [], [], [], [], [],
        [Finish(0, FORMS, 0, 2), Finish(1, FORMS, 0, 2), Finish(2, FORMS, 0, 2)],
        [],
        [],
        [Report(2), Conclude("stopped", "asked to stop", SETTLED)],
    ]  # fmt: skip


def test_a_stop_that_only_the_hosts_heard_ends_the_run_too() -> None:
    _, told = play(running(1), EpochAbandoned(0, -1), StopAsked(), HostFinished(0))
    conclusion = Conclude("stopped", "asked to stop", UNSETTLED)
    assert told == [[Finish(0, FORMS, -1, -1)], [], [conclusion]]


def test_a_stop_before_any_host_stands_ends_the_run_at_once() -> None:
    assert play(Archipelago(2, 3), Begun(), StopAsked())[1][1] == [Conclude("stopped", "asked to stop", UNSETTLED)]


def test_a_host_that_dies_fails_the_run_and_the_others_write_what_all_are_known_to_have() -> None:
    _, told = play(
        running(3),
        *(EpochDone(host, 0) for host in range(3)),
        HostFailed(1, "host 1 died", alive=False),
        EpochAbandoned(0, 0),
        EpochDone(2, 1),
        HostFinished(0),
        HostFinished(2),
    )
    assert told[3:] == [
        [AskStop(0), AskStop(2)],
        [],
        [Finish(0, NO_FORMS, 0, 0), Finish(2, NO_FORMS, 0, 0)],
        [],
        [Conclude("failed", "host 1 died", SETTLED)],
    ]


def test_a_host_that_raised_still_writes_its_log() -> None:
    state, _ = play(running(1, 50), EpochDone(0, 0))
    _, told = play(state, HostFailed(0, "disk full", alive=True, epoch=1), HostFinished(0))
    assert told == [[Finish(0, NO_FORMS, 0, 1)], [Report(1), Conclude("failed", "disk full", SETTLED)]]


def test_a_host_that_raised_is_kept_from_its_next_call() -> None:
    state, _ = play(running(2, 50, "async"), EpochDone(0, 0, SLOW), EpochDone(1, 0, SLOW))
    failure = HostFailed(0, "disk full", alive=True)
    _, told = play(state, failure, failure, EpochAbandoned(1, 0), EpochAbandoned(1, 0))
    assert told == [[AskStop(0), AskStop(1)], [], [], [Finish(0, NO_FORMS, 0, 0), Finish(1, NO_FORMS, 0, 0)]]


def test_a_failed_start_concludes_at_once() -> None:
    _, told = play(Archipelago(2, 3), Begun(), HostReady(0), HostFailed(1, "no such file", alive=True))
    assert told[-1] == [Conclude("failed", "no such file", UNSETTLED)]


def test_a_host_that_fails_while_finishing_fails_the_run() -> None:
    _, told = play(running(2, 0), EpochDone(0, 0), EpochDone(1, 0), HostFinished(0), HostFailed(1, "full", alive=True))
    assert told[-1] == [Conclude("failed", "full", SETTLED)]


def test_the_last_host_to_die_leaves_nobody_to_finish() -> None:
    assert play(running(1), HostFailed(0, "died", alive=False))[1] == [[Conclude("failed", "died", UNSETTLED)]]


@pytest.mark.parametrize("event", [HostReady(0), EpochDone(0, 7), HostFinished(0), Begun()])
def test_answers_out_of_place_change_nothing(event) -> None:
    state = running()
    assert decide(state, event) == (state, ())


def test_an_answer_given_twice_counts_once() -> None:
    state, _ = play(running(2), EpochDone(0, 0))
    assert decide(state, EpochDone(0, 0)) == (state, ())


def test_nothing_follows_the_conclusion() -> None:
    state, _ = play(running(1), HostFailed(0, "died", alive=False))
    for event in (EpochDone(0, 0), HostFailed(0, "again", alive=False), StopAsked(), HostFinished(0)):
        assert decide(state, event) == (state, ())


def answered(what, seconds, stood):
    """Give a host's answer, having seen that it was asked for what it can do."""
    match what:
        case Spawn(host):
            return HostReady(host)
        case Advance(host, through, horizon, settled):
            assert stood[host] < through <= horizon
            assert settled <= min(stood)
            return EpochDone(host, through, seconds)
        case Finish(host, _, _, through):
            assert through <= min(stood)
            return HostFinished(host)


def troubled(answer, rng, trouble, stood):
    """Give an answer, or what comes in its place where there is trouble."""
    if rng.random() < trouble:
        return HostFailed(answer.host, "trouble", rng.random() < 0.5, stood)
    if isinstance(answer, EpochDone) and rng.random() < trouble:
        return EpochAbandoned(answer.host, stood)
    return answer


@pytest.mark.parametrize("schedule", ["barrier", "dataflow", "async"])
@pytest.mark.parametrize("seed", range(150))
def test_whatever_happens_it_concludes_exactly_once_and_never_hangs(seed, schedule) -> None:
    """Hosts that answer in any order, fail, die, or are stopped at any moment."""
    rng = random.Random(seed)
    hosts, epochs = rng.randint(1, 4), rng.randint(0, 40)
    state, pending, dead, stood = Archipelago(hosts, epochs, schedule), [], set(), {}
    conclusions, reports = [], []

    def feed(event) -> None:
        nonlocal state
        state, instructions = decide(state, event)
        for instruction in instructions:
            match instruction:
                case Conclude():
                    conclusions.append(instruction)
                case Report(epoch):
                    reports.append(epoch)
                case AskStop():
                    pass
                case _:
                    assert instruction.host not in dead
                    pending.append(instruction)
        calls = [sum(isinstance(one, Advance) and one.host == host for one in pending) for host in range(hosts)]
        assert max(calls) <= (1 if state.in_step else CALLS)

    feed(Begun())
    trouble = rng.choice([0.0, 0.02, 0.2])
    while not conclusions:
        assert pending, "the machine waits for nobody"
        host = rng.choice([one.host for one in pending])
        what = next(one for one in pending if one.host == host)
        pending.remove(what)
        answer = answered(what, rng.random() * 2 * CALL_S, [stood.get(other, -1) for other in range(hosts)])
        answer = troubled(answer, rng, trouble, stood.get(host, -1))
        if isinstance(answer, HostFailed) and not answer.alive:
            dead.add(host)
            pending = [one for one in pending if one.host != host]
        if isinstance(answer, EpochDone):
            stood[host] = answer.epoch
        feed(answer)
        if rng.random() < trouble:
            feed(StopAsked())
    assert len(conclusions) == 1
    assert reports == sorted(set(reports))
    if trouble == 0:
        assert conclusions[0].status == "finished"
        assert reports[-1] == epochs
