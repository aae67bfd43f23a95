"""The state machine: events in, instructions out, compared as lists."""

from __future__ import annotations

import pytest

from orchestrator.archipelago import (
    CALL_S,
    CALLS,
    LEAD,
    MOST_EPOCHS,
    MOST_LOSSES,
    SLACK,
    Archipelago,
    decide,
    ungranted,
)
from orchestrator.messages import (
    Advance,
    AskStop,
    Begun,
    Conclude,
    EpochAbandoned,
    EpochDone,
    Finish,
    HostFailed,
    HostFinished,
    HostReady,
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
    StopAsked,
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


def running(hosts=2, epochs=3, schedule="barrier", **settings):
    state = Archipelago(hosts, epochs, schedule, **settings)
    return play(state, Begun(), *(HostReady(host) for host in range(hosts)))[0]


def settled(state, *epochs):
    """Let all hosts finish these epochs."""
    return play(state, *(EpochDone(host, epoch, SLOW) for epoch in epochs for host in range(state.hosts)))[0]


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
        PartSaved(1, 1),
        PartSaved(0, 1),
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
        [Report(1), Save(0, 1), Save(1, 1)],
        [],
        [Seal(1), Finish(0, FORMS, 1, 1), Finish(1, FORMS, 1, 1)],
        [],
        [Conclude("finished", "", SETTLED)],
    ]
    assert state.phase == "done"


def test_no_epochs_score_the_first_population_alone() -> None:
    _, told = play(Archipelago(1, 0), Begun(), HostReady(0), EpochDone(0, 0), PartSaved(0, 0), HostFinished(0))
    assert told[2:] == [[Report(0), Save(0, 0)], [Seal(0), Finish(0, FORMS, 0, 0)], [Conclude("finished", "", SETTLED)]]


def test_the_barrier_waits_for_the_last_host() -> None:
    state, told = play(running(3), EpochDone(2, 0), EpochDone(0, 0))
    assert told == [[], []]
    assert play(state, EpochDone(1, 0))[1][0][0] == Report(0)


@pytest.mark.parametrize("schedule", ["dataflow", "async"])
def test_other_schedules_let_hosts_run_ahead_by_a_bounded_lead(schedule) -> None:
    state, _ = play(Archipelago(2, 99, schedule, every=99), Begun(), HostReady(0))
    state, told = play(state, HostReady(1), *(EpochDone(0, mark, SLOW) for mark in range(LEAD)))
    assert told[0] == [Advance(host, mark, mark + SLACK, -1) for host in (0, 1) for mark in range(CALLS)]
    assert told[1:] == [[Advance(0, mark, mark + SLACK, -1)] for mark in range(CALLS, LEAD)] + [[], []]
    _, told = play(state, EpochDone(1, 0, SLOW))
    assert told == [[Report(0), Advance(0, LEAD, LEAD + SLACK, 0), Advance(1, CALLS, CALLS + SLACK, 0)]]


def test_calls_hold_as_many_epochs_as_fit_into_a_moment() -> None:
    state, through = running(1, 10**6, every=10**6), []
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
        if state.phase == "running" and state.saving is not None:
            state, _ = decide(state, PartSaved(0, state.saving))
    assert marks[-1] == 7
    assert told == (Report(7), Save(0, 7))


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
        PartSaved(2, 2),
        PartSaved(1, 2),
        PartSaved(0, 2),
        HostFinished(0),
        HostFinished(1),
        HostFinished(2),
    )
    assert told[1:] == [
        [AskStop(0), AskStop(1), AskStop(2)],
        [], [], [], [], [],
        [Save(0, 2), Save(1, 2), Save(2, 2)],
        [],
        [],
        [Seal(2), Finish(0, FORMS, 0, 2), Finish(1, FORMS, 0, 2), Finish(2, FORMS, 0, 2)],
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


def test_when_a_host_dies_all_begin_anew_from_the_last_checkpoint() -> None:
    state = settled(running(3, 9), 0, 1, 2, 3)
    state, told = play(
        state,
        *(PartSaved(host, 3) for host in range(3)),
        EpochDone(0, 4),
        HostFailed(1, "host 1 died", alive=False),
        EpochAbandoned(2, 3),
        Rewound(3, 2),
        HostReady(0),
        HostReady(1),
    )
    assert told == [
        [],
        [],
        [Seal(3)],
        [],
        [AskStop(2, lost=True)],
        [Rewind((1,), "host 1 died")],
        [Spawn(0), Spawn(1)],
        [],
        [Advance(0, 4, 4, 3), Advance(1, 4, 4, 3)],
    ]
    assert (state.settled, state.saved, state.lost, state.saving) == (3, 3, (), None)


def test_a_checkpoint_is_due_after_so_many_epochs_and_seconds() -> None:
    state = running(2, 99, every=2, spacing=3.5 * SLOW)
    state, told = play(state, *(EpochDone(host, epoch, SLOW) for epoch in range(4) for host in (0, 1)))
    saves = [[one for one in step if isinstance(one, Save)] for step in told]
    assert saves == [[], [], [], [], [], [], [], [Save(0, 3), Save(1, 3)]]
    state, told = play(state, SaveAsked(), EpochDone(0, 4, SLOW), EpochDone(1, 4, SLOW), PartSaved(1, 3))
    assert [one for step in told for one in step if isinstance(one, Save)] == []
    state, told = play(state, PartSaved(0, 3))
    assert told == [[Seal(3), Save(0, 4), Save(1, 4)]]


def test_a_run_that_is_paused_saves_where_it_stands_and_waits() -> None:
    state, told = play(
        settled(running(2, 9), 0),
        PauseAsked(), PauseAsked(), EpochDone(0, 1), EpochDone(1, 1), PartSaved(1, 1), PartSaved(0, 1), ResumeAsked(),
    )  # fmt: skip
    assert told == [
        [], [], [], [Report(1), Save(0, 1), Save(1, 1)], [], [Seal(1), Pause(1)],
        [Advance(0, 2, 2, 1), Advance(1, 2, 2, 1)],
    ]  # fmt: skip
    assert decide(state, ResumeAsked()) == (state, ())


def test_a_paused_run_can_be_stopped() -> None:
    state, _ = play(running(1, 9), PauseAsked(), EpochDone(0, 0), PartSaved(0, 0))
    assert play(state, StopAsked())[1] == [[Finish(0, FORMS, 0, 0)]]


@pytest.mark.parametrize("schedule", ["barrier", "dataflow", "async"])
def test_no_host_goes_beyond_the_epoch_before_islands_change(schedule) -> None:
    state = settled(running(2, 40, schedule), 0, 1)
    change = ungranted(state)
    state, told = play(state, RestructureAsked(change + 3), RestructureAsked(change), RestructureAsked(change + 1))
    for _ in range(99):
        if state.phase != "running":
            break
        orders = [EpochDone(host, state.calls[host][0], SLOW) for host in (0, 1) if state.calls[host]]
        orders += [PartSaved(host, state.saving) for host in state.waiting]
        state, found = play(state, *orders)
        told += found
    told = [one for step in told for one in step]
    assert max([0, *(one.horizon for one in told if isinstance(one, Advance))]) <= change - 1
    assert state.settled == state.saved == change - 1
    assert told[-2:] == [Seal(change - 1), Rewind((), "islands or channels change")]
    state, told = play(state, Rewound(change - 1, 2, change), HostReady(0), HostReady(1))
    assert [one.horizon for step in told for one in step if isinstance(one, Advance)] == [change, change]


def test_a_checkpoint_that_never_stands_is_not_made_for_ever() -> None:
    state = Archipelago(1, 9, limit=0)
    state, told = play(state, Begun())
    for _ in range(MOST_LOSSES):
        state, told = play(state, HostReady(0), EpochDone(0, 0), PartSaved(0, 0), Rewound(-1, 1, 0))
        assert told[-1] == [Spawn(0)]
    _, told = play(state, HostReady(0), EpochDone(0, 0), PartSaved(0, 0), Rewound(-1, 1, 0))
    assert told[-1] == [Conclude("failed", "the checkpoint of epoch 0 did not stand, 4 times in a row", SETTLED)]


def test_an_order_to_rewind_is_given_once() -> None:
    state, told = play(running(2), HostFailed(0, "died", alive=False), EpochDone(1, 0))
    assert told == [[AskStop(1, lost=True)], [Rewind((0,), "died")]]
    for event in (PauseAsked(), SaveAsked(), RestructureAsked(3), ResumeAsked(), HostFailed(1, "late", alive=False)):
        state, told = play(state, event)
        assert told == [[]]
    assert play(state, Rewound(-1, 2))[1] == [[Spawn(0), Spawn(1)]]


def test_a_stop_while_hosts_give_up_waits_for_them_since_the_log_will_be_cut() -> None:
    state, _ = play(running(3, 9), HostFailed(0, "died", alive=False), EpochDone(1, 0))
    _, told = play(state, StopAsked(), EpochAbandoned(2, -1))
    assert told == [[], [Conclude("stopped", "asked to stop", UNSETTLED, torn=True)]]


def test_a_stop_while_all_is_made_ready_again_ends_the_run_at_its_checkpoint() -> None:
    state, _ = play(running(1, 9, settled=4, reached=4), HostFailed(0, "died", alive=False))
    _, told = play(state, StopAsked(), Rewound(4, 1))
    assert told == [[], [Conclude("stopped", "asked to stop", SETTLED)]]


def test_hosts_may_be_lost_so_often_without_coming_any_further() -> None:
    state = running(2, 9)
    for _ in range(MOST_LOSSES):
        state, told = play(state, HostFailed(0, "died", alive=False), EpochAbandoned(1, -1))
        assert told[-1] == [Rewind((0,), "died")]
        state, _ = play(state, Rewound(-1, 2), HostReady(0), HostReady(1))
    _, told = play(state, HostFailed(0, "died", alive=False), EpochAbandoned(1, -1), HostFinished(1))
    reason = "died; it is the 4th loss in a row without an epoch in between"
    assert told == [
        [AskStop(1, lost=True)], [Finish(1, NO_FORMS, -1, -1)], [Conclude("failed", reason, UNSETTLED, torn=True)]
    ]  # fmt: skip
    state = settled(state, 0)
    assert play(state, HostFailed(0, "died", alive=False))[1] == [[AskStop(1, lost=True)]]


def test_a_host_that_dies_as_it_writes_the_last_checkpoint_is_no_end() -> None:
    state, told = play(settled(running(2, 0), 0), HostFailed(1, "died", alive=False))
    assert told == [[AskStop(0, lost=True)]]  # it may wait for packets that never come
    failure = HostFailed(0, "gave up", alive=True, part=True)
    assert play(state, failure)[1] == [[Rewind((1,), "died")]]
    assert play(state, PartSaved(0, 0))[1] == [[Rewind((1,), "died")]]


def test_what_a_lost_host_has_not_reported_counts_for_nobody() -> None:
    state, told = play(settled(running(2, 9), 0), StopAsked(), EpochAbandoned(0, 1), EpochAbandoned(1, 1))
    assert told[-1] == [Save(0, 1), Save(1, 1)]
    _, told = play(state, HostFailed(1, "died", alive=False), PartSaved(0, 1), HostFinished(0))
    conclusion = Conclude("stopped", "asked to stop", SETTLED, torn=True)
    assert told == [[AskStop(0, lost=True)], [Finish(0, FORMS, 0, 0)], [conclusion]]


def test_a_run_that_begins_anew_from_its_end_only_finishes() -> None:
    state, _ = play(settled(running(1, 0), 0), PartSaved(0, 0), HostFailed(0, "died", alive=False))
    _, told = play(state, Rewound(0, 1), HostReady(0), HostFinished(0))
    assert told == [[Spawn(0)], [Finish(0, FORMS, 0, 0)], [Conclude("finished", "", SETTLED)]]


@pytest.mark.parametrize("after", [HostFailed(1, "died", alive=False), HostFailed(1, "full", alive=True, part=True)])
def test_a_stop_ends_though_a_part_of_a_checkpoint_never_comes(after) -> None:
    state = settled(running(2, 9), 0, 1, 2, 3)
    assert state.saving == 3
    state, told = play(state, StopAsked(), after, EpochAbandoned(0, 3), EpochAbandoned(1, 3), PartSaved(0, 3))
    assert [isinstance(one, Seal) for step in told for one in step] == [False] * sum(map(len, told))
    assert told[-1] == [Finish(host, after.part is False, 3, 3) for host in (0, 1) if host not in state.lost]


def test_a_host_that_could_not_write_its_part_still_has_its_call_to_answer() -> None:
    state = settled(running(2, 9), 0, 1, 2, 3)
    state, told = play(state, PartSaved(1, 3), HostFailed(0, "full", alive=True, part=True))
    assert told == [[], [AskStop(0), AskStop(1)]]
    _, told = play(state, EpochAbandoned(1, 3), EpochDone(0, 4))
    assert told == [[], [Finish(0, NO_FORMS, 3, 3), Finish(1, NO_FORMS, 3, 3)]]


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
    state, _ = play(settled(running(2, 0), 0), PartSaved(0, 0), PartSaved(1, 0))
    _, told = play(state, HostFinished(0), HostFailed(1, "full", alive=True))
    assert told[-1] == [Conclude("failed", "full", SETTLED)]


def test_the_last_host_to_die_leaves_nobody_to_wait_for() -> None:
    assert play(running(1), HostFailed(0, "died", alive=False))[1] == [[Rewind((0,), "died")]]
    stopped, _ = play(running(1), StopAsked())
    conclusion = Conclude("stopped", "asked to stop", UNSETTLED, torn=True)
    assert play(stopped, HostFailed(0, "died", alive=False))[1] == [[conclusion]]


def test_a_run_that_was_scored_once_says_so_also_where_it_fell_back_to_its_start() -> None:
    state, _ = play(settled(running(1, 9), 0), HostFailed(0, "died", alive=False), Rewound(-1, 1))
    _, told = play(state, HostFailed(0, "no such file", alive=True))
    assert told == [[Conclude("failed", "no such file", SETTLED)]]


@pytest.mark.parametrize(
    "event", [HostReady(0), EpochDone(0, 7), HostFinished(0), PartSaved(0, 0), Rewound(2, 1), Begun()]
)
def test_answers_out_of_place_change_nothing(event) -> None:
    state = running()
    assert decide(state, event) == (state, ())


def test_an_answer_given_twice_counts_once() -> None:
    state, _ = play(running(2), EpochDone(0, 0))
    assert decide(state, EpochDone(0, 0)) == (state, ())


def test_nothing_follows_the_conclusion() -> None:
    state, _ = play(Archipelago(1, 3), Begun(), StopAsked())
    for event in (EpochDone(0, 0), HostFailed(0, "again", alive=False), StopAsked(), HostFinished(0)):
        assert decide(state, event) == (state, ())
