"""Algorithms: who lives on, and how many are bred."""

from __future__ import annotations

from collections import Counter

import pytest
from archipelagos import island, without_clock
from hypothesis import given
from hypothesis import strategies as st

from genome.errors import InputError
from genome.settings import validated
from islands.algorithms.scheme import SCHEMES
from islands.individual import Individual
from islands.selection import ranked
from islands.settings import Algorithm

fitnesses = st.none() | st.sampled_from([0.0, 1.0, 2.0, 3.0])


def members(values, first: int = 0, since: int = 0) -> list[Individual]:
    return [Individual(first + n, (), value, (), "", since) for n, value in enumerate(values)]


def survivors(settings: Algorithm, population: int, parents, children) -> list[int]:
    scheme = SCHEMES[settings.name]
    return [one.id for one in scheme.survivors(settings, population, ranked(parents), children)]


def test_restoring_puts_back_only_what_is_better_than_every_offspring() -> None:
    restore = Algorithm(elitism="restore", elite=1)
    parents = members([1.0, 9.0, 5.0])
    assert survivors(restore, 3, parents, members([3.0, 9.0, 2.0], 10)) == [10, 11, 12]
    assert survivors(restore, 3, parents, members([3.0, 8.0, 2.0], 10)) == [1, 10, 11]
    assert survivors(restore, 3, parents, members([None, 8.0, None], 10)) == [1, 10, 11]
    assert survivors(restore, 3, members([None, None]), members([None, None, None], 10)) == [10, 11, 12]
    two = Algorithm(elitism="restore", elite=2)
    assert survivors(two, 3, parents, members([3.0, 4.0, 2.0], 10)) == [1, 2, 11]
    assert survivors(two, 3, parents, members([3.0, 6.0, 2.0], 10)) == [1, 10, 11]
    assert survivors(Algorithm(elitism="restore", elite=0), 3, parents, members([0.0] * 3, 10)) == [10, 11, 12]


@given(st.lists(fitnesses, min_size=3, max_size=6), st.lists(fitnesses, min_size=6, max_size=6), st.integers(0, 3))
def test_restoring_keeps_the_size_and_the_best(parents, children, elite) -> None:
    settings = Algorithm(elitism="restore", elite=elite)
    old, new = members(parents), members(children, 10)
    left = survivors(settings, 6, old, new)
    assert len(left) == len(set(left)) == 6
    everyone = {one.id: one for one in (*old, *new)}
    if elite:
        best = max((one.fitness for one in everyone.values() if one.fitness is not None), default=None)
        assert max((everyone[i].fitness for i in left if everyone[i].fitness is not None), default=None) == best


def test_restore_breeds_the_whole_deme() -> None:
    isle = island(algorithm=Algorithm(elite=1, elitism="restore"))
    step = isle.advance(isle.begin().state, 5, ())
    assert [row.evaluations for row in step.records.generations] == [12] * 5
    assert len(step.state.deme) == 12
    bests = [row.best for row in step.records.generations]
    assert bests == sorted(bests)


def test_plus_keeps_the_best_of_all_and_of_equals_the_younger() -> None:
    plus = Algorithm(name="plus")
    parents = [*members([3.0, 2.0], since=1), *members([2.0], 5, since=2)]
    assert survivors(plus, 3, parents, members([2.0, None, 2.0], 10, since=3)) == [0, 12, 10]
    assert survivors(plus, 5, parents, members([2.0, None, 2.0], 10, since=3)) == [0, 12, 10, 5, 1]
    assert survivors(plus, 1, members([4.0]), members([4.0], 10, since=1)) == [10]
    assert survivors(plus, 1, members([4.0]), members([3.5], 10, since=1)) == [0]
    assert survivors(plus, 1, members([4.0]), members([None], 10, since=1)) == [0]
    assert survivors(plus, 1, members([None]), members([None], 10, since=1)) == [10]


@pytest.mark.parametrize(("offspring", "bred"), [(None, 12), (1, 1), (5, 5), (30, 30)])
def test_plus_breeds_as_many_as_asked(offspring, bred) -> None:
    isle = island(algorithm=Algorithm(name="plus", offspring=offspring))
    step = isle.advance(isle.begin().state, 3, ())
    assert Counter(row.generation for row in step.records.born) == dict.fromkeys((1, 2, 3), bred)
    assert [row.evaluations for row in step.records.generations] == [bred] * 3
    assert len(step.state.deme) == 12
    everyone = [row.fitness for row in (*isle.begin().records.born, *step.records.born)]
    assert sorted((one.fitness for one in step.state.deme), reverse=True) == sorted(everyone, reverse=True)[:12]


def test_the_one_plus_one_ea_takes_each_offspring_that_is_not_worse() -> None:
    isle = island(population=1, algorithm=Algorithm(name="plus", crossover=0.0), genome={"length": 16, "rate": 0.1})
    begun = isle.begin()
    step = isle.advance(begun.state, 60, ())
    here = begun.records.born[0]
    for row, child in zip(step.records.generations, step.records.born, strict=True):
        assert child.parents == (here.id,)
        assert child.origin == "mutation"
        here = child if child.fitness >= here.fitness else here
        assert (row.best, row.evaluations, row.diversity) == (here.fitness, 1, None)
    assert [one.id for one in step.state.deme] == [here.id]
    assert step.state.deme[0].since == next(row.generation for row in step.records.born if row.id == here.id)


def test_an_epoch_of_two_generations_is_not_two_epochs_of_one_but_as_good() -> None:
    isle = island(population=1, algorithm=Algorithm(name="plus", crossover=0.0))
    state = isle.begin().state
    assert (
        without_clock(isle.advance(state, 1, ()).records).born
        == without_clock(isle.advance(state, 2, ()).records).born[:1]
    )


def test_offspring_is_a_setting_of_plus_alone() -> None:
    with pytest.raises(InputError) as caught:
        validated(Algorithm, {"offspring": 8}, "x.yaml", ("islands", "a", "algorithm"))
    expected = "x.yaml: islands.a.algorithm: expected no offspring with the algorithm 'generational', got 8"
    assert str(caught.value) == f"{expected}; did you mean name: plus?"
    assert Algorithm.model_validate(Algorithm().model_dump()) == Algorithm()
    assert Algorithm(name="plus", offspring=8).offspring == 8


def test_generations_without_a_rise_are_counted() -> None:
    isle = island()
    step = isle.begin()
    best, stagnant = step.records.generations[-1].best, 0
    assert (step.state.best, step.state.stagnant) == (best, 0)
    for _ in range(12):
        step = isle.advance(step.state, 2, ())
        for row in step.records.generations:
            stagnant = 0 if row.best > best else stagnant + 1
            best = max(best, row.best)
        assert (step.state.best, step.state.stagnant) == (best, stagnant)
    assert stagnant > 2
