"""The agenda: who may step next, whatever the order in which packets come."""

from __future__ import annotations

import random

import pytest
from archipelagos import ring

from islands.agenda import REMEMBERED, Agenda, Complete, Present, Recorded, ranks
from islands.migration.channel import Channel, Packet
from islands.migration.routes import Redrawn, Routes

CHANNEL = Channel(0, "c")


def packet(source: int, target: int, epoch: int, channel: int = 0) -> Packet:
    return Packet(channel, source, target, epoch, "")


def mark(found: Packet) -> tuple[int, int, int]:
    return (found.channel, found.source, found.epoch)


def stepped(agenda: Agenda, horizon: int = 99) -> tuple[int, int, list[tuple[int, int, int]]] | None:
    turn = agenda.next(horizon)
    if turn is None:
        return None
    taken = [mark(found) for found in agenda.take(turn[0])]
    agenda.done(turn[0])
    return (*turn, taken)


def test_islands_step_in_the_order_of_epochs_then_numbers_once_all_is_in() -> None:
    agenda = Agenda([1, 0], Complete(Routes(ring(2, CHANNEL))))
    assert agenda.floor == -1
    assert [stepped(agenda), agenda.floor, stepped(agenda), agenda.floor] == [(0, 0, []), -1, (1, 0, []), 0]
    assert stepped(agenda) is None
    assert agenda.awaited() == (0, 1, ((0, 1, 0),))
    agenda.put(packet(0, 1, 0))
    agenda.put(packet(1, 0, 0))
    assert [stepped(agenda), stepped(agenda)] == [(0, 1, [(0, 1, 0)]), (1, 1, [(0, 0, 0)])]
    assert agenda.floor == 1
    assert agenda.awaited() == (0, 2, ((0, 1, 1),))


def test_none_goes_beyond_the_horizon() -> None:
    agenda = Agenda([0, 1], Complete(Routes(())))
    assert [stepped(agenda, 1) for _ in range(5)] == [(0, 0, []), (1, 0, []), (0, 1, []), (1, 1, []), None]
    assert agenda.next(2) == (0, 2)


def test_packets_of_epochs_to_come_wait_for_their_turn() -> None:
    agenda = Agenda([1], Complete(Routes(ring(2, CHANNEL))))
    for epoch in (2, 0, 1):
        assert agenda.put(packet(0, 1, epoch))
    assert [stepped(agenda) for _ in range(5)] == [
        (1, 0, []), (1, 1, [(0, 0, 0)]), (1, 2, [(0, 0, 1)]), (1, 3, [(0, 0, 2)]), None,
    ]  # fmt: skip


@pytest.mark.parametrize("rule", [Complete(Routes(ring(2, CHANNEL))), Present(), Recorded({(1, 1): [(0, 0, 0)]})])
def test_a_packet_counts_once(rule) -> None:
    agenda = Agenda([1], rule)
    assert [agenda.put(packet(0, 1, 0)), agenda.put(packet(0, 1, 0))] == [True, False]
    assert [stepped(agenda), stepped(agenda)] == [(1, 0, []), (1, 1, [(0, 0, 0)])]
    assert not agenda.put(packet(0, 1, 0))
    assert agenda.put(packet(0, 1, 1))


def test_present_takes_what_is_in_but_nothing_of_islands_ahead() -> None:
    agenda = Agenda([1], Present())
    stepped(agenda)
    for source, epoch, channel in ((2, 1, 0), (0, 0, 1), (2, 0, 0), (0, 3, 0)):
        agenda.put(packet(source, 1, epoch, channel))
    assert stepped(agenda) == (1, 1, [(0, 2, 0), (1, 0, 0)])
    agenda.put(packet(5, 1, 0))  # late, and still taken
    assert stepped(agenda) == (1, 2, [(0, 2, 1), (0, 5, 0)])
    assert stepped(agenda) == (1, 3, [])
    assert stepped(agenda) == (1, 4, [(0, 0, 3)])


def test_what_came_long_ago_is_forgotten_and_refused() -> None:
    agenda = Agenda([1], Present())
    for _ in range(2 * REMEMBERED):
        epoch = agenda.next(10**6)[1]
        if epoch:
            agenda.put(packet(0, 1, epoch - 1))
        stepped(agenda, 10**6)
    assert len(agenda._places[1].had) <= REMEMBERED + 1
    assert not agenda.put(packet(7, 1, 3))
    assert agenda.put(packet(7, 1, 2 * REMEMBERED - 9))


def test_recorded_waits_for_just_what_the_record_says() -> None:
    agenda = Agenda([1], Recorded({(1, 2): [(0, 0, 0), (0, 2, 1)]}))
    for source, epoch in ((0, 0), (0, 1)):
        agenda.put(packet(source, 1, epoch))
    assert [stepped(agenda), stepped(agenda), stepped(agenda)] == [(1, 0, []), (1, 1, []), None]
    agenda.put(packet(2, 1, 1))
    assert [stepped(agenda), stepped(agenda)] == [(1, 2, [(0, 0, 0), (0, 2, 1)]), (1, 3, [])]


def test_one_that_was_not_next_cannot_be_done() -> None:
    agenda = Agenda([0, 1], Present())
    with pytest.raises(RuntimeError, match="island 1 stepped through epoch 0, island 0 was next"):
        agenda.done(1)


@pytest.mark.parametrize("seed", range(20))
def test_whatever_the_order_of_packets_every_epoch_takes_the_same(seed) -> None:
    rng = random.Random(seed)
    members = tuple((number, f"isle-{number}") for number in range(6))
    routes = Routes(ring(6, CHANNEL), (Redrawn(Channel(1, "drawn"), members, 2),), seed)
    halves = [Agenda(range(3), Complete(routes)), Agenda(range(3, 6), Complete(routes))]
    on_the_way: list[Packet] = []
    taken = {}
    while min(half.floor for half in halves) < 8:
        half = rng.choice(halves)
        turn = half.next(8)
        if turn is not None and rng.random() < 0.7:
            island, epoch = turn
            taken[turn] = [mark(found) for found in half.take(island)]
            half.done(island)
            edges = routes.outgoing(island, epoch)
            on_the_way.extend(packet(island, edge.target, epoch, edge.channel.number) for edge in edges)
        rng.shuffle(on_the_way)
        for _ in range(rng.randint(0, len(on_the_way))):
            come = on_the_way.pop()
            assert halves[come.target // 3].put(come)
            if rng.random() < 0.2:
                assert not halves[come.target // 3].put(come)
    for (island, epoch), marks in taken.items():
        edges = routes.incoming(island, epoch - 1) if epoch else ()
        assert marks == [(edge.channel.number, edge.source, epoch - 1) for edge in edges]
    assert len(taken) == 6 * 9


def test_islands_that_other_hosts_wait_for_go_ahead_of_those_behind_them() -> None:
    edges = ring(8, CHANNEL)
    assert ranks([0, 0, 0, 0, 1, 1, 1, 1], 0, edges) == {0: 3, 1: 2, 2: 1, 3: 0}
    assert ranks([0] * 8, 0, edges) == dict.fromkeys(range(8), 0)
    assert ranks([0, 0, 1, 1], 0, (*ring(2, CHANNEL), *edges[1:2])) == {0: 1, 1: 0}
    agenda = Agenda(range(2), Complete(Routes(())), {0: 2})
    order = [stepped(agenda, 3)[:2] for _ in range(8)]
    assert order == [(1, 0), (1, 1), (0, 0), (1, 2), (0, 1), (1, 3), (0, 2), (0, 3)]
    assert agenda.next(3) is None
    assert (agenda.next(4), agenda.floor) == ((1, 4), 3)
