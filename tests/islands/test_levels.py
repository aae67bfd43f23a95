"""Islands of levels: they wait for parts, rest after their epochs, and begin anew from random populations."""

from __future__ import annotations

import numpy as np
import pytest
from archipelagos import edge, island
from houses import house_spec, zones
from hypothesis import given
from hypothesis import strategies as st

from islands.individual import Individual
from islands.island import Island
from islands.kinds.house import HouseKind
from islands.migration.channel import Channel, Packet
from islands.migration.emigrants import Crowd, emigrants
from islands.migration.medoids import medoids
from islands.migration.routes import Routes
from islands.selection import ranked
from islands.settings import Algorithm
from islands.streams import EpochStreams

RISING = Channel(0, "rising", "components", count=2, keep=4)


def house(population: int = 10, **changes) -> Island:
    own = house_spec()
    made = type(own)(**{**{key: getattr(own, key) for key in own.__slots__}, "population": population, **changes})
    biology = HouseKind().build(made, lambda: 0.0)
    routes = Routes((edge(RISING, 1, 0), edge(RISING, 2, 0)), (), 5)
    return Island(made, biology, 5, routes, lambda: 0.0, lambda: None)


def risen(epoch: int, *, both: bool = True) -> tuple[Packet, ...]:
    parts = zones(2)
    packets = (Packet(0, 1, 0, epoch, "", parts[:2]), Packet(0, 2, 0, epoch, "", parts[2:]))
    return packets if both else packets[:1]


def test_an_island_without_parts_waits_and_its_generation_does_not_advance() -> None:
    isle = house()
    begun = isle.begin()
    assert (begun.state.deme, begun.state.generation, begun.state.counter) == ((), 0, 0)
    assert begun.records.generations == ()
    assert [note.kind for note in begun.records.notes] == ["waiting"]
    waited = isle.advance(begun.state, 3, risen(0, both=False))
    assert (waited.state.deme, waited.state.generation, waited.state.epoch) == ((), 0, 1)
    assert (waited.records.born, waited.records.generations) == ((), ())
    assert len(waited.records.crossings) == 2


def test_once_there_is_a_part_of_each_name_it_begins_with_generation_0() -> None:
    isle = house()
    waited = isle.advance(isle.begin().state, 3, ())
    begun = isle.advance(waited.state, 3, risen(1))
    assert [row.generation for row in begun.records.generations] == [0, 1, 2, 3]
    assert [row.evaluations for row in begun.records.generations] == [10, 8, 8, 8]
    first = [row for row in begun.records.born if row.generation == 0]
    assert len(first) == 10
    assert all((row.origin, row.epoch, row.parents) == ("random", 2, ()) for row in first)
    assert all({one // 100 for one in row.components} == {1, 2} for row in begun.records.born)
    assert begun.state.best == max(row.best for row in begun.records.generations if row.best is not None)


def test_epochs_are_counted_from_the_first_population_on() -> None:
    isle = house(epochs=2)
    state = isle.advance(isle.begin().state, 3, ()).state
    bred = []
    for epoch in range(1, 5):
        step = isle.advance(state, 3, risen(epoch) if epoch == 1 else ())
        bred.append([row.generation for row in step.records.generations])
        state = step.state
    assert bred == [[0, 1, 2, 3], [4, 5, 6], [], []]
    assert len(state.deme) == 10


def test_an_island_that_rests_still_sends_and_takes_in() -> None:
    out, back = Channel(0, "out", "migrants", count=2), Channel(1, "back", "migrants")
    isle = island(0, (edge(out, 0, 1), edge(back, 1, 0)), epochs=1)
    state = isle.advance(isle.begin().state, 4, ()).state
    other = island(1).begin().state.deme
    migrant = emigrants_of(isle, other)
    step = isle.advance(state, 4, (Packet(1, 1, 0, 1, "else", (migrant,)),))
    assert step.records.generations == ()
    assert step.state.generation == 4
    assert len(step.departures[0].migrants) == 2
    assert [row.accepted for row in step.records.crossings] == [True]
    assert migrant.id in {one.id for one in step.state.deme}


def emigrants_of(isle, deme):
    from islands.migration.channel import Migrant

    one = deme[0]
    return Migrant(one.id, isle.biology.encode(one.genotype), one.fitness, one.scores, one.error)


@pytest.mark.parametrize("keep", [0, 3])
def test_a_new_run_begins_after_so_many_generations(keep: int) -> None:
    isle = island(algorithm=Algorithm(restart=4, restart_keep=keep))
    begun = isle.begin()
    before = isle.advance(begun.state, 4, ())
    assert all(row.origin != "random" for row in before.records.born)
    after = isle.advance(before.state, 4, ())
    fresh = [row for row in after.records.born if row.generation == 5]
    assert all((row.origin, row.parents) == ("random", ()) for row in fresh)
    assert all(row.origin != "random" for row in after.records.born if row.generation > 5)
    bests = [member.id for member in ranked(before.state.deme)]
    single = isle.advance(before.state, 1, ()).state.deme
    stayed = [one.id for one in single if one.id in bests]
    assert len(single) == 12
    assert len(fresh) == 12 - len(stayed)
    assert len(stayed) == len({one.genotype for one in before.state.deme if one.id in stayed}) <= keep
    assert (bests[0] in stayed) == (keep > 0)
    assert after.state.best >= before.state.best


def points(values) -> np.ndarray:
    column = np.array(values, dtype=float)
    return np.abs(column[:, None] - column)


@given(st.lists(st.integers(0, 30), min_size=1, max_size=9), st.integers(1, 4))
def test_medoids_are_distinct_and_no_swap_of_one_is_better(values: list[int], count: int) -> None:
    apart, wanted = points(values), min(count, len(values))
    chosen = medoids(apart, wanted)
    assert chosen == sorted(set(chosen))
    assert len(chosen) == wanted
    cost = apart[chosen].min(axis=0).sum()
    for place in range(wanted):
        for other in range(len(values)):
            if other not in chosen:
                swapped = [*chosen[:place], *chosen[place + 1 :], other]
                assert apart[swapped].min(axis=0).sum() >= cost * (1 - 1e-9)


def test_medoids_stand_for_the_heaps_that_there_are() -> None:
    assert medoids(points([0, 1, 2, 50, 51, 52, 90, 91, 92]), 3) == [1, 4, 7]
    assert medoids(points([3, 3, 3]), 0) == []


def test_spread_takes_the_promoted_first_and_the_invalid_last() -> None:
    values = [(0, 0, 0, 0), (0, 0, 0, 1), (1, 1, 1, 1), (1, 1, 1, 0), (1, 0, 1, 0)]
    worth = [5.0, 4.0, 3.0, 2.0, None]
    members = [Individual(k, one, fit, (), "") for k, (one, fit) in enumerate(zip(values, worth, strict=True))]
    biology, streams = island(genome={"length": 4, "rate": 0.1}).biology, EpochStreams(1, 0, 1)

    def chosen(count: int, promoted=()) -> list[int]:
        crowd = Crowd(ranked(members, promoted), biology, promoted=promoted)
        places = emigrants(crowd, count, Channel(0, "c", select="spread"), streams)
        return [crowd.order[place].id for place in places]

    assert chosen(2) == [0, 2]
    assert chosen(2, (3,)) == [3, 1]
    assert chosen(5) == [0, 1, 2, 3, 4]


@pytest.mark.parametrize(("epoch", "carries"), [(0, False), (2, False), (3, True), (4, True), (5, False)])
def test_channels_carry_between_their_epochs(epoch: int, carries: bool) -> None:
    assert Channel(0, "c", "components", since=3, until=5).carries(epoch) is carries
