"""The algorithm of few parents, kept until beaten, and selection by roulette and at random (Senatore 2009)."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from archipelagos import island, ring, spec
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from genome.errors import InputError
from genome.settings import validated
from islands.algorithms.breeding import breed
from islands.algorithms.scheme import SCHEMES
from islands.individual import Individual, make_id
from islands.interventions.intervention import Intervention
from islands.interventions.rates import changed
from islands.island import Island
from islands.migration.channel import Channel, Migrant, Packet
from islands.selection import ranked, roulettes, uniform
from islands.settings import Algorithm
from islands.streams import EpochStreams

LEAST = 1e-3
"""Probability below which what was drawn is not put down to chance."""


def members(values, first: int = 0, since: int = 0) -> list[Individual]:
    return [Individual(first + n, (), value, (), "", since) for n, value in enumerate(values)]


def survivors(settings: Algorithm, population: int, old, children, promoted=()) -> list[int]:
    order = ranked(old, promoted)
    return [one.id for one in SCHEMES["parents"].survivors(settings, population, order, children, promoted)]


def elitist(**changes) -> Algorithm:
    return Algorithm(**{"name": "parents", "parents": 2, "selection": "uniform", **changes})


def test_parents_stay_until_better_ones_come_and_offspring_fill_the_deme() -> None:
    old = members([9.0, 5.0, 4.0, 3.0])
    assert survivors(elitist(), 4, old, members([1.0, 2.0, 6.0, 5.5], 10, 1)) == [0, 12, 13, 11]
    # Of equals the parent stays; a member that was no parent is gone, however good its fitness beside the offspring's.
    assert survivors(elitist(), 4, old, members([5.0, 1.0, 2.0, 0.0], 10, 1)) == [0, 1, 10, 12]
    assert survivors(elitist(), 4, old, members([9.0] * 4, 10, 1)) == [0, 10, 11, 12]


def test_of_equals_the_parent_stays_though_its_id_is_the_higher() -> None:
    immigrant = Individual(99, (), 5.0, (), "", 0)
    assert survivors(elitist(parents=1), 2, [immigrant, *members([1.0])], members([5.0, 4.0], 10, 1)) == [99, 10]


def test_one_who_is_invalid_is_a_parent_for_want_of_valid_ones_and_gives_way_to_any_offspring() -> None:
    old = members([1.0, None, None])
    assert survivors(elitist(), 3, old, members([None, None, 0.0], 10, 1)) == [0, 12, 10]
    assert survivors(elitist(), 3, old, members([None, None, None], 10, 1)) == [0, 10, 11]
    nobody = members([None, None, None])
    assert survivors(elitist(), 3, nobody, members([None, None, None], 10, 1)) == [10, 11, 12]


def test_a_longest_life_counts_the_generations_as_a_parent() -> None:
    settings = elitist(longest_life=3)
    old = [*members([9.0], 0, since=4), *members([8.0], 5, since=5)]
    children = members([1.0, 2.0], 10, since=7)
    assert survivors(settings, 2, old, children) == [5, 11]
    assert survivors(elitist(longest_life=4), 2, old, children) == [0, 5]
    assert survivors(elitist(longest_life=2), 2, old, children) == [11, 10]
    assert survivors(elitist(longest_life=2), 2, old, children, promoted=(0,)) == [11, 10]


def test_who_is_promoted_is_a_parent_whatever_its_fitness() -> None:
    old = members([9.0, 5.0, 4.0, None])
    assert survivors(elitist(), 4, old, members([10.0] * 4, 10, 1), promoted=(3,)) == [3, 10, 11, 12]


fitnesses = st.none() | st.sampled_from([0.0, 1.0, -2.0, 3.0])


@given(
    old=st.lists(fitnesses, min_size=1, max_size=6),
    new=st.lists(fitnesses, min_size=6, max_size=6),
    parents=st.none() | st.integers(1, 6),
    life=st.none() | st.integers(1, 2),
)
def test_the_deme_keeps_its_size_and_its_first_are_the_best_of_parents_and_offspring(old, new, parents, life) -> None:
    settings = Algorithm(name="parents", parents=parents, longest_life=life)
    before, children = members(old), members(new, 10, 1)
    left = survivors(settings, 6, before, children)
    assert len(left) == len(set(left)) == 6
    count = parents or 1
    breeders = [] if life == 1 else ranked(before)[:count]
    everyone = {one.id: one for one in (*before, *children)}
    worths = sorted(
        (float("-inf") if one.fitness is None else one.fitness for one in (*breeders, *children)), reverse=True
    )
    found = [everyone[i].fitness for i in left[:count]]
    assert [float("-inf") if value is None else value for value in found] == worths[:count]
    assert {i for i in left if i < 10} <= {one.id for one in breeders}


def isle(population: int = 12, algorithm: Algorithm | None = None) -> Island:
    return island(population=population, algorithm=algorithm or elitist(parents=3))


def test_only_parents_breed_and_a_generation_is_made_whole() -> None:
    one = isle()
    state = one.begin().state
    for _ in range(6):
        parents = {member.id for member in ranked(state.deme)[:3]}
        step = one.advance(state, 1, ())
        assert len(step.records.born) == 12
        assert {parent for row in step.records.born for parent in row.parents} <= parents
        assert len(step.state.deme) == 12
        fitness = {row.id: row.fitness for row in step.records.born}
        pool = [*(member for member in state.deme if member.id in parents)]
        best = sorted([*fitness.values(), *(member.fitness for member in pool)], reverse=True)[:3]
        assert sorted((member.fitness for member in step.state.deme), reverse=True)[:3] == best
        state = step.state
    without = isle(algorithm=Algorithm(name="parents"))
    begun = without.begin().state
    three = {member.id for member in ranked(begun.deme)[:3]}
    bred = without.advance(begun, 1, ()).records.born
    assert {parent for row in bred for parent in row.parents} == three, "a quarter of twelve"


def test_no_parent_outlives_its_longest_life() -> None:
    def oldest(life: int | None) -> int:
        one = isle(algorithm=elitist(parents=3, longest_life=life, mutation=0.0, crossover=1.0))
        state, most = one.begin().state, 0
        for _ in range(30):
            step = one.advance(state, 1, ())
            since = {member.id: member.since for member in state.deme}
            generation = step.records.generations[0].generation
            most = max(most, *(generation - since[p] for row in step.records.born for p in row.parents))
            state = step.state
        return most

    assert oldest(4) == 4
    assert oldest(None) > 4


def test_an_immigrant_that_is_among_the_best_breeds_at_once() -> None:
    one = island(0, ring(2, Channel(0, "ring")), algorithm=elitist(parents=1))
    state = one.begin().state
    guest = make_id(1, 0)
    perfect = one.biology.encode(tuple([1] * 24))
    packet = Packet(0, 1, 0, 0, one.biology.scoring, (Migrant(guest, perfect, 24.0, (), ""),))
    step = one.advance(state, 1, [packet])
    assert {row.parents for row in step.records.born} == {(guest,)}
    assert step.state.deme[0].id == guest


def test_a_locked_member_stays_beside_the_parents() -> None:
    one = isle(algorithm=elitist(parents=2, longest_life=1))
    state = one.begin().state
    worst = ranked(state.deme)[-1].id
    step = one.advance(state, 5, (), [Intervention("lock", {"id": worst}, ())])
    assert worst in {member.id for member in step.state.deme}
    assert len(step.state.deme) == 12


# -- selection ---------------------------------------------------------------------------------------------------------


def agreement(places, expected: list[float]) -> float:
    found = Counter(int(place) for place in places)
    keys = [place for place, share in enumerate(expected) if share > 0]
    if not set(found) <= set(keys):
        return 0.0
    rounds = sum(found.values())
    return float(stats.chisquare([found[key] for key in keys], [rounds * expected[key] for key in keys]).pvalue)


ROULETTES = [
    ([4.0, 2.0, 1.0, 0.0], [4 / 7, 2 / 7, 1 / 7, 0]),
    ([-7.0, -8.0, -10.0, None], [3 / 5, 2 / 5, 0, 0]),
    ([1e308, 0.0, -1e308], [2 / 3, 1 / 3, 0]),
    ([5.0, 5.0, 5.0, None], [1 / 3, 1 / 3, 1 / 3, 0]),
    ([None, None], [1 / 2, 1 / 2]),
]


@pytest.mark.parametrize(("values", "shares"), ROULETTES)
def test_a_roulette_weighs_what_lies_above_the_worst_valid(values, shares) -> None:
    places = roulettes(ranked(members(values)), 4000, np.random.default_rng(5))
    assert places.dtype == np.int64
    assert agreement(places, shares) > LEAST


def test_a_roulette_of_one_gives_that_one() -> None:
    assert roulettes(members([5.0]), 3, np.random.default_rng(5)).tolist() == [0, 0, 0]


def test_a_roulette_weighs_one_who_is_promoted_as_the_best() -> None:
    for values, shares in (([1.0, 3.0, 2.0], [2 / 5, 2 / 5, 1 / 5]), ([None, 3.0, 2.0], [1 / 2, 1 / 2, 0])):
        order = ranked(members(values), (0,))
        assert [one.id for one in order] == [0, 1, 2]
        assert agreement(roulettes(order, 4000, np.random.default_rng(6)), shares) > LEAST


def test_uniform_selection_has_no_favourites() -> None:
    assert agreement(uniform(5, 4000, np.random.default_rng(7)), [1 / 5] * 5) > LEAST


@pytest.mark.parametrize(("selection", "shares"), [("roulette", [2 / 3, 1 / 3, 0]), ("uniform", [1 / 3] * 3)])
def test_an_island_selects_its_parents_so(selection, shares) -> None:
    biology = island().biology
    order = ranked([Individual(n, (0,) * 24, value, (), "", 0) for n, value in enumerate([2.0, 1.0, 0.0])])
    settings = Algorithm(selection=selection, crossover=0.0)
    births = breed(biology, order, 3000, settings, EpochStreams(1, 0, 1))
    assert agreement([birth.parents[0] for birth in births], shares) > LEAST


# -- settings ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"parents": 4}, "expected no parents with the algorithm 'generational', got 4; did you mean name: parents?"),
        (
            {"name": "plus", "longest_life": 4},
            "expected no longest_life with the algorithm 'plus', got 4; did you mean name: parents?",
        ),
        (
            {"name": "parents", "offspring": 4},
            "expected no offspring with the algorithm 'parents', got 4; did you mean name: plus?",
        ),
    ],
)
def test_keys_belong_to_their_algorithm(given, message) -> None:
    with pytest.raises(InputError) as caught:
        validated(Algorithm, given, "x.yaml", ("islands", "a", "algorithm"))
    assert str(caught.value) == f"x.yaml: islands.a.algorithm: {message}"


def test_numbers_of_parents_and_lives_begin_with_one() -> None:
    for key in ("parents", "longest_life"):
        with pytest.raises(InputError, match=f"{key}: expected greater than or equal to 1, got 0"):
            validated(Algorithm, {"name": "parents", key: 0}, "x.yaml", ())


def test_parents_and_longest_life_can_be_steered() -> None:
    settings = elitist()
    assert changed(settings, 12, {"parents": 12, "longest_life": 3}, "steer rate") == {"parents": 12, "longest_life": 3}
    with pytest.raises(InputError, match="parents: expected at most the population of 12, got 13"):
        changed(settings, 12, {"parents": 13}, "steer rate")
    with pytest.raises(InputError, match="elite: expected no elite with the algorithm 'parents', got 1"):
        changed(settings, 12, {"elite": 1}, "steer rate")
    one = isle(algorithm=settings)
    step = one.advance(one.begin().state, 1, (), [Intervention("rate", {"values": {"parents": 1}}, ())])
    assert step.state.steered.rates == (("parents", 1),)
    assert len({parent for row in step.records.born for parent in row.parents}) == 1
    assert spec(algorithm=settings).algorithm.breeders(12) == 2
