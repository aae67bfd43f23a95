"""Random streams: named by island, purpose and epoch, never shared between purposes."""

from __future__ import annotations

import itertools

import pytest
from archipelagos import island, ring

import islands.island
from islands.migration.channel import Channel
from islands.streams import Purpose, stream


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

    monkeypatch.setattr(islands.island, "stream", recorded)
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
        assert purposes >= {Purpose.SELECTION, Purpose.VARIATION, Purpose.EMIGRANTS, Purpose.REPLACEMENT}
