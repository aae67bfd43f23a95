"""Who emigrates, and whose place an immigrant takes: by distribution where it is drawn, exactly elsewhere."""

from __future__ import annotations

import itertools
import math
from collections import Counter

import numpy as np
import pytest
from archipelagos import island
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from islands.individual import Individual
from islands.migration.channel import Channel
from islands.migration.emigrants import CHOOSERS, Crowd, emigrants
from islands.migration.replacement import BY_GENOTYPE, REPLACERS
from islands.selection import ranked
from islands.streams import EpochStreams

BIOLOGY = island().biology


def deme(*fitness: float | None, genotypes=None, since=None) -> list[Individual]:
    given = genotypes or [(0, 0, 0)] * len(fitness)
    ages = since or [0] * len(fitness)
    return [Individual(n, given[n], value, (), "", ages[n]) for n, value in enumerate(fitness)]


def drawn(members, count: int, rounds: int, **settings) -> Counter:
    """Give how often each set of ids is chosen."""
    crowd, channel, streams = Crowd(ranked(members), BIOLOGY), Channel(0, "c", **settings), EpochStreams(3, 0, 1)
    found: Counter = Counter()
    for _ in range(rounds):
        found[tuple(crowd.order[place].id for place in emigrants(crowd, count, channel, streams))] += 1
    return found


LEAST: float = 1e-3
"""Probability below which what was drawn is not put down to chance."""


def agreement(found: Counter, expected: dict) -> float:
    """Give the probability of counts as far from the shares expected; 0 where something came that cannot."""
    keys = [key for key, share in expected.items() if share > 0]
    if not set(found) <= set(keys):
        return 0.0
    rounds = sum(found.values())
    return float(stats.chisquare([found[key] for key in keys], [rounds * expected[key] for key in keys]).pvalue)


@pytest.mark.parametrize("select", sorted(CHOOSERS))
@given(
    values=st.lists(
        st.none() | st.sampled_from([0.0, 1.0, -2.0, 1e308, -1e308]) | st.floats(-9, 9), min_size=1, max_size=9
    ),
    bits=st.lists(st.tuples(*[st.integers(0, 1)] * 3), min_size=9, max_size=9),
    count=st.integers(1, 12),
)
def test_every_chooser_gives_as_many_distinct_members_as_asked_best_first(select, values, bits, count) -> None:
    crowd = Crowd(ranked(deme(*values, genotypes=bits)), BIOLOGY)
    for epoch in (1, 2):
        places = emigrants(crowd, count, Channel(0, "c", select=select), EpochStreams(1, 0, epoch))
        assert places == sorted(set(places))
        assert len(places) == min(count, len(values))
        assert all(0 <= place < len(values) and isinstance(place, int) for place in places)


def test_the_best_are_the_first_and_nothing_is_drawn() -> None:
    assert drawn(deme(1, 3, None, 2), 3, 1, select="best") == {(1, 3, 0): 1}


def test_random_sets_are_as_likely_as_each_other() -> None:
    sets = list(itertools.combinations(range(4), 2))
    assert agreement(drawn(deme(3, 2, 1, 0), 2, 3000, select="random"), {one: 1 / len(sets) for one in sets}) > LEAST


@pytest.mark.parametrize("entrants", [1, 2, 3])
def test_a_tournament_is_won_by_the_best_of_its_entrants_and_the_next_is_held_among_the_rest(entrants) -> None:
    def wins(place: int, size: int) -> float:
        return ((size - place) ** entrants - (size - place - 1) ** entrants) / size**entrants

    expected: dict = {}
    for first, second in itertools.permutations(range(4), 2):
        pair = tuple(sorted((first, second)))
        share = wins(first, 4) * wins(second - (second > first), 3)
        expected[pair] = expected.get(pair, 0.0) + share
    assert agreement(drawn(deme(3, 2, 1, 0), 2, 4000, select="tournament", tournament=entrants), expected) > LEAST


def test_roulette_weighs_what_lies_above_the_worst_valid() -> None:
    assert (
        agreement(drawn(deme(-7.0, -8.0, -10.0, None), 1, 3000, select="roulette"), {(0,): 3 / 5, (1,): 2 / 5}) > LEAST
    )
    expected = {(0, 1): 1 / 6 * 2 / 5 + 2 / 6 * 1 / 4, (0, 2): 1 / 6 * 3 / 5 + 3 / 6 * 1 / 3}
    expected[1, 2] = 1 - sum(expected.values())
    shown = {tuple(sorted(key)): value for key, value in expected.items()}
    found = drawn(deme(1.0, 2.0, 3.0, 0.0), 2, 4000, select="roulette")
    assert agreement(Counter({tuple(sorted(key)): count for key, count in found.items()}), shown) > LEAST


def test_roulette_takes_the_rest_alike_the_valid_first() -> None:
    assert (
        agreement(drawn(deme(5.0, 5.0, 5.0, None), 1, 3000, select="roulette"), {(n,): 1 / 3 for n in range(3)}) > LEAST
    )
    members = deme(9.0, 1.0, 1.0, None, None)
    assert agreement(drawn(members, 2, 2000, select="roulette"), {(0, 1): 1 / 2, (0, 2): 1 / 2}) > LEAST
    assert agreement(drawn(members, 4, 2000, select="roulette"), {(0, 1, 2, 3): 1 / 2, (0, 1, 2, 4): 1 / 2}) > LEAST
    assert agreement(drawn(deme(None, None), 1, 2000, select="roulette"), {(0,): 1 / 2, (1,): 1 / 2}) > LEAST


def test_the_most_diverse_are_far_from_all_and_then_from_each_other() -> None:
    genotypes = [(0, 0, 0, 0), (0, 0, 0, 1), (0, 0, 0, 0), (1, 1, 1, 0), (0, 1, 1, 1)]
    members = deme(5, 4, 3, 2, 1, genotypes=genotypes)
    apart = np.array([[sum(a != b for a, b in zip(x, y, strict=True)) for y in genotypes] for x in genotypes])
    assert apart.sum(axis=1).tolist() == [7, 8, 7, 12, 10]
    assert drawn(members, 1, 1, select="diverse") == {(3,): 1}
    assert drawn(members, 2, 1, select="diverse") == {(1, 3): 1}
    # From 1 and 3: member 0 is 1 away, 2 is 1, 4 is 2.
    assert drawn(members, 3, 1, select="diverse") == {(1, 3, 4): 1}
    assert drawn(members, 4, 1, select="diverse") == {(0, 1, 3, 4): 1}
    assert drawn(deme(2, 1, 0), 2, 1, select="diverse") == {(0, 1): 1}


def test_of_the_equally_distant_the_better_is_chosen_though_their_sums_are_rounded() -> None:
    words = ("011001000110", "100111011101", "001110001010", "100011101110")
    genotypes = [tuple(map(int, word)) for word in words]
    apart = np.array([[sum(a != b for a, b in zip(x, y, strict=True)) for y in genotypes] for x in genotypes])
    assert apart.sum(axis=1).tolist() == [21, 21, 19, 17]
    means = (apart / 12).mean(axis=1)
    assert means[0] < means[1]  # in floats they are not equal
    for order in (genotypes, [genotypes[1], genotypes[0], *genotypes[2:]]):
        assert drawn(deme(4, 3, 2, 1, genotypes=order), 1, 1, select="diverse") == {(0,): 1}


def test_a_distance_that_is_no_number_is_none(monkeypatch) -> None:
    isle = island()
    monkeypatch.setattr(isle.biology, "diversity", lambda pair: float(pair[0][0] * pair[1][0]))
    strange = [(0,), (1,), (math.inf,), (1,)]
    crowd = Crowd(deme(4, 3, 2, 1, genotypes=strange), isle.biology)
    assert emigrants(crowd, 3, Channel(0, "c", select="diverse"), EpochStreams(1, 0, 1)) == [0, 1, 3]


def test_distances_are_worked_out_once_for_who_leaves_and_who_is_left(monkeypatch) -> None:
    isle, asked = island(), []
    monkeypatch.setattr(isle.biology, "diversity", lambda pair: asked.append(pair) or float(pair[0] != pair[1]))
    crowd = Crowd(deme(*range(6), genotypes=[(n,) for n in range(6)]), isle.biology)
    crowd.apart()
    left = crowd.without([1, 4])
    assert [one.id for one in left.order] == [0, 2, 3, 5]
    assert left.apart().tolist() == (1 - np.eye(4)).tolist()
    assert len(asked) == 15


def places(name: str, residents, rounds: int = 1, newcomer=None, **settings) -> Counter:
    streams, channel = EpochStreams(9, 0, 1), Channel(0, "c", replace=name, **settings)
    order = ranked(residents)
    return Counter(order[REPLACERS[name](order, newcomer, BIOLOGY, channel, streams)].id for _ in range(rounds))


def test_the_worst_and_the_oldest_are_exact_and_of_equals_the_worst_goes() -> None:
    assert places("worst", deme(3, None, 2)) == {1: 1}
    assert places("oldest", deme(3, 2, 1, 0, since=[4, 2, 2, 9])) == {2: 1}
    assert places("oldest", deme(3, 2, None, since=[0, 5, 5])) == {0: 1}


def test_the_most_similar_goes_and_of_equals_the_worst() -> None:
    genotypes = [(1, 1, 1), (0, 1, 1), (1, 1, 0), (0, 0, 0)]
    members = deme(3, 2, 1, 0, genotypes=genotypes)
    assert places("similar", members, newcomer=(1, 1, 1)) == {0: 1}
    assert places("similar", members, newcomer=(0, 1, 0)) == {3: 1}
    assert places("similar", members, newcomer=(0, 0, 1)) == {3: 1}
    assert {"similar"} == BY_GENOTYPE


def test_a_random_resident_goes_each_as_likely_and_a_tournament_loses_the_worst_of_its_entrants() -> None:
    assert agreement(places("random", deme(3, 2, 1, 0), 3000), dict.fromkeys(range(4), 1 / 4)) > LEAST
    expected = {n: ((n + 1) ** 3 - n**3) / 4**3 for n in range(4)}
    assert agreement(places("tournament", deme(3, 2, 1, 0), 4000, tournament=3), expected) > LEAST


def test_a_rate_is_a_share_of_the_deme_half_up_and_at_least_one() -> None:
    assert [Channel(0, "c", rate=0.5).size(size) for size in (1, 2, 3, 5, 7, 9)] == [1, 1, 2, 3, 4, 5]
    assert Channel(0, "c", rate=0.145).size(100) == 15
    assert [Channel(0, "c", rate=0.1).size(size) for size in (1, 12, 26, 200)] == [1, 1, 3, 20]
    assert math.isclose(Channel(0, "c", rate=1.0).size(7), 7)
