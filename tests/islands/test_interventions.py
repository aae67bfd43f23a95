"""Interventions: what each changes on an island, that it is told, and that the same ones give the same result."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

import pytest
from archipelagos import LENGTH, island, ring, without_clock
from hypothesis import given, settings
from hypothesis import strategies as st

from evaluators.fitness import Goal
from genome.errors import InputError
from islands.individual import Individual, make_id
from islands.interventions.intervention import Intervention
from islands.interventions.registry import KINDS
from islands.island import Island
from islands.migration.channel import Channel, Migrant, Packet
from islands.migration.emigrants import Crowd, emigrants
from islands.selection import ranked
from islands.settings import Algorithm
from islands.state import Advance
from islands.steered import UNSTEERED, Steered
from islands.streams import EpochStreams

GOALS = {"ones": {"goal": "maximise"}, "edges": {"goal": "maximise", "weight": 0.5}}


def told(step: Advance[Any]) -> list[dict[str, Any]]:
    assert {note.kind for note in step.records.notes} <= {"intervention"}
    return [note.detail for note in step.records.notes]


def steer(isle: Island[Any], *interventions: Intervention, generations: int = 1, epochs: int = 1, arrivals: Any = ()):
    """Begin, take an epoch undisturbed, and then one with interventions."""
    state = isle.advance(isle.begin().state, 2, ()).state
    step = isle.advance(state, generations, arrivals, interventions)
    for _ in range(epochs - 1):
        step = isle.advance(step.state, generations, ())
    return state, step


def ids(deme: Any) -> list[int]:
    return [one.id for one in deme]


def text(ones: int, length: int = LENGTH) -> str:
    return json.dumps([1] * ones + [0] * (length - ones), separators=(",", ":"))


# -- goals -------------------------------------------------------------------------------------------------------------


def test_a_weight_scores_the_whole_deme_again_and_all_who_come_after() -> None:
    isle = island(fitness=GOALS)
    before, step = steer(isle, Intervention("weight", {"values": {"ones": 0.0}}))
    assert [(row.id, row.reason) for row in step.records.rescored] == [(i, "weights") for i in ids(before.deme)]
    for one in step.state.deme:
        assert one.fitness == dict(one.scores)["edges"] / 2
    for row in step.records.born:
        assert row.fitness == dict(row.scores)["edges"] / 2
    assert step.state.scoring != before.scoring
    assert step.state.steered == Steered(goals=(("ones", Goal(goal="maximise", weight=0.0)),))
    assert step.state.best == max(one.fitness for one in step.state.deme)
    assert step.records.generations[0].evaluations == 12 + 10
    after = isle.advance(step.state, 1, ())
    assert not after.records.rescored
    assert all(row.fitness == dict(row.scores)["edges"] / 2 for row in after.records.born)


def test_a_target_makes_its_criterion_a_target_of_the_same_weight() -> None:
    isle = island(fitness=GOALS)
    _, step = steer(
        isle, Intervention("target", {"values": {"edges": 2}}), Intervention("weight", {"values": {"ones": 0}})
    )
    assert dict(step.state.steered.goals)["edges"] == Goal(goal="target", value=2, weight=0.5)
    for one in step.state.deme:
        assert one.fitness == -0.5 * (abs(dict(one.scores)["edges"] - 2) / 3)
    assert len(step.records.rescored) == 12, "two interventions of one epoch score once"


def test_goals_as_they_are_score_nobody_again_and_changed_back_score_as_before() -> None:
    isle = island(fitness=GOALS)
    before, step = steer(isle, Intervention("weight", {"values": {"edges": 0.5}}))
    assert not step.records.rescored
    assert step.state.scoring == before.scoring
    _, step = steer(isle, Intervention("weight", {"values": {"edges": 3.0}}))
    back = isle.advance(step.state, 1, (), [Intervention("weight", {"values": {"edges": 0.5}})])
    assert len(back.records.rescored) == 12
    assert back.state.scoring == before.scoring


def test_migrants_between_islands_of_other_goals_are_scored_again() -> None:
    channel = Channel(0, "ring")
    one, other = (island(number, ring(2, channel), fitness=GOALS) for number in (0, 1))
    sent = steer(one, Intervention("weight", {"values": {"ones": 0.0}}))[1].departures[0]
    state = other.advance(other.advance(other.begin().state, 2, ()).state, 1, ()).state
    step = other.advance(state, 1, [sent])
    assert [(row.id, row.reason) for row in step.records.rescored] == [(sent.migrants[0].id, "migrant")]
    scores = dict(sent.migrants[0].scores)
    assert step.records.rescored[0].fitness == scores["ones"] + scores["edges"] / 2
    assert sent.migrants[0].fitness == scores["edges"] / 2


def test_islands_that_share_their_builder_share_steered_biologies() -> None:
    built: list[Any] = []

    def build(changed: Any) -> Any:
        built.append(dict(changed.fitness))
        return island(fitness=changed.fitness).biology

    plain = island(fitness=GOALS)
    isle = Island(plain.spec, plain.biology, 5, plain._routes, lambda: 0.0, lambda: None, None, build)
    steer(isle, Intervention("weight", {"values": {"ones": 2.0}}), epochs=3)
    assert built == [{**GOALS, "ones": {"goal": "maximise", "weight": 2.0, "scale": 1.0, "value": None}}]


# -- rates -------------------------------------------------------------------------------------------------------------


def test_rates_hold_from_that_epoch_on() -> None:
    isle = island()
    values = {"crossover": 1, "mutation": 0, "elite": 5, "tournament": 7}
    before, step = steer(isle, Intervention("rate", {"values": values}), generations=3, epochs=2)
    assert {row.origin for row in step.records.born} == {"crossover"}
    assert [row.evaluations for row in step.records.generations] == [7] * 3
    assert step.state.steered.rates == (("crossover", 1.0), ("elite", 5), ("mutation", 0.0), ("tournament", 7))
    assert step.state.scoring == before.scoring
    as_if = island(algorithm=Algorithm(crossover=1, mutation=0, elite=5, tournament=7))
    assert (
        without_clock(as_if.advance(before, 3, ()).records).born
        == without_clock(isle.advance(before, 3, (), [Intervention("rate", {"values": values})]).records).born
    )


def test_the_number_of_offspring_is_a_rate_of_plus() -> None:
    isle = island(algorithm=Algorithm(name="plus"))
    _, step = steer(isle, Intervention("rate", {"values": {"offspring": 3}}))
    assert len(step.records.born) == 3


# -- members -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "algorithm",
    [Algorithm(elite=1), Algorithm(elite=1, elitism="restore"), Algorithm(name="plus", crossover=0.0)],
    ids=lambda one: f"{one.name}-{one.elitism}",
)
def test_one_who_is_promoted_is_first_parent_elite_and_emigrant(algorithm) -> None:
    isle = island(0, ring(2, Channel(0, "ring")), algorithm=algorithm)
    state = isle.advance(isle.begin().state, 2, ()).state
    worst = ranked(state.deme)[-1]
    many = Intervention("rate", {"values": {"tournament": 1000}})
    step = isle.advance(state, 3, (), [Intervention("promote", {"id": worst.id}), many])
    assert {parent for row in step.records.born for parent in row.parents} == {worst.id}
    assert worst.id in ids(step.state.deme)
    assert ids(step.departures[0].migrants) == [worst.id]
    assert step.state.steered.promoted == (worst.id,)
    none = isle.advance(step.state, 3, (), [Intervention("promote", {})])
    assert none.state.steered.promoted == ()
    assert ids(none.departures[0].migrants) == [ranked(none.state.deme)[0].id]


def test_of_several_the_one_promoted_last_is_first() -> None:
    isle = island(algorithm=Algorithm(elite=2))
    state = isle.begin().state
    one, other = ids(ranked(state.deme))[-2:]
    promote = [Intervention("promote", {"id": identity}) for identity in (one, other, one)]
    step = isle.advance(state, 1, (), promote)
    assert step.state.steered.promoted == (one, other)
    assert ids(step.state.deme)[:2] == [one, other]


def test_one_promoted_who_dies_is_promoted_no_more() -> None:
    isle = island(algorithm=Algorithm(elite=0))
    state = isle.begin().state
    step = isle.advance(state, 1, (), [Intervention("promote", {"id": state.deme[0].id})])
    assert told(step)[0]["done"]
    assert step.state.steered == UNSTEERED


@pytest.mark.parametrize(
    "algorithm",
    [
        Algorithm(elite=3),
        Algorithm(elite=0),
        Algorithm(elite=1, elitism="restore"),
        Algorithm(elite=11),
        Algorithm(name="plus"),
        Algorithm(name="plus", offspring=1),
    ],
)
@pytest.mark.parametrize("count", [1, 5, 11, 12])
def test_who_is_locked_stays_and_the_deme_keeps_its_size(algorithm, count) -> None:
    edges = (*ring(2, Channel(0, "ring", count=4)), *ring(2, Channel(1, "away", count=4, move=True)))
    isle = island(0, edges, algorithm=algorithm)
    state = isle.begin().state
    locked = ids(ranked(state.deme))[-count:]
    came = tuple(Migrant(make_id(1, n), text(LENGTH), 24.0, (), "") for n in range(4))
    packet = Packet(0, 1, 0, 0, isle.biology.scoring, came)
    step = isle.advance(state, 3, [packet], [Intervention("lock", {"id": one}) for one in locked])
    assert set(locked) <= set(ids(step.state.deme))
    assert step.state.steered.locked == tuple(sorted(locked))
    gone = [one.id for one in step.departures[1].migrants]
    assert not set(gone) & set(locked)
    assert len(step.state.deme) + len(gone) == 12
    assert len(set(ids(step.state.deme))) == len(step.state.deme)
    if count == 12:
        assert not step.records.born
        assert [row.reason for row in step.records.crossings] == ["no place left"] * 4


def test_who_is_locked_breeds_and_lives_beside_the_elite() -> None:
    isle = island(algorithm=Algorithm(elite=2))
    state = isle.begin().state
    order = ids(ranked(state.deme))
    step = isle.advance(state, 1, (), [Intervention("lock", {"id": order[0]})])
    assert ids(step.state.deme)[:3] == order[:3], "the elite are the best of the others"
    assert len(step.records.born) == 12 - 3
    assert any(order[0] in row.parents for row in step.records.born)
    free = isle.advance(step.state, 1, (), [Intervention("unlock", {"id": order[0]})])
    assert free.state.steered == UNSTEERED
    assert len(free.records.born) == 10
    again = isle.advance(free.state, 1, (), [Intervention("unlock", {"id": free.state.deme[0].id})])
    assert told(again)[0]["detail"] == "not locked"


@pytest.mark.parametrize("algorithm", [Algorithm(elite=2), Algorithm(elitism="restore"), Algorithm(name="plus")])
def test_who_is_removed_is_gone_and_the_next_generation_fills_the_deme(algorithm) -> None:
    isle = island(algorithm=algorithm)
    state = isle.begin().state
    best = ranked(state.deme)[0].id
    lock = Intervention("lock", {"id": best})
    step = isle.advance(
        state, 1, (), [lock, Intervention("promote", {"id": best}), Intervention("remove", {"id": best})]
    )
    assert best not in ids(step.state.deme)
    assert best not in [parent for row in step.records.born for parent in row.parents]
    assert len(step.state.deme) == 12
    assert step.state.steered == UNSTEERED


def test_removing_everybody_settles_the_island_anew() -> None:
    isle = island()
    state = isle.begin().state
    step = isle.advance(state, 1, (), [Intervention("remove", {"id": one}) for one in ids(state.deme)])
    assert [row.origin for row in step.records.born] == ["random"] * 12


# -- insert ------------------------------------------------------------------------------------------------------------


def test_one_who_is_inserted_takes_the_worst_unlocked_place() -> None:
    isle = island(algorithm=Algorithm(elite=1))
    state = isle.begin().state
    order = ids(ranked(state.deme))
    lock, insert = Intervention("lock", {"id": order[-1]}), Intervention("insert", {"genotype": text(LENGTH)}, (), 7)
    step = isle.advance(state, 1, (), [insert, lock])
    row = step.records.born[0]
    assert (row.origin, row.parents, row.fitness, row.genotype) == ("intervention", (), 24.0, text(LENGTH))
    assert row.id == make_id(0, 12)
    assert (row.generation, row.epoch) == (0, 1)
    parents = {parent for row in step.records.born for parent in row.parents}
    assert order[-2] not in parents
    assert {order[-1], row.id} <= set(ids(step.state.deme))
    assert told(step)[1] == {"command": 7, "kind": "insert", "id": row.id, "done": True}
    assert step.state.counter == 12 + 1 + 10


def test_one_who_is_inserted_takes_a_free_place_first() -> None:
    isle = island(algorithm=Algorithm(elite=11))
    state = isle.begin().state
    gone = state.deme[3].id
    insert = Intervention("insert", {"genotype": text(LENGTH)})
    step = isle.advance(state, 1, (), [insert, Intervention("remove", {"id": gone})])
    left = [one for one in ids(ranked(state.deme)) if one != gone]
    assert set(ids(step.state.deme)[:11]) == {make_id(0, 12), *left[:10]}


def test_one_who_is_inserted_is_scored_by_the_goals_of_that_epoch() -> None:
    isle = island(fitness=GOALS)
    insert = Intervention("insert", {"genotype": text(LENGTH)})
    _, step = steer(isle, insert, Intervention("weight", {"values": {"ones": 2.0}}))
    assert step.records.born[0].fitness == 48.0
    assert step.records.born[0].id not in [row.id for row in step.records.rescored]


@pytest.mark.parametrize(
    ("genotype", "growth", "detail", "born"),
    [
        ("no list", {}, "genotype: JSONDecodeError: Expecting value: line 1 column 1 (char 0)", 0),
        (text(LENGTH), {"fail_ending": "1111"}, "invalid: growth: an ending that fails", 1),
    ],
)
def test_one_who_cannot_live_changes_nothing(genotype, growth, detail, born) -> None:
    isle = island(growth=growth)
    state = isle.begin().state
    step = isle.advance(state, 1, (), [Intervention("insert", {"genotype": genotype})])
    noted = [note.detail for note in step.records.notes if note.kind == "intervention"]
    assert [(one["done"], one["detail"]) for one in noted] == [(False, detail)]
    assert [row.origin for row in step.records.born].count("intervention") == born
    assert step.state.deme[:2] == tuple(ranked(state.deme)[:2])


def test_nobody_is_inserted_where_all_are_locked() -> None:
    isle = island()
    state = isle.begin().state
    lock = [Intervention("lock", {"id": one}) for one in ids(state.deme)]
    step = isle.advance(state, 1, (), [*lock, Intervention("insert", {"genotype": text(LENGTH)})])
    assert told(step)[-1]["detail"] == "no place left: all members are locked"
    assert step.state.deme == state.deme


# -- telling -----------------------------------------------------------------------------------------------------------


def test_each_island_tells_of_each_intervention() -> None:
    isle = island(3)
    begun = isle.begin()
    step = isle.advance(begun.state, 1, (), [Intervention("weight", {"values": {"ones": 2.0}}, (), 4)])
    (note,) = step.records.notes
    assert (note.epoch, note.kind) == (1, "intervention")
    assert note.detail == {"command": 4, "kind": "weight", "values": {"ones": 2.0}, "done": True}


@pytest.mark.parametrize("kind", ["promote", "lock", "unlock", "remove"])
def test_who_is_no_member_is_told_by_islands_named_and_by_the_one_that_bred_it(kind) -> None:
    isle = island(3)
    state = isle.begin().state
    mine, other = make_id(3, 999), make_id(2, 0)
    for identity, islands, is_told in ((mine, (), True), (other, (), False), (other, ("isle-3",), True)):
        step = isle.advance(state, 1, (), [Intervention(kind, {"id": identity}, islands)])
        assert [one["detail"] for one in told(step)] == ["no member here"] * is_told
        assert without_clock(step.records).born == without_clock(isle.advance(state, 1, ()).records).born
    assert not told(isle.advance(state, 1, (), [Intervention(kind, {"id": mine}, ("isle-2",))]))


def test_what_does_not_suit_an_island_is_told_and_changes_nothing() -> None:
    isle = island()
    state = isle.begin().state
    for one, part in (
        (Intervention("weight", {"values": {"onse": 1.0}}), "did you mean 'ones'?"),
        (Intervention("rate", {"values": {"elite": 12}}), "less than the population of 12"),
    ):
        step = isle.advance(state, 1, (), [one])
        assert part in told(step)[0]["detail"]
        assert step.state == isle.advance(state, 1, ()).state


# -- always ------------------------------------------------------------------------------------------------------------

ABOUT_ONE = ["promote", "lock", "unlock", "remove"]
some = st.one_of(
    st.builds(lambda v: Intervention("weight", {"values": {"ones": v}}), st.sampled_from([0.0, 1.0, 2.5])),
    st.builds(lambda v: Intervention("target", {"values": {"edges": v}}), st.integers(0, 5)),
    st.builds(lambda v: Intervention("rate", {"values": {"crossover": v, "elite": 1}}), st.sampled_from([0.0, 0.5])),
    st.builds(lambda k, n: Intervention(k, {"id": n}), st.sampled_from(ABOUT_ONE), st.integers(0, 30)),
    st.builds(lambda n: Intervention("insert", {"genotype": text(n)}), st.integers(0, LENGTH)),
    st.just(Intervention("promote", {})),
)  # fmt: skip


@settings(deadline=None)
@given(st.lists(st.lists(some, max_size=4), min_size=2, max_size=4))
def test_the_same_interventions_give_the_same_result_in_any_process(epochs) -> None:
    """A second island has its state read anew before each epoch, as one that goes on from a checkpoint has."""
    channel = Channel(0, "ring", count=2, move=True)
    one, other = (island(0, ring(2, channel), fitness=GOALS) for _ in range(2))
    step = again = one.begin()
    for interventions in epochs:
        step = one.advance(step.state, 2, (), interventions)
        read = Steered.from_json(json.loads(json.dumps(again.state.steered.to_json())))
        assert read == again.state.steered
        other = island(0, ring(2, channel), fitness=GOALS)
        sent = [Intervention.from_json(json.loads(json.dumps(item.to_json()))) for item in interventions]
        again = other.advance(again.state, 2, (), sent)
        assert again.state == step.state
        assert again.departures == step.departures
        assert without_clock(again.records) == without_clock(step.records)
        members = set(ids(step.state.deme))
        assert set(step.state.steered.locked) | set(step.state.steered.promoted) <= members
        assert len(members) + len(step.departures[0].migrants) == 12


def test_every_kind_is_tried_here() -> None:
    assert set(KINDS) == {"weight", "target", "rate", "strength", "promote", "lock", "unlock", "remove", "insert"}


def test_what_is_no_intervention_is_refused() -> None:
    for wrong in (None, [], {"kind": "weight"}, {**Intervention("lock", {"id": 1}).to_json(), "more": 1}):
        with pytest.raises(InputError):
            Intervention.from_json(wrong)
    for wrong in ({"goals": {"ones": {}}}, {"promoted": 3}, {"more": 1}, {"rates": []}, []):
        with pytest.raises(InputError):
            Steered.from_json(wrong)


def test_an_island_may_begin_in_a_later_epoch() -> None:
    channel = Channel(0, "ring")
    isle = island(1, ring(2, channel))
    begun = isle.begin(6)
    assert (begun.state.epoch, begun.state.generation, begun.state.counter) == (6, 0, 12)
    assert {row.epoch for row in (*begun.records.born, *begun.records.generations)} == {6}
    assert [packet.epoch for packet in begun.departures] == [6]
    assert begun.state.deme != isle.begin().state.deme
    assert isle.advance(begun.state, 1, ()).state.epoch == 7


def test_a_roulette_weighs_one_who_is_promoted_as_the_best() -> None:
    members = [Individual(1, (), 0.0, (), ""), Individual(2, (), 10.0, (), ""), Individual(3, (), 5.0, (), "")]
    crowd = Crowd(ranked(members, (1,)), island().biology, promoted=(1,))
    assert [one.id for one in crowd.order] == [1, 2, 3]
    channel = Channel(0, "wheel", select="roulette")
    drawn = Counter(crowd.order[emigrants(crowd, 1, channel, EpochStreams(9, 0, n))[0]].id for n in range(400))
    assert set(drawn) == {1, 2}, "the worst of the others weighs nothing"
    assert drawn[1] == pytest.approx(200, abs=40)


@pytest.mark.parametrize("replace", ["worst", "random", "oldest", "tournament", "similar"])
def test_no_migrant_is_better_than_one_who_is_promoted(replace) -> None:
    channel = Channel(0, "ring", replace=replace, accept="better")
    isle = island(0, ring(2, channel), population=1, algorithm=Algorithm(name="plus", crossover=0.0))
    state = isle.begin().state
    packet = Packet(0, 1, 0, 0, isle.biology.scoring, (Migrant(make_id(1, 0), text(LENGTH), 24.0, (), ""),))
    promoted = isle.advance(state, 1, [packet], [Intervention("promote", {"id": state.deme[0].id})])
    assert [row.reason for row in promoted.records.crossings] == ["not better"]
    assert ids(promoted.state.deme) == ids(state.deme)
    assert isle.advance(state, 1, [packet]).records.crossings[0].accepted
