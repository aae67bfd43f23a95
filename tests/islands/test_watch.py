"""Measures of coevolution's troubles: by hand, against a plain reference over whole histories, and in runs."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping

import pytest
from archipelagos import LENGTH, edge, island
from species import FriendKind

from islands.codec import read_state, state_text
from islands.context import Context
from islands.holdings import NOTHING, Holdings, Past
from islands.individual import Evaluation, Individual
from islands.migration.channel import Channel, Migrant, Packet, Pairing
from islands.pairings import Side, Sides
from islands.watch import TOLERANCE, Known, Watch, Watcher

WATCHED = Channel(0, "shown", "partners", pairing=Pairing("best", archive=3, measures=True))


class Table:
    """Scores texts against partners by a table."""

    scoring = "table"

    def __init__(self, rows: Mapping[str, Mapping[int, float | None]]) -> None:
        self.rows, self.asked = rows, []

    def encode(self, genotype: str) -> str:
        return genotype

    def decode(self, text: str) -> str:
        return text

    def evaluate_with(self, genotype: str, partners: tuple[Migrant, ...]) -> Evaluation:
        self.asked.append((genotype, *(one.id for one in partners)))
        values = [self.rows[genotype][one.id] for one in partners]
        return Evaluation(None if None in values else sum(values))


def shown(identity: int) -> Migrant:
    return Migrant(identity, f"text {identity}", 0.0, (), "")


def company(*sides: int) -> Sides:
    return Sides(tuple(Side(number, (shown(best),), 0) for number, best in enumerate(sides)), Pairing(), "key")


def past(*ids: int, channel: int = 0) -> Holdings:
    return NOTHING._replace(archives=(Past(channel, tuple(map(shown, ids))),))


def member(name: str, fitness: float | None = 1.0, number: int | None = None) -> Individual[str]:
    return Individual(ord(name) if number is None else number, name, fitness, (), "")


def look(table: Table, deme: list, held: Holdings, watches=(), watcher=None, now: Sides | None = None):
    watcher = watcher or Watcher([WATCHED], lambda: None)
    made = Context(table, now or company(9))  # type: ignore[arg-type]
    found, details = watcher.look(deme, made, held, watches)
    return found, details


TABLE = {"a": {1: 4.0, 2: 0.0, 3: 2.0}, "b": {1: 1.0, 2: 5.0, 3: 0.0}, "c": {1: -9.0, 2: None, 3: 3.0}}


def test_the_champion_is_scored_against_each_of_the_past_but_the_one_shown_now() -> None:
    deme = [member("b", 0.5), member("a", 2.0), member("c", None)]
    (watch,), (told,) = look(Table(TABLE), deme, past(9, 1, 2, 3))
    assert told == {
        "channel": "shown", "champion": ord("a"), "fitness": 2.0,
        "archive": {"mean": 2.0, "worst": 0.0, "number": 3, "invalid": 0, "each": [[1, 4.0], [2, 0.0], [3, 2.0]]},
        "forgetting": None, "distinct": 1.0, "spread": 0.75 / 1.25, "stalled": 0,
    }  # fmt: skip
    assert watch == Watch(0, (Known(ord("a"), "a"),), 0)


def test_invalid_scores_are_counted_and_the_mean_is_over_the_others() -> None:
    _, (told,) = look(Table(TABLE), [member("c")], past(1, 2, 3))
    assert told["archive"] == {
        "mean": -3.0, "worst": -9.0, "number": 3, "invalid": 1, "each": [[1, -9.0], [2, None], [3, 3.0]],
    }  # fmt: skip
    _, (told,) = look(Table(TABLE), [member("c")], past(2))
    assert (told["archive"]["mean"], told["archive"]["worst"], told["stalled"]) == (None, None, 0)


def test_forgetting_is_what_the_best_of_the_earlier_has_over_today_s() -> None:
    known = (Known(ord("b"), "b"), Known(ord("c"), "c"))
    # Against 1 and 2: a 2, b 3, c -9 (its valid one).
    (watch,), (told,) = look(Table(TABLE), [member("a")], past(1, 2), [Watch(0, known, 4)])
    assert told["forgetting"] == 1.0
    assert (told["stalled"], watch.stalled) == (5, 5)
    assert [one.text for one in watch.champions] == ["a", "b", "c"]
    # Against 1 alone: a 4, b 1, c -9.
    (watch,), (told,) = look(Table(TABLE), [member("a")], past(1), [Watch(0, known, 4)])
    assert (told["forgetting"], told["stalled"]) == (-3.0, 0)


def test_only_a_new_champion_that_is_better_by_more_than_the_tolerance_ends_a_standstill() -> None:
    record = 100.0
    for score, stalled in ((record * (1 + TOLERANCE), 3), (record * (1 + TOLERANCE) + 0.001, 0), (99.0, 3)):
        table = Table({"a": {1: score}, "b": {1: record}})
        _, (told,) = look(table, [member("a")], past(1), [Watch(0, (Known(ord("b"), "b"),), 2)])
        assert told["stalled"] == stalled, score
    # The champion of before is as good as it was.
    table = Table({"a": {1: 5.0}, "b": {1: 1.0}})
    known = (Known(ord("a"), "a"), Known(ord("b"), "b"))
    (watch,), (told,) = look(table, [member("a")], past(1), [Watch(0, known, 0)])
    assert (told["forgetting"], told["stalled"], watch.champions) == (-4.0, 1, known)
    # And so is one who comes back.
    (watch,), (told,) = look(table, [member("a")], past(1), [Watch(0, known[::-1], 0)])
    assert (told["stalled"], watch.champions) == (1, known)


def test_as_many_champions_are_known_as_the_archive_may_hold() -> None:
    known = tuple(Known(n, "b") for n in range(3))
    (watch,), _ = look(Table(TABLE), [member("a")], past(1), [Watch(0, known)])
    assert watch.champions == (Known(ord("a"), "a"), *known[:2])


def test_a_deme_without_a_valid_member_has_no_champion_and_forgets_none() -> None:
    known = (Known(ord("b"), "b"),)
    (watch,), (told,) = look(Table(TABLE), [member("a", None)], past(1, 2), [Watch(0, known, 4)])
    assert told["archive"] == {"mean": None, "worst": None, "number": 0, "invalid": 0, "each": []}
    assert [told[key] for key in ("champion", "fitness", "forgetting", "distinct", "spread")] == [None] * 5
    assert watch.champions == known


@pytest.mark.parametrize(
    ("fitness", "distinct", "spread"),
    [([2.0, 2.0, 2.0], 1 / 3, 0.0), ([1.0, 3.0], 1.0, 0.5), ([-1.0, -3.0, None], 1.0, 0.5), ([-1.0, 1.0], 1.0, None),
     ([0.0, 0.0], 0.5, 0.0), ([1.0, 1.0, 4.0], 2 / 3, math.sqrt(2) / 2)],
)  # fmt: skip
def test_disengagement_is_told_by_how_far_members_differ(fitness, distinct, spread) -> None:
    _, (told,) = look(Table(TABLE), [member("a", value, n) for n, value in enumerate(fitness)], past(1))
    assert told["distinct"] == pytest.approx(distinct, rel=1e-15)
    assert told["spread"] == (None if spread is None else pytest.approx(spread, rel=1e-15))


def test_beside_a_past_one_stand_the_best_that_other_channels_show() -> None:
    second = Channel(1, "others", "partners", pairing=Pairing("several", 2, archive=2, measures=True))
    plain = Channel(2, "plain", "partners", pairing=Pairing(archive=2))
    held = Holdings(archives=(Past(0, (shown(1), shown(2))), Past(1, (shown(3),)), Past(2, (shown(1),))))
    table = Table({"a": dict.fromkeys(range(10), 1.0)})
    watcher = Watcher([WATCHED, second, plain], lambda: None)
    watches, told = look(table, [member("a")], held, (), watcher, company(7, 8, 9))
    assert [one["channel"] for one in told] == ["shown", "others"]
    assert [one.channel for one in watches] == [0, 1]
    assert table.asked == [("a", 1, 8, 9), ("a", 2, 8, 9), ("a", 7, 3, 9)]


def test_only_who_is_new_is_scored_and_it_makes_no_difference() -> None:
    table, beats = Table(TABLE), []
    watcher = Watcher([WATCHED], lambda: beats.append(1))
    first, _ = look(table, [member("a")], past(1, 2), (), watcher)
    assert table.asked == [("a", 1), ("a", 2)]
    second, told = look(table, [member("b")], past(3, 1, 2), first, watcher)
    assert table.asked[2:] == [("b", 3), ("b", 1), ("b", 2), ("a", 3)]
    assert len(beats) == 6
    assert (second, told) == look(Table(TABLE), [member("b")], past(3, 1, 2), first)
    look(table, [member("b")], past(3, 1, 2), second, watcher)
    assert len(table.asked) == 6


def test_where_nothing_is_watched_or_nobody_has_come_nothing_is_told() -> None:
    table = Table(TABLE)
    plain = Watcher([Channel(0, "p", "partners", pairing=Pairing(archive=3))], lambda: None)
    assert look(table, [member("a")], past(1), (), plain) == ((), [])
    alone = Context(table)  # type: ignore[arg-type]
    assert Watcher([WATCHED], lambda: None).look([member("a")], alone, past(1), ()) == ((), [])
    assert look(table, [], past(1)) == ((), [])
    assert table.asked == []
    _, (told,) = look(table, [member("a")], past(9))
    assert (told["archive"]["number"], told["archive"]["mean"], told["stalled"]) == (0, None, 0)


def test_a_champion_that_cannot_be_read_counts_for_nothing() -> None:
    table = Table(TABLE)
    table.decode = lambda text: text if text != "b" else int(text)  # type: ignore[method-assign, return-value]
    _, (told,) = look(table, [member("a")], past(1), [Watch(0, (Known(ord("b"), "b"),), 0)])
    assert (told["forgetting"], told["archive"]["mean"]) == (None, 4.0)


# -- on an island ------------------------------------------------------------------------------------------------------


def partner(epoch: int) -> Migrant:
    ones = (epoch * 7) % 23 + 1
    return Migrant(70 + epoch, json.dumps([0] * (LENGTH - ones) + [1] * ones), 1.0, (), "")


def score(genotype, migrant: Migrant) -> float:
    """As the kind of the tests has it."""
    return float(sum(a & b for a, b in zip(genotype, json.loads(migrant.text), strict=True)))


def notes(step) -> list[dict]:
    return [note.detail for note in step.records.notes if note.kind == "coevolution"]


def test_a_history_is_as_a_plain_reference_has_it_and_goes_on_from_a_checkpoint_bit_for_bit() -> None:
    def isle():
        return island(1, (edge(WATCHED, 0, 1),), kind=FriendKind, population=6)

    whole = isle()
    state = whole.begin().state
    champions: list[tuple[int, tuple]] = []
    for epoch in range(9):
        packets = [Packet(0, 0, 1, epoch, "s", (partner(epoch),))]
        step = whole.advance(state, 2, packets)
        assert notes(isle().advance(read_state(state_text(state, None), state.deme)[0], 2, packets)) == notes(step)
        state = step.state
        (told,) = notes(step)
        archive = [partner(then) for then in range(epoch - 1, -1, -1)][:3]
        best = min(state.deme, key=lambda one: (-one.fitness, one.id))
        assert told["champion"] == best.id
        each = [[one.id, score(best.genotype, one)] for one in archive]
        assert told["archive"]["each"] == each
        earlier = [genes for identity, genes in champions if identity != best.id]
        means = [sum(score(genes, one) for one in archive) / len(archive) for genes in earlier if archive]
        mine = sum(value for _, value in each) / len(each) if each else None
        assert told["archive"]["mean"] == mine
        assert told["forgetting"] == (max(means) - mine if means else None)
        champions = [(best.id, best.genotype), *((n, genes) for n, genes in champions if n != best.id)][:3]
    assert state.watched[0].champions[0].id == best.id


def test_watching_changes_nothing_of_what_breeds() -> None:
    unwatched = Channel(0, "shown", "partners", pairing=Pairing("best", archive=3))
    found = []
    for channel in (WATCHED, unwatched):
        isle = island(1, (edge(channel, 0, 1),), kind=FriendKind)
        step = isle.advance(isle.begin().state, 3, [Packet(0, 0, 1, 0, "s", (partner(0),))])
        step = isle.advance(step.state, 3, [Packet(0, 0, 1, 1, "s", (partner(1),))])
        found.append((step.records, step.state))
    (seen, state), (unseen, other) = found
    assert seen.born == tuple(
        row._replace(growth_ms=mine.growth_ms, evaluation_ms=mine.evaluation_ms)
        for row, mine in zip(unseen.born, seen.born, strict=True)
    )
    assert [row._replace(wall_ms=0) for row in seen.generations] == [
        row._replace(wall_ms=0) for row in unseen.generations
    ]
    assert (len(seen.notes), len(unseen.notes)) == (1, 0)
    assert (state.deme, other.watched) == (other.deme, ())
