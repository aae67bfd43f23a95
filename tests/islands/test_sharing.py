"""Competitive fitness sharing: closed forms, what it leaves alone, and its effect on who breeds and who lives on."""

from __future__ import annotations

import json
import math
from collections import Counter
from dataclasses import replace

import pytest
from archipelagos import LENGTH, edge, island
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from species import FriendKind

from islands.algorithms.breeding import breed
from islands.algorithms.scheme import SCHEMES
from islands.individual import Individual
from islands.migration.channel import Channel, Migrant, Packet, Pairing
from islands.selection import ranked
from islands.settings import Algorithm
from islands.sharing import judged, shared, survivors
from islands.steered import Steered
from islands.streams import EpochStreams

SHARING = Algorithm(sharing="competitive", elite=1)


def member(identity: int, outcomes: dict[str, float | None], fitness: float | None = 0.0, since: int = 0):
    return Individual(identity, (identity,), fitness, (), "", since, tuple(outcomes.items()))


def worth(*members: Individual) -> list[float | None]:
    return [one.fitness for one in shared(members)]


def test_of_won_and_lost_the_winners_take_equal_parts_as_in_the_paper() -> None:
    # p is beaten by one, q by three, r by none, s by all.
    rows = [(1, 1, 0, 1), (0, 1, 0, 1), (0, 1, 0, 1), (0, 0, 0, 1)]
    deme = [member(n, dict(zip("pqrs", map(float, row), strict=True))) for n, row in enumerate(rows)]
    common = 1 / 4 + 1 / 4  # of r and s, against which all do alike
    assert worth(*deme) == pytest.approx([1 + 1 / 3 + common, 1 / 3 + common, 1 / 3 + common, common], rel=1e-15)


def test_of_values_parts_go_by_the_way_from_the_worst_to_the_best() -> None:
    # Gains of p: 1, 1/4, 0; of q: 0, 1, 1/2. Sums 5/4 and 3/2.
    deme = [
        member(1, {"p": -2.0, "q": 10.0}),
        member(2, {"p": -5.0, "q": 30.0}),
        member(3, {"p": -6.0, "q": 20.0}),
    ]
    assert worth(*deme) == pytest.approx([4 / 5, 1 / 5 + 2 / 3, 1 / 3], rel=1e-15)


def test_an_invalid_outcome_takes_nothing_and_an_invalid_member_is_as_if_it_were_not_there() -> None:
    deme = [member(1, {"p": 3.0, "q": None}), member(2, {"p": 3.0, "q": 3.0}), member(3, {"p": 9.0}, fitness=None)]
    assert worth(*deme) == [0.5, 1.5, None]
    assert worth(member(1, {"p": None}, fitness=1.0), member(2, {"p": None})) == [0.0, 0.0]


def test_a_partner_that_few_have_met_is_worth_so_much_less() -> None:
    deme = [member(1, {"p": 1.0}), member(2, {"q": 1.0}), member(3, {"q": 0.0}), member(4, {"q": 1.0})]
    # q is 3/4, of which two take half each; whoever met nobody else takes 1/4 of p.
    assert worth(*deme) == [0.25, 0.375, 0.0, 0.375]


def test_where_nobody_has_partners_fitness_stays() -> None:
    deme = [member(1, {}, 4.0), member(2, {}, None)]
    assert shared(deme) is deme
    assert judged(deme, Algorithm()) is deme
    assert shared(()) == ()


def test_the_largest_values_there_are_divide() -> None:
    top = 1.7e308
    assert worth(member(1, {"p": top}), member(2, {"p": -top}), member(3, {"p": 0.0})) == [2 / 3, 0.0, 1 / 3]


OUTCOMES = st.dictionaries(st.sampled_from("pqrs"), st.none() | st.floats(-1e6, 1e6), min_size=1)


@given(st.lists(st.tuples(OUTCOMES, st.none() | st.floats(-1, 1)), min_size=1, max_size=9), st.randoms())
def test_parts_are_positive_sum_to_what_is_there_and_hang_on_no_order(drawn, random) -> None:
    deme = [member(n, outcomes, fitness) for n, (outcomes, fitness) in enumerate(drawn)]
    found = shared(deme)
    valid = [one for one in found if one.fitness is not None]
    assert [one.id for one in valid] == [one.id for one in deme if one.fitness is not None]
    assert all(one.fitness >= 0 for one in valid)
    met = Counter(name for one in valid for name, _ in one.outcomes)
    beaten = {name for one in valid for name, value in one.outcomes if value is not None}
    assert math.fsum(one.fitness for one in valid) == pytest.approx(
        sum(count / len(valid) for name, count in met.items() if name in beaten)
    )
    turned = [one.__class__(one.id, one.genotype, one.fitness, (), "", 0, one.outcomes[::-1]) for one in deme]
    random.shuffle(turned)
    assert {one.id: one.fitness for one in shared(turned)} == {one.id: one.fitness for one in found}


# -- who breeds, and who lives on --------------------------------------------------------------------------------------

# Seven do well against p and q, and the eighth only against r: by its mean it is the last, shared the first.
CROWD = [member(n, {"p": 2.0, "q": 2.0, "r": 0.0}, 4 / 3) for n in range(7)]
ODD = member(7, {"p": 0.0, "q": 0.0, "r": 1.0}, 1 / 3)


def test_the_one_who_alone_copes_with_a_partner_is_selected_most_often() -> None:
    deme = [*CROWD, ODD]
    streams = EpochStreams(3, 0, 1)

    class Biology:
        def crossover(self, first, second, rng):
            return first, second

        def mutate(self, genotype, rng):
            return genotype

    settings = Algorithm(sharing="competitive", selection="roulette", crossover=0)
    order = ranked(judged(deme, settings))
    assert order[0].id == 7
    births = breed(Biology(), order, 4000, settings, streams)
    found = Counter(birth.parents[0] for birth in births)
    # Worth 1 against 2/7 for each of the others; the wheel counts from the worst, who is never drawn.
    assert found == {7: 4000}
    other = member(8, {"p": 0.0, "q": 0.0, "r": 0.0}, 0.0)
    order = ranked(judged([*deme, other], settings))
    found = Counter(birth.parents[0] for birth in breed(Biology(), order, 6000, settings, EpochStreams(3, 0, 1)))
    expected = [6000 / 3, *[6000 * 2 / 21] * 7]
    assert stats.chisquare([found[7], *(found[n] for n in range(7))], expected).pvalue > 1e-3
    plain = Algorithm(selection="roulette", crossover=0)
    raw = Counter(birth.parents[0] for birth in breed(Biology(), ranked([*deme, other]), 6000, plain, streams))
    assert raw[7] < 6000 / 20


@pytest.mark.parametrize(
    ("settings", "places", "expected", "unshared"),
    [
        (Algorithm(elite=1), 8, [7, *range(10, 16), 17], [0, *range(10, 16), 17]),
        (Algorithm(name="plus"), 3, [17, 6, 5], [6, 5, 4]),
        (Algorithm(name="parents", parents=1), 3, [17, 10, 11], [0, 17, 10]),
    ],
)
def test_members_live_on_by_shared_fitness(settings, places, expected, unshared) -> None:
    # Of the children one copes with r, better than the odd one: 3/4 of it are its own, 1/4 the odd one's, and each of
    # the crowd takes 2/7 of p and q.
    better = member(17, {"p": 0.0, "q": 0.0, "r": 3.0}, 1.0, since=1)
    weak = [member(n, {"p": 0.0, "q": 0.0, "r": 0.0}, 0.0, since=1) for n in range(10, 16)]
    for sharing, ids in (("competitive", expected), ("none", unshared)):
        now = settings.model_copy(update={"sharing": sharing})
        order = ranked(judged([*CROWD, ODD], now))
        found = survivors(SCHEMES[now.name], now, places, order, [*weak, better])
        assert [one.id for one in found] == ids
        given = {one.id: one for one in (*order, *weak, better)}
        assert all(one is given[one.id] for one in found)


def test_an_elite_is_put_back_by_what_it_takes_beside_the_offspring() -> None:
    restore = Algorithm(elitism="restore", elite=1, sharing="competitive")
    order = ranked(shared([ODD, *CROWD]))
    children = [member(20 + n, {"p": 1.0, "q": 1.0, "r": 0.0}, 2 / 3, since=1) for n in range(8)]
    # Nobody else has anything of r.
    found = [one.id for one in survivors(SCHEMES["generational"], restore, 8, order, children)]
    assert found[0] == 7
    assert len(found) == 8
    copes = member(30, {"p": 1.0, "q": 1.0, "r": 9.0}, 11 / 3, since=1)
    assert 7 not in [one.id for one in survivors(SCHEMES["generational"], restore, 8, order, [*children[:7], copes])]


# -- on an island ------------------------------------------------------------------------------------------------------


def shown(identity: int, ones: int, fitness: float = 0.0) -> Migrant:
    return Migrant(identity, json.dumps([1] * ones + [0] * (LENGTH - ones)), fitness, (), "")


def packet(*migrants: Migrant, channel: int = 0, epoch: int = 0, scoring: str = "theirs") -> Packet:
    return Packet(channel, 0, 1, epoch, scoring, migrants)


SEVERAL = Channel(0, "p0", "partners", pairing=Pairing("several", 3))
THREE = (shown(70, 9, 3.0), shown(71, 4, 2.0), shown(72, 0, 1.0))


def friends(*channels: Channel, **changes):
    edges = tuple(edge(one, 0, 1) for one in channels)
    return island(1, edges, kind=FriendKind, **{"algorithm": SHARING, **changes})


def test_members_keep_the_outcomes_of_their_pairings_and_the_log_their_own_fitness() -> None:
    isle = friends(SEVERAL)
    begun = isle.begin()
    assert all(one.outcomes == () for one in begun.state.deme)
    step = isle.advance(begun.state, 3, [packet(*THREE)])
    for one in step.state.deme:
        ids, values = zip(*((name.partition(":")[0], value) for name, value in one.outcomes), strict=True)
        assert ids == ("70", "71", "72")
        assert values == (float(sum(one.genotype[:9])), float(sum(one.genotype[:4])), None)
        assert one.fitness == (values[0] + values[1]) / 2
    rows = {row.id: row.fitness for row in (*step.records.rescored, *step.records.born)}
    assert all(rows[one.id] == one.fitness for one in step.state.deme)
    plain = friends(SEVERAL, algorithm=Algorithm(elite=1))
    other = plain.advance(plain.begin().state, 3, [packet(*THREE)])
    assert all(one.outcomes == () for one in other.state.deme)
    assert other.records.rescored == step.records.rescored  # the scores are the same, the offspring are not
    assert [row.genotype for row in other.records.born] != [row.genotype for row in step.records.born]


def test_the_elite_is_the_one_that_takes_most() -> None:
    isle = friends(SEVERAL)
    begun = isle.begin()
    step = isle.advance(begun.state, 1, [packet(*THREE)])
    scored = isle.advance(begun.state, 1, [packet(*THREE)]).records.rescored
    genes = {one.id: one.genotype for one in begun.state.deme}
    names = {
        row.id: {"a": float(sum(genes[row.id][:9])), "b": float(sum(genes[row.id][:4])), "c": None} for row in scored
    }
    first = ranked(shared([member(identity, outcomes) for identity, outcomes in names.items()]))[0]
    assert step.state.deme[0].id == first.id


def test_migrants_are_scored_again_since_outcomes_do_not_travel() -> None:
    migrants = Channel(1, "m", count=1)
    isle = friends(SEVERAL, migrants)
    state = isle.advance(isle.begin().state, 1, [packet(*THREE)]).state
    one = Migrant(999, json.dumps([1] * LENGTH), 6.5, (), "")
    step = isle.advance(state, 1, [packet(one, channel=1, epoch=1, scoring=state.scoring)])
    assert [(row.id, row.reason, row.fitness) for row in step.records.rescored] == [(999, "migrant", 6.5)]
    assert all(len(each.outcomes) == 3 for each in step.state.deme)
    plain = friends(SEVERAL, migrants, algorithm=Algorithm(elite=1))
    before = plain.advance(plain.begin().state, 1, [packet(*THREE)]).state
    step = plain.advance(before, 1, [packet(one, channel=1, epoch=1, scoring=before.scoring)])
    assert step.records.rescored == ()
    # Alone, members are compared by fitness, and so are migrants.
    alone = friends(SEVERAL, migrants)
    begun = alone.begin().state
    step = alone.advance(begun, 1, [packet(one, channel=1, scoring=begun.scoring)])
    assert step.records.rescored == ()


def test_locked_and_promoted_members_stay_with_their_own_fitness() -> None:
    isle = friends(SEVERAL)
    state = isle.advance(isle.begin().state, 1, [packet(*THREE)]).state
    last = ranked(state.deme)[-1]
    held = replace(state, steered=Steered(promoted=(last.id,), locked=(last.id,)))
    after = isle.advance(held, 4, ()).state
    assert [one for one in after.deme if one.id == last.id] == [last]
