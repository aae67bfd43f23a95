"""Edges that begin and end while a run goes on."""

from __future__ import annotations

from dataclasses import replace

import pytest
from archipelagos import LENGTH, edge, island, spec

from islands.agenda import Complete
from islands.holdings import NOTHING
from islands.individual import make_id
from islands.island import Island
from islands.kinds.bits import BitsKind
from islands.migration.channel import Channel, Migrant, Packet
from islands.migration.routes import Redrawn, Routes

OLD, NEW = Channel(0, "old"), Channel(1, "new")


def test_an_edge_is_there_from_its_first_epoch_to_before_its_last() -> None:
    stays, comes, goes = edge(OLD, 0, 1), edge(NEW, 0, 1, since=3, until=6), edge(OLD, 2, 1, until=4)
    routes = Routes((stays, goes, comes))
    assert [len(routes.incoming(1, epoch)) for epoch in range(8)] == [2, 2, 2, 3, 2, 2, 1, 1]
    assert [len(routes.outgoing(0, epoch)) for epoch in range(8)] == [1, 1, 1, 2, 2, 2, 1, 1]
    assert routes.incoming(1, 3) == (stays, goes, comes)
    assert routes.incoming(1, 4) is routes.incoming(1, 5), "looked up for every packet"
    assert routes.channels_into(1) == (OLD, NEW)


def test_nobody_waits_for_what_was_sent_before_an_edge_began_or_after_it_ended() -> None:
    rule = Complete(Routes((edge(NEW, 0, 1, since=3, until=5),)))
    assert [list(rule.needed(1, epoch)) for epoch in range(1, 8)] == [[], [], [], [(1, 0, 3)], [(1, 0, 4)], [], []]


def test_edges_drawn_anew_begin_and_end_and_their_members_change() -> None:
    first = Redrawn(OLD, ((0, "a"), (1, "b"), (2, "c")), until=4)
    then = replace(first, members=first.members[:2], since=4, until=6)
    routes, always = Routes((), (first, then), 9), Routes((), (replace(first, until=None),), 9)
    for epoch in range(8):
        found = [link for number in range(3) for link in routes.outgoing(number, epoch)]
        if epoch < 4:
            assert found == [link for number in range(3) for link in always.outgoing(number, epoch)]
        else:
            assert [(link.source, link.target) for link in found] == ([(0, 1), (1, 0)] if epoch < 6 else [])


def test_what_is_held_lives_for_the_epochs_in_which_its_edge_leads_here() -> None:
    last = edge(OLD, 2, 1, until=2)
    assert Routes((edge(OLD, 0, 1), last)).live(1, 1) == {(0, 0), (0, 2)}
    assert Routes((edge(OLD, 0, 1), last)).live(1, 2) == {(0, 0)}
    assert Routes((edge(OLD, 0, 1), last)).live(0, 2) is None
    drawn = Redrawn(OLD, ((0, "a"), (1, "b"), (2, "c")), since=1)
    assert [Routes((), (drawn,)).live(1, epoch) for epoch in (0, 1)] == [frozenset(), {(0, 0), (0, 2)}]
    assert Routes((), (replace(drawn, since=0),)).live(1, 0) is None


@pytest.mark.parametrize("until", [None, 3])
def test_the_last_packet_of_an_edge_is_taken_in_and_partners_are_let_go_an_epoch_later(until) -> None:
    shows = Channel(0, "shown", "partners")
    goals = {"agreement": {"goal": "maximise"}}
    made = spec(1, kind="bits", genome={"length": LENGTH}, fitness=goals)
    biology = BitsKind().build(made, lambda: 0.0)
    isle = Island(made, biology, 5, Routes((edge(shows, 0, 1, until=until),)), lambda: 0.0, lambda: None)
    state = isle.begin().state
    reasons = []
    for epoch in range(1, 6):
        sent = epoch - 1
        one = Migrant(make_id(0, sent), f"{sent:0{LENGTH}b}", 0.0, (), "")
        came = [Packet(0, 0, 1, sent, "", (one,))] if until is None or sent < until else []
        step = isle.advance(state, 1, came)
        state = step.state
        reasons.append({row.reason for row in step.records.rescored})
        partners = {row.partners for row in step.records.born}
        assert partners == {(one.id,)} if came else partners == {()}
    if until is None:
        assert reasons == [{"partners"}] * 5
    else:
        assert reasons == [{"partners"}] * 4 + [set()]
        assert state.held is NOTHING
        assert state.scoring == biology.scoring


def test_a_channel_of_partners_that_is_yet_to_begin_changes_nothing() -> None:
    """An island that was made with the edges of later epochs steps as one that was made before they were known."""
    shown, later = Channel(0, "shown", "partners"), Channel(1, "later", "partners")
    made = spec(1, kind="bits", genome={"length": LENGTH}, fitness={"agreement": {"goal": "maximise"}})
    biology = BitsKind().build(made, lambda: 0.0)
    one = Migrant(make_id(0, 0), "1" * LENGTH, 0.0, (), "")
    found = []
    for more in ((), (edge(later, 2, 1, since=2),)):
        isle = Island(made, biology, 5, Routes((edge(shown, 0, 1), *more)), lambda: 0.0, lambda: None)
        step = isle.advance(isle.begin().state, 2, [Packet(0, 0, 1, 0, "", (one,))])
        found.append((step.state, step.departures, step.records))
    assert found[0] == found[1]
    assert {row.partners for row in found[0][2].born} == {(one.id,)}


def test_an_island_sends_on_the_edges_that_are_there_then() -> None:
    isle = island(0, (edge(OLD, 0, 1, until=2), edge(NEW, 0, 2, since=2)))
    step = isle.begin()
    sent = []
    for _ in range(4):
        sent.append([(packet.channel, packet.epoch) for packet in step.departures])
        step = isle.advance(step.state, 1, ())
    assert sent == [[(0, 0)], [(0, 1)], [(1, 2)], [(1, 3)]]
