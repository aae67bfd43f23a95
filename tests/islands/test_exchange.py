"""What holds for islands under any settings of their channels."""

from __future__ import annotations

import copy
import itertools
from types import SimpleNamespace

from archipelagos import edge, island, without_clock
from hypothesis import given, settings
from hypothesis import strategies as st
from species import FriendKind, Inverted

from islands.individual import home_of
from islands.migration.channel import Channel, Pairing, Trigger
from islands.migration.emigrants import CHOOSERS
from islands.migration.replacement import REPLACERS
from islands.settings import Algorithm

ISLANDS, DEME = 3, 5

amounts = st.one_of(
    st.builds(lambda count: {"count": count}, st.integers(1, DEME)),
    st.builds(lambda rate: {"rate": rate}, st.sampled_from([0.1, 0.5, 1.0])),
)
triggers = st.none() | st.builds(Trigger, stagnation=st.integers(1, 3)) | st.builds(Trigger, diversity=st.floats(0, 1))
pairings = st.builds(
    Pairing,
    scheme=st.sampled_from(["best", "random", "several", "archive"]),
    count=st.integers(1, 3),
    score=st.sampled_from(["mean", "best", "worst"]),
    archive=st.integers(0, 3),
)


@st.composite
def channels(draw: st.DrawFn) -> list:
    """Draw the edges of one or two channels between a few islands."""
    edges = []
    for number in range(draw(st.integers(1, 2))):
        kind = draw(st.sampled_from(["migrants", "migrants", "migrants", "partners"]))
        channel = Channel(
            number,
            f"c{number}",
            kind,
            every=draw(st.integers(1, 2)),
            select=draw(st.sampled_from(sorted(CHOOSERS))),
            replace=draw(st.sampled_from(sorted(REPLACERS))),
            tournament=draw(st.integers(1, 3)),
            accept=draw(st.sampled_from(["always", "better"])),
            move=kind == "migrants" and draw(st.booleans()),
            routing=draw(st.sampled_from(["broadcast", "point"])),
            trigger=draw(triggers),
            pairing=draw(pairings) if kind == "partners" else None,
            **draw(amounts),
        )
        weight, adapter = draw(st.sampled_from([1.0, 0.6])), draw(st.sampled_from(["", "inverted"]))
        pairs = draw(st.sets(st.sampled_from(list(itertools.permutations(range(ISLANDS), 2))), min_size=1))
        adapter = adapter if kind == "migrants" else ""
        edges += [edge(channel, a, b, weight=weight, adapter=adapter) for a, b in sorted(pairs)]
    return edges


algorithms = st.sampled_from(
    [
        Algorithm(elite=1),
        Algorithm(elite=2, elitism="restore"),
        Algorithm(name="plus"),
        Algorithm(name="plus", offspring=2),
    ]
)


def archipelago(edges, algorithm) -> list:
    translate = Inverted().build(None, None)
    return [
        island(
            number,
            tuple(edges),
            kind=FriendKind,
            population=DEME,
            algorithm=algorithm,
            adapters={("inverted", source): translate for source in range(ISLANDS)},
            genome={"length": 6, "rate": 0.1},
            growth={"fail_ending": "11", "invert": number == 2},
        )
        for number in range(ISLANDS)
    ]


@settings(max_examples=60, deadline=None)
@given(channels(), algorithms, st.randoms(use_true_random=False))
def test_any_channels_keep_their_word(edges, algorithm, shuffler) -> None:
    isles = archipelago(edges, algorithm)
    steps = [isle.begin() for isle in isles]
    born = {row.id for step in steps for row in step.records.born}
    for epoch in range(1, 5):
        packets = [packet for step in steps for packet in step.departures]
        # One packet an edge and epoch.
        assert sorted((p.channel, p.source, p.target) for p in packets) == sorted(
            (e.channel.number, e.source, e.target) for e in edges
        )
        assert {packet.epoch for packet in packets} <= {epoch - 1}
        before = copy.deepcopy([(step.state, step.departures) for step in steps])
        after = []
        for isle, step in zip(isles, steps, strict=True):
            arrivals = [packet for packet in packets if packet.target == isle.spec.number]
            shuffled = list(arrivals)
            shuffler.shuffle(shuffled)
            there = isle.advance(step.state, 2, arrivals)
            again = archipelago(edges, algorithm)[isle.spec.number].advance(step.state, 2, shuffled)
            assert there.state == again.state
            assert there.departures == again.departures
            assert without_clock(there.records) == without_clock(again.records)
            check(SimpleNamespace(isle=isle, before=step, after=there, arrivals=arrivals, edges=edges))
            after.append(there)
        assert [(step.state, step.departures) for step in steps] == before
        newborn = [row.id for step in after for row in step.records.born]
        assert len(set(newborn)) == len(newborn)
        assert not born & set(newborn)
        born |= set(newborn)
        assert {one.id for step in after for one in step.state.deme} <= born
        steps = after


def check(one: SimpleNamespace) -> None:
    state, records = one.after.state, one.after.records
    # Sent is accepted and rejected, channel by channel, in the order of the packets.
    arrived = sorted(one.arrivals, key=lambda packet: (packet.channel, packet.source))
    for kind in ("migrants", "partners"):
        numbers = {e.channel.number for e in one.edges if e.channel.kind == kind}
        sent = [(f"c{p.channel}", m.id) for p in arrived if p.channel in numbers for m in p.migrants]
        assert [(row.channel, row.id) for row in records.crossings if row.kind == kind] == sent
    assert all(row.accepted == (row.reason == "") for row in records.crossings)
    # Ids are unique in a deme, and its size is the population less those who moved.
    ids = [member.id for member in state.deme]
    moved = {
        m.id for p in one.after.departures for m in p.migrants if channel_of(one.edges, p.channel).move
    }  # fmt: skip
    assert len(ids) == len(set(ids))
    assert len(ids) + len(moved) == DEME
    assert not moved & set(ids)
    assert state.counter - one.before.state.counter == len(records.born)
    assert all(home_of(row.id) == one.isle.spec.number for row in records.born)
    # Every scoring is a row, and counted once.
    assert sum(row.evaluations for row in records.generations) == len(records.born) + len(records.rescored)
    for packet in one.after.departures:
        channel = channel_of(one.edges, packet.channel)
        assert len({m.id for m in packet.migrants}) == len(packet.migrants)
        if packet.migrants:
            assert channel.carries(packet.epoch)
            assert len(packet.migrants) == channel.size(DEME) or any(e.channel.move for e in one.edges)
        keys = [(m.fitness is None, -(m.fitness or 0), m.id) for m in packet.migrants]
        assert keys == sorted(keys)
    assert all(len(row.parents) == 1 for row in records.born if row.origin == "adaptation")


def channel_of(edges, number: int) -> Channel:
    return next(e.channel for e in edges if e.channel.number == number)
