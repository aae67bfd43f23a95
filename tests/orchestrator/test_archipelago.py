"""The state machine: events in, instructions out, compared as lists."""

from __future__ import annotations

import random

import pytest

from orchestrator.archipelago import (
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


def play(state, *events):
    told = []
    for event in events:
        state, instructions = decide(state, event)
        told.append(list(instructions))
    return state, told


def running(hosts=2, epochs=3):
    return play(Archipelago(hosts, epochs), Begun(), *(HostReady(host) for host in range(hosts)))[0]


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
        [Advance(0, 0, ()), Advance(1, 0, ())],
        [],
        [Report(0), Advance(0, 1, (1,)), Advance(1, 1, (0,))],
        [],
        [Report(1), Finish(0, FORMS), Finish(1, FORMS)],
        [],
        [Conclude("finished", "", SETTLED)],
    ]
    assert state.phase == "done"


def test_no_epochs_score_the_first_population_alone() -> None:
    _, told = play(Archipelago(1, 0), Begun(), HostReady(0), EpochDone(0, 0), HostFinished(0))
    assert told[2:] == [[Report(0), Finish(0, FORMS)], [Conclude("finished", "", SETTLED)]]


def test_the_barrier_waits_for_the_last_host() -> None:
    state, told = play(running(3), EpochDone(2, 0), EpochDone(0, 0))
    assert told == [[], []]
    assert state.waiting == (1,)
    assert play(state, EpochDone(1, 0))[1][0][0] == Report(0)


def test_a_stop_abandons_the_epoch_and_lets_all_hosts_write() -> None:
    _, told = play(
        running(3),
        EpochDone(0, 0),
        StopAsked(),
        EpochDone(1, 0),
        EpochAbandoned(2, 0),
        HostFinished(0),
        HostFinished(1),
        HostFinished(2),
    )
    assert told == [
        [],
        [AskStop(1), AskStop(2)],
        [],
        [Finish(0, FORMS), Finish(1, FORMS), Finish(2, FORMS)],
        [],
        [],
        [Conclude("stopped", "asked to stop", UNSETTLED)],
    ]


def test_a_stop_that_only_the_hosts_heard_ends_the_run_too() -> None:
    _, told = play(running(1), EpochAbandoned(0, 0), StopAsked(), HostFinished(0))
    assert told == [[Finish(0, FORMS)], [], [Conclude("stopped", "asked to stop", UNSETTLED)]]


def test_a_stop_before_any_host_stands_ends_the_run_at_once() -> None:
    assert play(Archipelago(2, 3), Begun(), StopAsked())[1][1] == [Conclude("stopped", "asked to stop", UNSETTLED)]


def test_a_host_that_dies_fails_the_run_and_the_others_write_their_log() -> None:
    _, told = play(
        running(3),
        *(EpochDone(host, 0) for host in range(3)),
        HostFailed(1, "host 1 died", alive=False),
        EpochAbandoned(0, 1),
        EpochAbandoned(2, 1),
        HostFinished(0),
        HostFinished(2),
    )
    assert told[3:] == [
        [AskStop(0), AskStop(2)],
        [],
        [Finish(0, NO_FORMS), Finish(2, NO_FORMS)],
        [],
        [Conclude("failed", "host 1 died", SETTLED)],
    ]


def test_a_host_that_raised_still_writes_its_log() -> None:
    _, told = play(running(1), HostFailed(0, "disk full", alive=True), HostFinished(0))
    assert told == [[Finish(0, NO_FORMS)], [Conclude("failed", "disk full", UNSETTLED)]]


def test_a_failed_start_concludes_at_once() -> None:
    _, told = play(Archipelago(2, 3), Begun(), HostReady(0), HostFailed(1, "no such file", alive=True))
    assert told[-1] == [Conclude("failed", "no such file", UNSETTLED)]


def test_a_host_that_fails_while_finishing_fails_the_run() -> None:
    _, told = play(running(2, 0), EpochDone(0, 0), EpochDone(1, 0), HostFinished(0), HostFailed(1, "full", alive=True))
    assert told[-1] == [Conclude("failed", "full", SETTLED)]


def test_the_last_host_to_die_leaves_nobody_to_finish() -> None:
    assert play(running(1), HostFailed(0, "died", alive=False))[1] == [[Conclude("failed", "died", UNSETTLED)]]


@pytest.mark.parametrize("event", [HostReady(0), EpochDone(0, 7), EpochAbandoned(0, 7), HostFinished(0), Begun()])
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


@pytest.mark.parametrize("seed", range(300))
def test_whatever_happens_it_concludes_exactly_once_and_never_hangs(seed) -> None:
    """Hosts that answer in any order, fail, die, or are stopped at any moment."""
    rng = random.Random(seed)
    hosts, epochs = rng.randint(1, 4), rng.randint(0, 4)
    state, pending, dead = Archipelago(hosts, epochs), [], set()
    conclusions = []

    def feed(event) -> None:
        nonlocal state
        state, instructions = decide(state, event)
        for instruction in instructions:
            if isinstance(instruction, Conclude):
                conclusions.append(instruction)
            elif not isinstance(instruction, (Report, AskStop)):
                assert instruction.host not in dead
                pending.append(instruction)

    feed(Begun())
    trouble = rng.random() * 0.2
    while not conclusions:
        assert pending, "the machine waits for nobody"
        what = pending.pop(rng.randrange(len(pending)))
        answers = {
            Spawn: lambda w: HostReady(w.host),
            Advance: lambda w: EpochDone(w.host, w.epoch),
            Finish: lambda w: HostFinished(w.host),
        }
        if rng.random() < trouble:
            alive = rng.random() < 0.5
            if not alive:
                dead.add(what.host)
            feed(HostFailed(what.host, "trouble", alive))
        elif isinstance(what, Advance) and rng.random() < trouble:
            feed(EpochAbandoned(what.host, what.epoch))
        else:
            feed(answers[type(what)](what))
        if rng.random() < trouble:
            feed(StopAsked())
    assert len(conclusions) == 1
    if trouble == 0:
        assert conclusions[0].status == "finished"
