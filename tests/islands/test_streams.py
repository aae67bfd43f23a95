"""Random streams: named by island, purpose and epoch, never shared between purposes."""

from __future__ import annotations

import itertools

import pytest
from archipelagos import island, ring

import islands.streams
from islands.migration.channel import Channel
from islands.settings import Algorithm
from islands.streams import EpochStreams, Purpose, stream


def test_every_key_has_a_stream_of_its_own() -> None:
    keys = list(itertools.product((0, 1), (0, 1, 2), Purpose, (0, 1, 2)))
    draws = {tuple(stream(seed, isle, purpose, epoch).integers(0, 2**62, 4)) for seed, isle, purpose, epoch in keys}
    assert len(draws) == len(keys)
    assert len({tuple(stream(0, 0, Purpose.EMIGRANTS, 1, *extra).random(2)) for extra in ((), (0,), (1,), (0, 1))}) == 4


def test_a_key_s_stream_never_changes() -> None:
    """The figures are a part of every run's history."""
    assert stream(7, 3, Purpose.VARIATION, 12).integers(0, 1000, 5).tolist() == [482, 452, 821, 539, 355]
    assert [int(purpose) for purpose in Purpose] == list(range(9))


@pytest.mark.parametrize("epoch", [0, 1, 2])
def test_no_stream_is_drawn_from_for_two_purposes(monkeypatch, epoch) -> None:
    asked: list[tuple] = []

    def recorded(*key):
        asked.append(key)
        return stream(*key)

    monkeypatch.setattr(islands.streams, "stream", recorded)
    isles = [island(n, ring(2, Channel(0, "a", count=2, select="random", replace="random"))) for n in (0, 1)]
    steps = [isle.begin() for isle in isles]
    for _ in range(epoch):
        asked.clear()
        sent = [packet for step in steps for packet in step.departures]
        steps = [
            isle.advance(step.state, 3, [packet for packet in sent if packet.target == isle.spec.number])
            for isle, step in zip(isles, steps, strict=True)
        ]
    assert len(set(asked)) == len(asked)
    purposes = {key[2] for key in asked}
    if epoch == 0:
        assert purposes == {Purpose.INITIAL}
    else:
        expected = {Purpose.SELECTION, Purpose.VARIATION, Purpose.EMIGRANTS}
        # Nobody arrives in epoch 1: migrants do not travel at the end of epoch 0.
        assert purposes == (expected if epoch == 1 else {*expected, Purpose.REPLACEMENT})


def test_a_deme_of_one_that_sends_its_best_draws_variation_alone(monkeypatch) -> None:
    asked: list[tuple] = []
    monkeypatch.setattr(islands.streams, "stream", lambda *key: asked.append(key) or stream(*key))
    edges = ring(2, Channel(0, "a", accept="better"))
    isles = [island(n, edges, population=1, algorithm=Algorithm(name="plus", crossover=0)) for n in (0, 1)]
    steps = [isle.begin() for isle in isles]
    asked.clear()
    for isle, step, other in zip(isles, steps, steps[::-1], strict=True):
        isle.advance(isle.advance(step.state, 3, other.departures).state, 3, ())
    assert [key[2] for key in asked] == [Purpose.VARIATION] * 4


def test_epoch_streams_go_on_where_their_draws_have_come_to() -> None:
    streams, plain = EpochStreams(7, 3, 12), stream(7, 3, Purpose.ROUTING, 12, 4)
    drawn = [streams(Purpose.ROUTING, 4).random() for _ in range(3)]
    assert drawn == plain.random(3).tolist()
    assert streams(Purpose.ROUTING, 5) is not streams(Purpose.ROUTING, 4)
