"""Migration: who leaves, who joins, in whose place, and what the rows say."""

from __future__ import annotations

import json
from collections import Counter

import pytest
from archipelagos import LENGTH, island, ring

from islands.individual import Individual, make_id
from islands.migration.channel import Channel, Migrant, Packet
from islands.selection import ranked


def migrant(identity: int, ones: int, fitness: float | None = None) -> Migrant:
    genes = [1] * ones + [0] * (LENGTH - ones)
    value = float(ones) if fitness is None else fitness
    return Migrant(identity, json.dumps(genes), value, (("ones", float(ones)),), "")


def packet(isle, *migrants: Migrant, channel: int = 0, source: int = 0, scoring: str | None = None) -> Packet:
    return Packet(channel, source, 1, 0, isle.biology.scoring if scoring is None else scoring, migrants)


@pytest.fixture
def isle():
    return island(1, ring(3, Channel(0, "ring", count=2)))


def test_the_best_leave_at_an_epoch_s_end_as_copies(isle) -> None:
    begun = isle.begin()
    assert begun.departures == (Packet(0, 1, 2, 0, isle.biology.scoring, ()),)
    step = isle.advance(begun.state, 2, ())
    (sent,) = step.departures
    best = ranked(step.state.deme)[:2]
    assert [one.id for one in sent.migrants] == [member.id for member in best]
    assert [json.loads(one.text) for one in sent.migrants] == [list(member.genotype) for member in best]
    assert (sent.epoch, sent.source, sent.target) == (1, 1, 2)


@pytest.mark.parametrize(("every", "epochs"), [(1, {1, 2, 3, 4, 5, 6}), (2, {2, 4, 6}), (4, {4})])
def test_a_packet_is_sent_every_epoch_and_holds_migrants_every_nth(every, epochs) -> None:
    isle = island(1, ring(3, Channel(0, "ring", every=every, count=2)))
    step = isle.begin()
    full = set()
    for epoch in range(1, 7):
        step = isle.advance(step.state, 1, ())
        assert len(step.departures) == 1
        assert len(step.departures[0].migrants) in (0, 2)
        if step.departures[0].migrants:
            full.add(epoch)
    assert full == epochs


def test_immigrants_take_the_places_of_the_worst_and_keep_their_ids(isle) -> None:
    begun = isle.begin()
    arrived = isle.advance(begun.state, 1, [packet(isle, migrant(5, 24), migrant(6, 23))])
    assert [(row.id, row.accepted, row.reason) for row in arrived.records.crossings] == [(5, True, ""), (6, True, "")]
    assert {row.epoch for row in arrived.records.crossings} == {1}
    assert (arrived.records.crossings[0].source, arrived.records.crossings[0].target) == ("isle-0", "isle-1")
    assert [member.id for member in arrived.state.deme[:2]] == [5, 6]
    assert not {5, 6} & {row.id for row in arrived.records.born}
    lost = {member.id for member in ranked(begun.state.deme)[-2:]}
    parents = {parent for row in arrived.records.born for parent in row.parents}
    assert not lost & parents
    assert {5, 6} & parents


def test_k_sent_are_k_delivered_on_a_converged_deme_too(isle) -> None:
    from dataclasses import replace

    begun = isle.begin()
    same = tuple(Individual(make_id(1, n), (1,) * LENGTH, 24.0, (("ones", 24.0),), "") for n in range(12))
    state = replace(begun.state, deme=same)
    step = isle.advance(state, 1, [packet(isle, migrant(5, 24), migrant(6, 24))])
    assert [row.accepted for row in step.records.crossings] == [True, True]


def test_one_already_there_is_turned_away(isle) -> None:
    begun = isle.begin()
    step = isle.advance(begun.state, 1, [packet(isle, migrant(make_id(1, 3), 24))])
    assert [(row.accepted, row.reason) for row in step.records.crossings] == [(False, "already in deme")]
    twice = isle.advance(begun.state, 1, [packet(isle, migrant(5, 24), migrant(5, 24))])
    assert [row.reason for row in twice.records.crossings] == ["", "already in deme"]


def test_only_better_means_strictly_better_than_the_one_replaced() -> None:
    isle = island(1, ring(3, Channel(0, "ring", count=2, accept="better")))
    begun = isle.begin()
    worst = ranked(begun.state.deme)[-1].fitness
    step = isle.advance(begun.state, 1, [packet(isle, migrant(5, int(worst)), migrant(6, int(worst) + 1))])
    assert [row.reason for row in step.records.crossings] == ["not better", ""]
    sick = Migrant(8, json.dumps([0] * LENGTH), None, (), "growth: broken")
    assert isle.advance(begun.state, 1, [packet(isle, sick)]).records.crossings[0].reason == "not better"


def test_more_immigrants_than_places_find_none_left(isle) -> None:
    crowd = tuple(migrant(identity, 5) for identity in range(14))
    step = isle.advance(isle.begin().state, 1, [packet(isle, *crowd)])
    assert Counter(row.reason for row in step.records.crossings) == {"": 12, "no place left": 2}
    assert len(step.state.deme) == 12


def test_packets_join_in_the_order_of_channels_then_sources_whatever_order_they_came_in() -> None:
    first, second = Channel(0, "a", count=1, replace="random"), Channel(1, "b", count=1, replace="random")
    edges = (*ring(3, first), *ring(3, second))
    isle = island(1, edges)
    packets = [packet(isle, migrant(5, 24)), packet(isle, migrant(6, 24), channel=1)]
    begun = isle.begin()
    ahead, behind = isle.advance(begun.state, 2, packets), isle.advance(begun.state, 2, packets[::-1])
    assert ahead.state == behind.state
    assert [row.id for row in behind.records.crossings] == [5, 6]


def test_a_migrant_is_scored_again_where_the_scoring_differs_and_only_there(isle) -> None:
    begun = isle.begin()
    alike = isle.advance(begun.state, 1, [packet(isle, migrant(5, 24))])
    assert alike.records.rescored == ()
    assert [row.evaluations for row in alike.records.generations] == [10]
    step = isle.advance(begun.state, 1, [packet(isle, migrant(5, 24, fitness=-7.0), scoring="other")])
    (row,) = step.records.rescored
    assert (row.id, row.reason, row.fitness, row.epoch, row.generation) == (5, "migrant", 24.0, 1, 0)
    assert step.records.crossings[0].fitness == -7.0
    assert step.state.deme[0].id == 5
    assert step.state.deme[0].fitness == 24.0
    assert [row.evaluations for row in step.records.generations] == [11]


def test_one_whose_copy_just_gave_way_is_let_in_again(isle) -> None:
    begun = isle.begin()
    worst = ranked(begun.state.deme)[-1].id
    step = isle.advance(begun.state, 1, [packet(isle, migrant(5, 24), migrant(worst, 24), migrant(worst, 24))])
    assert [row.reason for row in step.records.crossings] == ["", "", "already in deme"]
