"""Channels' settings on an island: which edges carry, who moves, what parts and surroundings do, and what is held."""

from __future__ import annotations

import dataclasses
import json
from collections import Counter

import pytest
from archipelagos import LENGTH, edge, island, without_clock
from scipy import stats
from species import BodyKind, HouseKind, SkinKind

from islands.holdings import Held
from islands.individual import Evaluation, Individual, home_of, make_id
from islands.migration.channel import Channel, Migrant, Packet, Trigger
from islands.migration.departures import Departures, Standing, bundled
from islands.migration.routes import Redrawn
from islands.migration.triggers import pulled
from islands.selection import ranked
from islands.settings import Algorithm
from islands.streams import EpochStreams

STILL = {"genome": {"length": LENGTH, "rate": 0.0}}


def deme(size: int) -> list[Individual]:
    return [Individual(n, (n,), float(-n), (), "") for n in range(size)]


def departures(members, edges, epoch: int = 1, **standing) -> tuple[Departures, tuple[Packet, ...]]:
    isle = island()
    settings = {"epoch": epoch, "stagnant": 0, "diversity": 0.5, "scoring": "s", **standing}
    leaving = Departures(members, isle.biology, Standing(**settings), EpochStreams(8, 0, epoch))
    return leaving, leaving.packets(bundled(edges))


def sent(packets) -> list[list[int]]:
    return [[one.id for one in packet.migrants] for packet in packets]


def fan(channel: Channel, count: int, **changes) -> list:
    return [edge(channel, 0, target, **changes) for target in range(1, count + 1)]


def migrant(identity: int, ones: int = 1, text: str | None = None) -> Migrant:
    return Migrant(identity, text or json.dumps([1] * ones + [0] * (LENGTH - ones)), float(ones), (), "")


# -- what leaves ---------------------------------------------------------------------------------------------------


def test_a_broadcast_of_copies_sends_the_same_to_each_edge_and_writes_them_down_once(monkeypatch) -> None:
    isle, written = island(), []
    monkeypatch.setattr(isle.biology, "encode", lambda genotype: written.append(genotype) or str(genotype))
    edges = [*fan(Channel(0, "a", count=2, select="random"), 4), *fan(Channel(1, "b", count=6), 2)]
    leaving = Departures(deme(6), isle.biology, Standing(1, 0, None, "s"), EpochStreams(8, 0, 1))
    packets = leaving.packets(bundled(edges))
    assert [(p.channel, p.source, p.target, p.epoch, p.scoring) for p in packets] == [
        (e.channel.number, 0, e.target, 1, "s") for e in edges
    ]
    ids = sent(packets)
    assert ids[0] == ids[1] == ids[2] == ids[3]
    assert ids[4] == ids[5] == list(range(6))
    assert len(written) == len(set(written)) == 6
    assert leaving.gone == set()


def test_the_weight_is_the_probability_that_an_edge_carries() -> None:
    channel = Channel(0, "a")
    edges = [edge(channel, 0, 1, weight=0.2), edge(channel, 0, 2), edge(channel, 0, 3, weight=0.7)]
    found = Counter(tuple(bool(ids) for ids in sent(departures(deme(3), edges, epoch)[1])) for epoch in range(1, 2001))
    expected = {(a, True, b): (0.2 if a else 0.8) * (0.7 if b else 0.3) for a in (0, 1) for b in (0, 1)}
    keys = list(expected)
    assert sum(found.values()) == sum(found[key] for key in keys)
    assert stats.chisquare([found[key] for key in keys], [2000 * expected[key] for key in keys]).pvalue > 1e-3
    nothing = departures(deme(3), fan(channel, 3, weight=0.0))[1]
    assert sent(nothing) == [[], [], []]


def test_point_to_point_one_edge_of_a_channel_carries_each_as_likely_and_by_its_weight() -> None:
    edges = [*fan(Channel(0, "a", routing="point"), 3), *fan(Channel(1, "b"), 1)]
    found = Counter()
    for epoch in range(1, 1501):
        ids = sent(departures(deme(3), edges, epoch)[1])
        assert ids[3] == [0]
        assert sum(map(bool, ids[:3])) == 1
        found[[bool(one) for one in ids].index(True)] += 1
    assert stats.chisquare([found[n] for n in range(3)]).pvalue > 1e-3
    edges = fan(Channel(0, "a", routing="point"), 2, weight=0.25)
    carried = sum(any(sent(departures(deme(3), edges, epoch)[1])) for epoch in range(1, 1501))
    assert stats.binomtest(carried, 1500, 0.25).pvalue > 1e-3
    assert sent(departures(deme(3), fan(Channel(0, "a", routing="point"), 1))[1]) == [[0]]


def test_those_who_move_are_others_for_each_edge_and_have_left_for_later_channels() -> None:
    edges = [*fan(Channel(0, "a", count=2, move=True), 2), *fan(Channel(1, "b"), 2)]
    leaving, packets = departures(deme(7), edges)
    assert sent(packets) == [[0, 1], [2, 3], [4], [4]]
    assert leaving.gone == {0, 1, 2, 3}
    leaving, packets = departures(deme(3), edges)
    assert sent(packets) == [[0, 1], [2], [], []]
    leaving, packets = departures(deme(8), fan(Channel(0, "a", rate=0.25, move=True, select="random"), 4))
    ids = [identity for ids in sent(packets) for identity in ids]
    assert sorted(ids) == list(range(8))
    assert [len(ids) for ids in sent(packets)] == [2] * 4


def test_a_rate_counts_the_deme_and_a_count_beyond_it_sends_all() -> None:
    assert sent(departures(deme(10), fan(Channel(0, "a", rate=0.3), 1))[1]) == [[0, 1, 2]]
    assert sent(departures(deme(4), fan(Channel(0, "a", count=9), 1))[1]) == [[0, 1, 2, 3]]


@pytest.mark.parametrize(
    ("trigger", "stagnant", "diversity", "holds"),
    [
        (None, 0, None, True),
        (Trigger(stagnation=3), 2, 0.5, False),
        (Trigger(stagnation=3), 3, 0.5, True),
        (Trigger(diversity=0.2), 0, 0.2, False),
        (Trigger(diversity=0.2), 0, 0.19, True),
        (Trigger(diversity=0.2), 0, None, False),
    ],
)
def test_triggers(trigger, stagnant, diversity, holds) -> None:
    assert pulled(trigger, stagnant, diversity) is holds
    channel = Channel(0, "a", trigger=trigger)
    packets = departures(deme(3), fan(channel, 2), stagnant=stagnant, diversity=diversity)[1]
    assert sent(packets) == ([[0], [0]] if holds else [[], []])
    assert sent(departures(deme(3), fan(channel, 1), 3, stagnant=9, diversity=0.0)[1]) == [[0]]


def test_triggers_ask_an_island_s_own_figures() -> None:
    edges = (
        *fan(Channel(0, "a", trigger=Trigger(stagnation=3)), 1),
        *fan(Channel(1, "b", trigger=Trigger(diversity=0.3)), 1),
    )
    isle = island(0, edges)
    step, seen = isle.begin(), set()
    for _ in range(25):
        step = isle.advance(step.state, 2, ())
        row = step.records.generations[-1]
        full = tuple(bool(packet.migrants) for packet in step.departures)
        assert full == (step.state.stagnant >= 3, row.diversity < 0.3)
        seen.add(full)
    assert len(seen) > 2


# -- moving --------------------------------------------------------------------------------------------------------


def test_who_moves_leaves_the_deme_after_its_last_row_and_a_free_place_is_taken_first() -> None:
    channel = Channel(0, "a", count=3, move=True, accept="better")
    isle = island(1, (edge(channel, 1, 2), edge(channel, 0, 1)))
    begun = isle.begin()
    step = isle.advance(begun.state, 1, ())
    moved = [one.id for one in step.departures[0].migrants]
    assert len(moved) == 3
    assert step.records.generations[-1].best == step.departures[0].migrants[0].fitness
    assert len(step.state.deme) == 9
    assert not set(moved) & {one.id for one in step.state.deme}
    worse = [migrant(70 + n, 0) for n in range(4)]
    after = isle.advance(step.state, 1, [Packet(0, 0, 1, 1, isle.biology.scoring, tuple(worse))])
    assert [row.reason for row in after.records.crossings] == ["", "", "", "not better"]
    assert [row.evaluations for row in after.records.generations] == [10]
    refilled = isle.advance(step.state, 1, ())
    assert [row.evaluations for row in refilled.records.generations] == [10]
    assert len(refilled.state.deme) == 9  # 12, of whom 3 moved again
    smaller = island(1, algorithm=Algorithm(elite=12), population=12)
    grown = smaller.advance(dataclasses.replace(step.state), 1, ())
    assert [row.evaluations for row in grown.records.generations] == [3]


@pytest.mark.parametrize("algorithm", [Algorithm(elite=2), Algorithm(elitism="restore"), Algorithm(name="plus")])
def test_a_deme_that_everyone_left_is_settled_anew_or_by_those_who_come(algorithm) -> None:
    channel = Channel(0, "a", rate=1.0, move=True)
    isle = island(1, (edge(channel, 1, 2), edge(channel, 0, 1)), algorithm=algorithm)
    step = isle.advance(isle.begin().state, 1, ())
    assert (step.state.deme, len(step.departures[0].migrants)) == ((), 12)
    anew = isle.advance(step.state, 2, ())
    assert Counter(row.origin for row in anew.records.born if row.generation == 2) == {"random": 12}
    assert len(anew.departures[0].migrants) == 12
    came = isle.advance(step.state, 1, [Packet(0, 0, 1, 1, isle.biology.scoring, tuple(map(migrant, range(70, 82))))])
    assert [row.reason for row in came.records.crossings] == [""] * 12
    assert not any(row.origin == "random" for row in came.records.born)


def test_since_tells_how_long_a_member_has_been_here() -> None:
    isle = island(1, (edge(Channel(0, "a"), 0, 1),), population=6, algorithm=Algorithm(elite=3))
    step = isle.advance(isle.begin().state, 4, ())
    step = isle.advance(step.state, 1, [Packet(0, 0, 1, 1, isle.biology.scoring, (migrant(5, LENGTH),))])
    born = {row.id: row.generation for row in step.records.born}
    for one in step.state.deme:
        if home_of(one.id) == 0:
            assert one.since == 4
        elif one.id in born:
            assert one.since == born[one.id] == 5


# -- components ----------------------------------------------------------------------------------------------------


def rooms(keep: int = 4) -> Channel:
    return Channel(0, "rooms", "components", count=3, keep=keep)


def test_parts_are_held_newest_first_and_houses_are_built_of_these_alone() -> None:
    isle = island(1, (edge(rooms(), 0, 1), edge(rooms(), 2, 1)), kind=HouseKind, algorithm=Algorithm(mutation=1.0))
    begun = isle.begin()
    assert {row.error for row in begun.records.born} == {"growth: no parts"}
    first = [
        Packet(0, 2, 1, 0, "x", (migrant(90, 9),)),
        Packet(0, 0, 1, 0, "x", (migrant(70, 3), migrant(71, 2), migrant(72, 1))),
    ]
    step = isle.advance(begun.state, 2, first)
    assert step.records.rescored == ()
    assert {identity for row in step.records.born for identity in row.components} == {70, 71, 72, 90}
    assert all(row.components == tuple(one for one, _ in json.loads(row.genotype)) for row in step.records.born)
    assert step.state.held.components == (
        Held(0, 0, first[1].migrants), Held(0, 2, first[0].migrants),
    )  # fmt: skip
    second = [Packet(0, 0, 1, 1, "x", (migrant(73, 5), migrant(71, 2), migrant(74, 4)))]
    after = isle.advance(step.state, 2, second)
    assert [one.id for one in after.state.held.components[0].travellers] == [73, 71, 74, 70]
    assert [(row.id, row.reason) for row in after.records.crossings] == [(73, ""), (71, "already here"), (74, "")]
    new = {identity for row in after.records.born for identity in row.components} - {72}
    assert new == {70, 71, 73, 74, 90}


def test_a_packet_beyond_what_is_kept_finds_no_place() -> None:
    isle = island(1, (edge(rooms(keep=2), 0, 1),), kind=HouseKind)
    step = isle.advance(isle.begin().state, 1, [Packet(0, 0, 1, 0, "x", (migrant(70), migrant(71), migrant(72)))])
    assert [(row.accepted, row.reason) for row in step.records.crossings] == [
        (True, ""), (True, ""), (False, "no place left"),
    ]  # fmt: skip


def test_what_a_kind_cannot_use_is_a_note_and_no_exception() -> None:
    for kind, channel in ((HouseKind, rooms()), (SkinKind, Channel(0, "skin", "surroundings"))):
        isle = island(1, (edge(channel, 0, 1),), kind=kind)
        step = isle.advance(isle.begin().state, 1, [Packet(0, 0, 1, 0, "x", (migrant(70, text="rubble"),))])
        assert [(note.kind, note.detail) for note in step.records.notes] == [
            ("holdings", {"detail": f"{channel.kind}: ValueError: rubble"})
        ]
        assert step.records.rescored == ()
        assert isle.advance(step.state, 1, ()).records.notes == ()


# -- surroundings --------------------------------------------------------------------------------------------------


def test_a_deme_is_scored_again_in_other_surroundings() -> None:
    channel = Channel(0, "skin", "surroundings")
    isle = island(1, (edge(channel, 0, 1), edge(channel, 2, 1)), kind=SkinKind)
    begun = isle.begin()
    came = [Packet(0, 0, 1, 0, "x", (migrant(70, text="surroundings:0110"),))]
    step = isle.advance(begun.state, 1, came)
    assert [row.id for row in step.records.rescored] == [one.id for one in begun.state.deme]
    assert {row.reason for row in step.records.rescored} == {"surroundings"}
    assert all(row.fitness == dict(row.scores)["ones"] - 2 for row in (*step.records.rescored, *step.records.born))
    assert [row.evaluations for row in step.records.generations] == [22]
    same = isle.advance(step.state, 1, [came[0]._replace(epoch=1)])
    assert same.records.rescored == ()
    assert [row.reason for row in same.records.crossings] == ["already here"]
    two = isle.advance(step.state, 1, [Packet(0, 2, 1, 1, "x", (migrant(71, text="surroundings:1"),))])
    assert len(two.records.rescored) == 12
    assert all(row.fitness == dict(row.scores)["ones"] - 3 for row in two.records.rescored)
    instead = isle.advance(step.state, 1, [Packet(0, 0, 1, 1, "x", (migrant(72, text="surroundings:111"),))])
    assert len(instead.records.rescored) == 12
    assert all(row.fitness == dict(row.scores)["ones"] - 3 for row in instead.records.rescored)
    assert {packet.scoring for packet in instead.departures} <= {instead.state.scoring}
    # The same from a fresh island: nothing hangs on what it remembers.
    fresh = island(1, (edge(channel, 0, 1), edge(channel, 2, 1)), kind=SkinKind)
    assert fresh.advance(step.state, 1, ()).state == isle.advance(step.state, 1, ()).state


def test_a_form_travels_where_a_kind_offers_one_and_none_where_it_has_none() -> None:
    edges = (
        edge(Channel(0, "a", "surroundings", count=12), 0, 1),
        edge(Channel(1, "b", count=12), 0, 1),
        edge(Channel(2, "c", "components", count=12), 0, 1),
    )
    isle = island(0, edges, kind=BodyKind, growth={"fail_ending": "1"})
    step = isle.begin()
    forms, migrants, parts = step.departures
    valid = [one for one in step.state.deme if one.fitness is not None]
    shown = [one for one in ranked(valid) if one.genotype[0] == 0]
    assert [one.text for one in forms.migrants] == ["surroundings:" + "".join(map(str, one.genotype)) for one in shown]
    assert [one.id for one in parts.migrants] == [one.id for one in shown]
    assert migrants.migrants == ()
    failed = [note.detail for note in step.records.notes if note.kind == "offer"]
    assert {detail["detail"] for detail in failed} == {
        "surroundings: ValueError: no form for surroundings", "components: ValueError: no form for components",
    }  # fmt: skip
    assert len(failed) == 2 * (len(valid) - len(shown)) > 0
    sick = len(step.state.deme) - len(valid)
    assert sick > 0
    everyone = isle.advance(step.state, 1, ()).departures[1].migrants
    assert len(everyone) == 12
    assert all(json.loads(one.text) for one in everyone)


def test_partners_are_shown_even_while_all_are_invalid() -> None:
    isle = island(0, (edge(Channel(0, "a", "partners", count=2), 0, 1),))
    isle.biology.evaluate = lambda genotype: Evaluation(None, error="growth: nobody is there")
    assert [one.fitness for one in isle.begin().departures[0].migrants] == [None, None]


# -- several epochs of one edge ------------------------------------------------------------------------------------


def test_packets_of_several_epochs_of_one_edge_are_taken_in_by_channel_source_and_epoch() -> None:
    first, second = Channel(0, "a", replace="random"), Channel(1, "b", replace="random")
    edges = tuple(edge(channel, source, 1) for channel in (first, second) for source in (0, 2))
    isle = island(1, edges)
    state = isle.begin().state
    packets = [
        Packet(channel, source, 1, epoch, isle.biology.scoring, (migrant(make_id(source, 10 * epoch + channel), 20),))
        for channel in (0, 1)
        for source in (0, 2)
        for epoch in (1, 2, 5)
    ]
    ordered = isle.advance(state, 2, packets)
    shuffled = isle.advance(state, 2, packets[::-1])
    assert (ordered.state, ordered.departures) == (shuffled.state, shuffled.departures)
    assert without_clock(ordered.records) == without_clock(shuffled.records)
    assert [row.id for row in shuffled.records.crossings] == [packet.migrants[0].id for packet in packets]
    assert all(row.accepted for row in shuffled.records.crossings)
    # Who comes again in a later packet is already there.
    twice = [packets[0], packets[0]._replace(epoch=2)]
    assert [row.reason for row in isle.advance(state, 1, twice).records.crossings] == ["", "already in deme"]


def test_the_latest_of_several_packets_is_what_is_held() -> None:
    skin = Channel(0, "skin", "surroundings")
    isle = island(1, (edge(skin, 0, 1),), kind=SkinKind)
    packets = [Packet(0, 0, 1, epoch, "x", (migrant(70 + epoch, text="1" * epoch),)) for epoch in (3, 1, 2)]
    step = isle.advance(isle.begin().state, 1, packets)
    assert [one.id for one in step.state.held.surroundings[0].travellers] == [73]
    assert [row.id for row in step.records.crossings] == [71, 72, 73]
    house = island(1, (edge(rooms(), 0, 1),), kind=HouseKind)
    step = house.advance(house.begin().state, 1, packets)
    assert [one.id for one in step.state.held.components[0].travellers] == [73, 72, 71]


def test_migrants_travel_on_edges_that_are_drawn_anew() -> None:
    members = tuple((n, f"isle-{n}") for n in range(5))
    drawn = (Redrawn(Channel(0, "a", count=2), members, degree=2),)
    isles = [island(n, redrawn=drawn) for n in range(5)]
    steps, pairs = [isle.begin() for isle in isles], []
    for epoch in range(1, 6):
        packets = [packet for step in steps for packet in step.departures]
        steps = [
            isle.advance(step.state, 1, [packet for packet in packets if packet.target == isle.spec.number])
            for isle, step in zip(isles, steps, strict=True)
        ]
        ends = [(row.source, row.target) for step in steps for row in step.records.crossings]
        sent = sorted((f"isle-{p.source}", f"isle-{p.target}") for p in packets for _ in p.migrants)
        assert sorted(ends) == sent
        assert len(ends) == (0 if epoch == 1 else 20)
        pairs.append(sent)
    assert pairs[1] != pairs[2] != pairs[3]
    # Packets of several epochs came on different edges.
    late = [Packet(0, n, 1, epoch, "x", (migrant(70 + epoch),)) for epoch in range(9) for n in (0, 2, 3, 4)]
    routes = isles[1]._routes
    late = [p for p in late if any(e.source == p.source for e in routes.incoming(1, p.epoch))]
    rows = isles[1].advance(steps[1].state, 1, late).records.crossings
    assert [(row.source, row.id) for row in rows] == [
        (f"isle-{p.source}", p.migrants[0].id) for p in sorted(late, key=lambda p: (p.source, p.epoch))
    ]
    assert len({p.source for p in late}) > 2


def test_who_is_scored_again_has_been_here_as_long_as_before() -> None:
    isle = island(1, (edge(Channel(0, "skin", "surroundings"), 0, 1),), kind=SkinKind, algorithm=Algorithm(elite=11))
    state = isle.advance(isle.begin().state, 6, ()).state
    before = {one.id: one.since for one in state.deme}
    step = isle.advance(state, 1, [Packet(0, 0, 1, 1, "x", (migrant(70, text="surroundings:1"),))])
    assert len(step.records.rescored) == 12
    kept = {one.id: one.since for one in step.state.deme if one.id in before}
    assert len(kept) == 11
    assert kept == {identity: before[identity] for identity in kept}
    assert len(set(kept.values())) > 2
