"""Partners: who is chosen by each scheme, what pairings make together, and when a deme is scored again."""

from __future__ import annotations

import json
from collections import Counter

import pytest
from archipelagos import LENGTH, edge, island
from scipy import stats
from species import FriendKind

from islands.holdings import Held, Holdings, Past, archived, pool, taken_in
from islands.individual import Evaluation
from islands.migration.channel import Channel, Migrant, Packet, Pairing
from islands.migration.routes import Redrawn
from islands.pairings import combined, sides_of
from islands.streams import EpochStreams

SCORES = [
    Evaluation(3.0, (("a", 1.0), ("b", 5.0)), "", 1.0, 2.0, (("odd", {}),)),
    Evaluation(None, (("a", 9.0),), "growth: broken", 1.0, 2.0),
    Evaluation(1.0, (("a", 4.0), ("b", 7.0)), "", 1.0, 2.0),
    Evaluation(3.0, (("a", 2.0),), "", 1.0, 2.0),
]


def shown(identity: int, fitness: float | None = 0.0, ones: int = 1) -> Migrant:
    return Migrant(identity, json.dumps([1] * ones + [0] * (LENGTH - ones)), fitness, (), "")


def partners(number: int = 0, **settings) -> Channel:
    return Channel(number, f"p{number}", "partners", pairing=Pairing(**settings))


# -- what pairings make together -----------------------------------------------------------------------------------


def test_the_mean_is_over_the_valid_pairings() -> None:
    whole = combined(SCORES, Pairing(score="mean"))
    assert whole.fitness == pytest.approx(7 / 3, rel=1e-15)
    assert dict(whole.scores) == {"a": pytest.approx(7 / 3, rel=1e-15), "b": 6.0}
    assert (whole.error, whole.growth_ms, whole.evaluation_ms, whole.notes) == ("", 4.0, 8.0, (("odd", {}),))


def test_the_best_and_the_worst_are_those_of_one_pairing_of_equals_the_first() -> None:
    best = combined(SCORES, Pairing(score="best"))
    assert (best.fitness, best.scores, best.error) == (3.0, SCORES[0].scores, "")
    worst = combined([SCORES[0], *SCORES[2:]], Pairing(score="worst"))
    assert (worst.fitness, worst.scores, worst.error) == (1.0, SCORES[2].scores, "")


def test_one_invalid_pairing_makes_the_worst_invalid_and_only_all_of_them_the_others() -> None:
    worst = combined(SCORES, Pairing(score="worst"))
    assert (worst.fitness, worst.error, worst.growth_ms) == (None, "growth: broken", 4.0)
    broken = [SCORES[1], Evaluation(None, error="other")]
    for score in ("mean", "best", "worst"):
        assert (combined(broken, Pairing(score=score)).fitness, combined(broken, Pairing(score=score)).error) == (
            None,
            "growth: broken",
        )
    assert combined(SCORES[1:2], Pairing()) == SCORES[1]


# -- who is chosen -------------------------------------------------------------------------------------------------


def held(*entries: Held, archives: tuple[Past, ...] = ()) -> Holdings:
    return Holdings(partners=entries, archives=archives)


def chosen(channel: Channel, holdings: Holdings, epoch: int = 1):
    found = sides_of([channel], holdings, EpochStreams(4, 1, epoch))
    (side,) = found.sides
    return [one.id for one in side.partners], side.drawn


POOL = held(Held(0, 1, (shown(5, 2.0), shown(6, None))), Held(0, 2, (shown(7, 9.0), shown(5, 2.0))))


def test_the_pool_is_what_all_sources_show_best_first_and_each_once() -> None:
    assert [one.id for one in pool(POOL, 0)] == [7, 5, 6]
    assert pool(POOL, 1) == ()


def test_schemes_without_draws() -> None:
    assert chosen(partners(), POOL) == ([7], 0)
    assert chosen(partners(scheme="several", count=2), POOL) == ([7, 5], 0)
    assert chosen(partners(scheme="several", count=9), POOL) == ([7, 5, 6], 0)
    assert chosen(Channel(0, "p", "partners"), POOL) == ([7], 0)
    assert chosen(partners(scheme="random", count=2), POOL) == ([7, 5, 6], 2)
    assert chosen(partners(scheme="random", count=5), POOL) == ([7, 5, 6], 3)


def test_of_an_archive_the_best_shown_and_others_drawn_for_each_epoch() -> None:
    channel = partners(scheme="archive", count=3, archive=9)
    full = held(*POOL.partners, archives=(Past(0, (shown(7), shown(1), shown(2), shown(3))), Past(1, (shown(8),))))
    found = Counter(tuple(chosen(channel, full, epoch)[0]) for epoch in range(3000))
    assert set(found) == {(7, 1, 2), (7, 1, 3), (7, 2, 3)}
    assert stats.chisquare(list(found.values())).pvalue > 1e-3
    short = held(*POOL.partners, archives=(Past(0, (shown(7), shown(1))),))
    assert chosen(channel, short) == ([7, 1], 0)
    # Who is shown now is no past one, but it is as it was shown before.
    assert chosen(channel, held(*POOL.partners, archives=(Past(0, (shown(7), shown(7, ones=2))),))) == ([7, 7], 0)
    least = partners(scheme="archive", count=3, archive=2)
    assert chosen(least, full) == ([7, 1, 2], 0)
    more = held(*POOL.partners, archives=(Past(0, tuple(shown(n) for n in (1, 2, 3))),))
    assert all(chosen(least, more, epoch)[0] == [7, 1, 2] for epoch in range(9))
    assert chosen(partners(scheme="archive", count=1, archive=9), full) == ([7], 0)


def test_mixed_takes_the_best_shown_others_shown_and_past_ones_drawn_for_each_epoch() -> None:
    channel = partners(scheme="mixed", count=4, archive=9)
    now = Held(0, 1, tuple(shown(n, 9.0 - n) for n in (1, 2, 3, 4)))
    full = held(now, archives=(Past(0, (shown(1), shown(11), shown(3), shown(12))), Past(1, (shown(99),))))
    # The odd one of the three is of those shown; 3 is shown now, as it was before, and is no past one.
    found = Counter(tuple(chosen(channel, full, epoch)[0]) for epoch in range(6000))
    assert set(found) == {(1, a, b, c) for a, b in ((2, 3), (2, 4), (3, 4)) for c in (11, 12)}
    assert stats.chisquare(list(found.values())).pvalue > 1e-3
    assert chosen(channel, full)[1] == 0
    # One that shows something else now than it did is a past one still.
    changed = held(now, archives=(Past(0, (shown(1), shown(3, ones=2))),))
    assert {tuple(chosen(channel, changed, epoch)[0])[3] for epoch in range(9)} == {3}


def test_mixed_fills_up_from_where_there_are_more() -> None:
    channel = partners(scheme="mixed", count=5, archive=3)
    now = Held(0, 1, tuple(shown(n, 9.0 - n) for n in (1, 2, 3)))
    past = tuple(shown(n) for n in (1, 11, 12, 13, 14))
    assert chosen(channel, held(now)) == ([1, 2, 3], 0)
    four = Held(0, 1, tuple(shown(n, 9.0 - n) for n in (1, 2, 3, 4)))
    assert chosen(partners(scheme="mixed", count=4, archive=3), held(four)) == ([1, 2, 3, 4], 0)
    assert chosen(channel, held(now, archives=(Past(0, past[:2]),))) == ([1, 2, 3, 11], 0)
    alone = Held(0, 1, (shown(1),))
    assert chosen(channel, held(alone, archives=(Past(0, past),))) == ([1, 11, 12, 13], 0)  # no more than the archive
    whole = {tuple(chosen(channel, held(now, archives=(Past(0, past),)), epoch)[0]) for epoch in range(99)}
    assert whole == {(1, 2, 3, a, b) for a, b in ((11, 12), (11, 13), (12, 13))}


def test_until_each_channel_has_shown_someone_there_are_no_pairings() -> None:
    assert sides_of([partners(0), partners(1)], POOL, EpochStreams(4, 1, 1)) is None
    assert sides_of([], POOL, EpochStreams(4, 1, 1)) is None
    assert sides_of([partners(0)], Holdings(), EpochStreams(4, 1, 1)) is None


def test_the_key_tells_who_matters_and_how_and_nothing_else() -> None:
    def key(channel, holdings=POOL):
        return sides_of([channel], holdings, EpochStreams(4, 1, 1)).key

    other = held(Held(0, 1, (shown(5, 2.0), shown(6, None))), Held(0, 2, (shown(7, 9.0), shown(8, 1.0))))
    turned = held(Held(0, 1, (shown(5, 10.0), shown(6, None), shown(7, 9.0))))
    assert key(partners()) == key(partners(), other) != key(partners(), turned)
    assert key(partners(scheme="random")) == key(partners(scheme="random"), turned)
    assert key(partners(scheme="random")) != key(partners(scheme="random"), other)
    assert key(partners(scheme="several", count=2)) != key(partners(scheme="several", count=3))
    assert key(partners(score="best")) != key(partners(score="worst"))


def test_the_key_tells_what_they_show_where_that_matters() -> None:
    def key(channel, ones, of=7):
        entries = [shown(one, value, ones if one == of else 1) for one, value in ((7, 9.0), (5, 2.0), (6, 1.0))]
        past = (Past(0, tuple(shown(n, ones=ones if n == of else 1) for n in (7, 1))),)
        return sides_of([channel], held(Held(0, 1, tuple(entries)), archives=past), EpochStreams(4, 1, 1)).key

    several, random = partners(scheme="several", count=2), partners(scheme="random", count=2)
    for channel in (partners(), several, random, partners(scheme="archive", count=2, archive=2)):
        assert key(channel, 1) != key(channel, 2)
        assert key(channel, 2) == key(channel, 2)
    assert key(several, 1, of=5) != key(several, 2, of=5)
    assert key(partners(), 1, of=5) == key(partners(), 2, of=5)
    assert key(several, 1, of=6) == key(several, 2, of=6)
    assert key(random, 1, of=6) != key(random, 2, of=6)
    archive = partners(scheme="archive", count=2, archive=2)
    assert key(archive, 1, of=1) != key(archive, 2, of=1)


def test_the_archive_takes_the_best_shown_of_an_epoch_and_forgets_the_oldest() -> None:
    channel, holdings = partners(archive=2), Holdings()
    # One more than two, since the newest is the present one.
    for best, past in [(4, (4,)), (5, (5, 4)), (4, (5, 4)), (6, (6, 5, 4)), (2, (2, 6, 5)), (4, (4, 2, 6))]:
        holdings = archived(holdings, channel, [shown(9, -1.0), shown(best, 1.0), shown(3, None)])
        assert [one.id for one in holdings.archives[0].travellers] == list(past)
    again = archived(holdings, channel, [shown(4, 1.0, ones=5)])
    assert [(one.id, one.text) for one in again.archives[0].travellers] == [
        (4, shown(4, ones=5).text), (4, shown(4).text), (2, shown(2).text),
    ]  # fmt: skip
    assert archived(again, channel, [shown(4, 7.0)]) is again
    assert archived(holdings, channel, []) is holdings
    assert archived(Holdings(), partners(), [shown(1)]) == Holdings()


# -- on an island --------------------------------------------------------------------------------------------------


def packet(*migrants: Migrant, channel: int = 0, source: int = 0, epoch: int = 0) -> Packet:
    return Packet(channel, source, 1, epoch, "theirs", migrants)


def friends(*channels: Channel, **changes):
    return island(1, tuple(edge(one, 0, 1) for one in channels), kind=FriendKind, **changes)


def ones(text_or_genes) -> list[int]:
    return json.loads(text_or_genes) if isinstance(text_or_genes, str) else list(text_or_genes)


def shared(member, ones_of_partner: int) -> float:
    return float(sum(ones(member)[:ones_of_partner]))


def test_a_deme_is_scored_with_the_partner_that_came_and_its_offspring_too() -> None:
    isle = friends(partners())
    begun = isle.begin()
    assert all(row.partners == () for row in begun.records.born)
    step = isle.advance(begun.state, 2, [packet(shown(70, 1.0, ones=9), shown(71, 5.0, ones=4))])
    assert [row.id for row in step.records.rescored] == [one.id for one in begun.state.deme]
    assert {(row.reason, row.partners, row.epoch, row.generation) for row in step.records.rescored} == {
        ("partners", (71,), 1, 0)
    }
    by_id = {one.id: one.genotype for one in begun.state.deme}
    assert all(row.fitness == shared(by_id[row.id], 4) for row in step.records.rescored)
    assert all((row.fitness, row.partners) == (shared(row.genotype, 4), (71,)) for row in step.records.born)
    assert [row.evaluations for row in step.records.generations] == [22, 10]
    assert [(row.id, row.kind, row.accepted, row.reason) for row in step.records.crossings] == [
        (70, "partners", True, ""),
        (71, "partners", True, ""),
    ]
    assert step.state.scoring.startswith(f"{isle.biology.scoring}+")


def test_nothing_is_scored_again_where_the_partners_that_matter_stay() -> None:
    isle = friends(partners())
    state = isle.advance(isle.begin().state, 1, [packet(shown(71, 5.0, ones=4))]).state
    silent = isle.advance(state, 1, [packet(epoch=1)])
    assert silent.records.rescored == silent.records.crossings == ()
    assert {row.partners for row in silent.records.born} == {(71,)}
    assert isle.advance(state, 1, ()).state == silent.state
    again = isle.advance(state, 1, [packet(shown(71, 6.0, ones=4), shown(70, 1.0), epoch=1)])
    assert again.records.rescored == ()
    assert [(row.id, row.accepted, row.reason) for row in again.records.crossings] == [
        (71, False, "already here"),
        (70, True, ""),
    ]
    better = isle.advance(state, 1, [packet(shown(71, 5.0, ones=4), shown(70, 9.0, ones=2), epoch=1)])
    assert {row.partners for row in better.records.rescored} == {(70,)}


def test_pairings_take_the_j_th_of_each_channel_cyclically_and_combine_as_the_first_says() -> None:
    isle = friends(partners(0, scheme="several", count=3, score="worst"), partners(1, scheme="several", count=2))
    begun = isle.begin()
    alone = isle.advance(begun.state, 1, [packet(shown(70, ones=4))])
    assert alone.records.rescored == ()
    packets = [
        packet(shown(70, 3.0, ones=4), shown(71, 2.0, ones=9), shown(72, 1.0, ones=2)),
        packet(shown(80, 3.0, ones=1), shown(81, 2.0, ones=20), channel=1),
    ]
    step = isle.advance(begun.state, 1, packets)
    assert {row.partners for row in step.records.rescored} == {(70, 80, 71, 81, 72, 80)}
    by_id = {one.id: one.genotype for one in begun.state.deme}
    for row in step.records.rescored:
        genes = by_id[row.id]
        expected = [shared(genes, a) + shared(genes, b) for a, b in ((4, 1), (9, 20), (2, 1))]
        assert row.fitness == min(expected)
        assert row.evaluation_ms == 9.0


def test_random_partners_are_drawn_for_each_member() -> None:
    isle = friends(partners(scheme="random", count=2))
    begun = isle.begin()
    step = isle.advance(begun.state, 40, [packet(*(shown(70 + n, float(n), ones=n + 1) for n in range(4)))])
    found = Counter(row.partners for row in (*step.records.rescored, *step.records.born))
    assert len(found) == 6
    assert all(pair[0] > pair[1] for pair in found)  # best first
    assert stats.chisquare(list(found.values())).pvalue > 1e-3
    for row in step.records.born:
        first, second = (shared(row.genotype, identity - 69) for identity in row.partners)
        assert row.fitness == (first + second) / 2
    # The same pool: those drawn for a member stay its partners.
    assert isle.advance(step.state, 1, ()).records.rescored == ()


def test_the_archive_is_paired_with_in_every_epoch_anew() -> None:
    isle = friends(partners(scheme="archive", count=4, archive=3))
    state, past = isle.begin().state, []
    for epoch in range(8):
        step = isle.advance(state, 1, [packet(shown(70 + epoch, 1.0, ones=epoch + 2), epoch=epoch)])
        (together,) = {row.partners for row in (*step.records.rescored, *step.records.born)}
        assert together[0] == 70 + epoch
        assert together[1:] == tuple(past[:-4:-1])
        past.append(70 + epoch)
        state = step.state
        assert [one.id for one in state.held.archives[0].travellers] == past[:-5:-1]


@pytest.mark.parametrize("pairing", [{}, {"scheme": "several", "count": 2}, {"scheme": "random", "count": 2}])
def test_a_deme_is_scored_again_when_the_same_partner_shows_something_else(pairing) -> None:
    isle = friends(partners(**pairing))
    before = isle.advance(isle.begin().state, 1, [packet(shown(71, 5.0, ones=4))]).state
    step = isle.advance(before, 1, [packet(shown(71, 5.0, ones=9), epoch=1)])
    assert [(row.id, row.partners) for row in step.records.rescored] == [(one.id, (71,)) for one in before.deme]
    by_id = {one.id: one.genotype for one in before.deme}
    assert all(row.fitness == shared(by_id[row.id], 9) for row in step.records.rescored)
    assert [(row.accepted, row.reason) for row in step.records.crossings] == [(True, "")]
    assert step.state.scoring != before.scoring


def test_what_one_showed_before_is_paired_with_from_the_archive() -> None:
    isle = friends(partners(scheme="archive", count=2, archive=1))
    state = isle.advance(isle.begin().state, 1, [packet(shown(71, 5.0, ones=4))]).state
    step = isle.advance(state, 1, [packet(shown(71, 5.0, ones=9), epoch=1)])
    assert {row.partners for row in step.records.born} == {(71, 71)}
    for row in step.records.born:
        assert row.fitness == (shared(row.genotype, 9) + shared(row.genotype, 4)) / 2


def test_an_invalid_pairing_is_a_value() -> None:
    isle = friends(partners(scheme="several", count=2, score="worst"))
    step = isle.advance(isle.begin().state, 1, [packet(shown(70, ones=3), shown(71, ones=0))])
    assert {(row.fitness, row.error) for row in step.records.born} == {(None, "growth: a partner without ones")}
    isle = friends(partners(scheme="several", count=2, score="mean"))
    step = isle.advance(isle.begin().state, 1, [packet(shown(70, ones=3), shown(71, ones=0))])
    assert all(row.fitness == shared(row.genotype, 3) for row in step.records.born)
    isle.biology.decode = None
    step = isle.advance(isle.begin().state, 1, [packet(shown(70, ones=3))])
    assert {row.error for row in step.records.born} == {"exception: TypeError: 'NoneType' object is not callable"}


def test_a_species_that_pairs_with_nobody_is_not_scored_again() -> None:
    isle = island(1, (edge(partners(), 0, 1),))
    step = isle.advance(isle.begin().state, 1, [packet(shown(70))])
    assert step.records.rescored == ()
    assert step.state.scoring == isle.biology.scoring
    assert [row.accepted for row in step.records.crossings] == [True]


def test_partners_are_held_when_a_drawn_edge_is_gone() -> None:
    members = tuple((n, f"isle-{n}") for n in range(6))
    isle = island(1, kind=FriendKind, redrawn=(Redrawn(partners(), members),))
    routes = isle._routes
    epoch = next(n for n in range(1, 99) if routes.incoming(1, n) and not routes.incoming(1, n + 1))
    source = routes.incoming(1, epoch)[0].source
    state = isle.begin().state
    for now in range(1, epoch + 1):
        state = isle.advance(state, 1, ()).state
        assert state.epoch == now
    step = isle.advance(state, 1, [packet(shown(70, ones=4), source=source, epoch=epoch)])
    after = isle.advance(step.state, 1, ())
    assert {row.partners for row in after.records.born} == {(70,)}


def test_migrants_of_another_context_are_scored_again_with_the_partners_here() -> None:
    isle = friends(partners(0), Channel(1, "m", count=2))
    begun = isle.begin()
    alone = Packet(1, 0, 1, 0, isle.biology.scoring, (shown(5, 20.0, ones=20),))
    step = isle.advance(begun.state, 1, [alone, packet(shown(70, ones=4))])
    row = step.records.rescored[-1]
    assert (row.id, row.reason, row.fitness, row.partners) == (5, "migrant", 4.0, (70,))
    assert len(step.records.rescored) == 13
    same = Packet(1, 0, 1, 0, step.state.scoring, (shown(5, 20.0, ones=20),))
    assert len(isle.advance(begun.state, 1, [same, packet(shown(70, ones=4))]).records.rescored) == 12


def test_once_all_are_scored_again_the_best_so_far_is_of_the_new_scores() -> None:
    isle = friends(partners())
    step = isle.advance(isle.begin().state, 1, [packet(shown(70, ones=2))])
    assert step.state.best == 2.0 < isle.begin().state.best
    assert step.state.stagnant in (0, 1)


def test_what_comes_twice_in_a_packet_is_held_once() -> None:
    one, two = shown(5, 1.0), shown(6, 1.0)
    holdings, reasons = taken_in(Holdings(), partners(), packet(one, one, two))
    assert reasons == ("", "already here", "")
    assert holdings.partners == (Held(0, 0, (one, two)),)
