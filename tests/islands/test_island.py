"""The pure island: breeding, records, and the promise that the same state and arrivals give the same result."""

from __future__ import annotations

import dataclasses
import math
from collections import Counter

import numpy as np
import pytest
from archipelagos import LENGTH, island, ring, spec, without_clock

from islands.individual import COUNTER_BITS, Individual, home_of, make_id
from islands.migration.channel import Channel, Migrant, Packet
from islands.migration.routes import Routes
from islands.selection import ranked
from islands.settings import Algorithm


def test_epoch_zero_is_the_first_population_scored() -> None:
    begun = island(3).begin()
    assert (begun.state.epoch, begun.state.generation, begun.state.counter) == (0, 0, 12)
    assert [row.id for row in begun.records.born] == [make_id(3, count) for count in range(12)]
    assert all(row.origin == "random" and row.parents == () for row in begun.records.born)
    assert all(
        row.fitness == sum(member.genotype) for row, member in zip(begun.records.born, begun.state.deme, strict=True)
    )
    assert [row.evaluations for row in begun.records.generations] == [12]
    assert home_of(begun.records.born[5].id) == 3
    assert begun.records.born[5].id & (2**COUNTER_BITS - 1) == 5


def test_every_generation_scores_exactly_the_population_without_its_elite() -> None:
    isle = island(algorithm=Algorithm(elite=3))
    state = isle.begin().state
    step = isle.advance(state, 4, ())
    assert [row.evaluations for row in step.records.generations] == [9] * 4
    assert [row.generation for row in step.records.generations] == [1, 2, 3, 4]
    assert Counter(row.generation for row in step.records.born) == {1: 9, 2: 9, 3: 9, 4: 9}
    assert len(step.state.deme) == 12
    assert step.state.counter == 12 + 36


def test_the_elite_lives_on_with_its_ids_and_the_best_never_falls() -> None:
    isle = island()
    step = isle.begin()
    best = -math.inf
    for _ in range(6):
        elite = [member.id for member in ranked(step.state.deme)[:2]]
        step = isle.advance(step.state, 1, ())
        assert elite == [member.id for member in step.state.deme[:2]]
        assert not set(elite) & {row.id for row in step.records.born}
        assert step.records.generations[-1].best >= best
        best = step.records.generations[-1].best
    assert best > 15


@pytest.mark.parametrize(
    ("crossover", "mutation", "origins"),
    [
        (1.0, 0.0, {"crossover"}),
        (0.0, 0.0, {"mutation"}),
        (0.0, 1.0, {"mutation"}),
        (1.0, 1.0, {"crossover+mutation"}),
    ],
)
def test_origins_and_parents_say_how_an_offspring_came_about(crossover, mutation, origins) -> None:
    isle = island(algorithm=Algorithm(elite=2, crossover=crossover, mutation=mutation))
    begun = isle.begin()
    step = isle.advance(begun.state, 1, ())
    ids = {member.id for member in begun.state.deme}
    assert {row.origin for row in step.records.born} == origins
    for row in step.records.born:
        assert set(row.parents) <= ids
        assert len(row.parents) == len(set(row.parents)) == (1 if origins == {"mutation"} else len(row.parents))
        assert 1 <= len(row.parents) <= 2
    if crossover:
        assert any(len(row.parents) == 2 for row in step.records.born)


def test_crossed_children_hold_their_parents_genes_alone() -> None:
    isle = island(algorithm=Algorithm(elite=0, crossover=1.0, mutation=0.0))
    begun = isle.begin()
    genotypes = {member.id: member.genotype for member in begun.state.deme}
    step = isle.advance(begun.state, 1, ())
    for row, member in zip(step.records.born, step.state.deme, strict=True):
        parents = [genotypes[identity] for identity in row.parents]
        assert all(gene in {parent[at] for parent in parents} for at, gene in enumerate(member.genotype))


def test_rates_of_crossover_and_mutation_are_the_settings() -> None:
    isle = island(population=2000, algorithm=Algorithm(elite=0, crossover=0.7, mutation=0.2))
    step = isle.advance(isle.begin().state, 1, ())
    share = {origin: count / 2000 for origin, count in Counter(row.origin for row in step.records.born).items()}
    assert share["mutation"] == pytest.approx(0.3, abs=0.05)
    assert share["crossover+mutation"] == pytest.approx(0.14, abs=0.03)
    assert share["crossover"] == pytest.approx(0.56, abs=0.05)


def test_an_odd_number_of_offspring_is_bred_exactly() -> None:
    isle = island(population=11)
    step = isle.advance(isle.begin().state, 2, ())
    assert [row.evaluations for row in step.records.generations] == [9, 9]
    assert len({row.id for row in step.records.born}) == 18


def test_what_an_odd_deme_draws_never_changes() -> None:
    """The offspring that is dropped has drawn, too: the figures are a part of recorded runs."""
    isle = island(population=11)
    deme = isle.advance(isle.begin().state, 3, ()).state.deme
    assert [member.fitness for member in deme] == [17, 16, 15, 15, 15, 17, 16, 16, 19, 14, 16]


def test_the_same_state_and_arrivals_give_the_same_result() -> None:
    channel = Channel(0, "ring", count=2)
    first, second = (island(1, ring(3, channel)) for _ in range(2))
    packet = Packet(
        0, 0, 1, 0, first.biology.scoring, (Migrant(7, "[" + "1," * 23 + "1]", 24.0, (("ones", 24.0),), ""),)
    )
    begun = first.begin()
    assert begun.state == second.begin().state
    a, b = first.advance(begun.state, 3, [packet]), second.advance(begun.state, 3, [packet])
    assert a.state == b.state
    assert a.departures == b.departures
    assert without_clock(a.records) == without_clock(b.records)
    other = island(1, ring(3, channel), seed=6)
    assert other.begin().state != begun.state


def test_an_epoch_is_independent_of_how_the_run_came_to_its_state() -> None:
    isle = island()
    state = isle.advance(isle.begin().state, 2, ()).state
    fresh = island()
    assert isle.advance(state, 2, ()).state == fresh.advance(state, 2, ()).state


def test_islands_draw_from_streams_of_their_own() -> None:
    one, two = island(0).begin(), island(1).begin()
    assert [m.genotype for m in one.state.deme] != [m.genotype for m in two.state.deme]


def test_generation_rows_hold_the_deme_s_figures() -> None:
    isle = island(growth={"fail_ending": "1"})
    step = isle.advance(isle.begin().state, 1, ())
    row = step.records.generations[-1]
    fitness = np.array([member.fitness for member in step.state.deme if member.fitness is not None])
    assert row.invalid == 12 - len(fitness) > 0
    assert (row.best, row.worst) == (fitness.max(), fitness.min())
    assert row.mean == pytest.approx(fitness.mean(), rel=1e-12)
    assert row.std == pytest.approx(fitness.std(), rel=1e-12)
    genomes = np.array([member.genotype for member in step.state.deme])
    pairs = [(genomes[i] != genomes[j]).mean() for i in range(12) for j in range(i)]
    assert row.diversity == pytest.approx(np.mean(pairs), rel=1e-12)
    assert row.wall_ms > 0


def test_a_deme_without_any_valid_member_has_no_figures_and_lives_on() -> None:
    isle = island(genome={"length": LENGTH, "rate": 0.0}, growth={"fail_ending": "0"})
    isle = island(growth={"raise_ending": ""}, fitness={"ones": {"goal": "maximise"}})
    dead = island(growth={"fail_ending": "0"})
    state = dataclasses.replace(
        dead.begin().state, deme=tuple(Individual(make_id(0, n), (0,) * LENGTH, None, (), "x") for n in range(12))
    )
    still = island(genome={"length": LENGTH, "rate": 0.0}, growth={"fail_ending": "0"})
    step = still.advance(state, 1, ())
    row = step.records.generations[-1]
    assert (row.best, row.mean, row.std, row.worst, row.invalid) == (None, None, None, None, 12)
    assert [member.id for member in step.state.deme[:2]] == [make_id(0, 0), make_id(0, 1)]
    assert isle.begin().records.generations[0].invalid == 0


def test_the_invalid_lose_to_every_valid_one_and_equals_go_by_id() -> None:
    deme = [
        Individual(4, (), None, (), "broken"),
        Individual(3, (), -1e300, (), ""),
        Individual(2, (), 5.0, (), ""),
        Individual(1, (), 5.0, (), ""),
        Individual(0, (), None, (), "broken"),
    ]
    assert [member.id for member in ranked(deme)] == [1, 2, 3, 0, 4]


def test_an_exception_makes_one_invalid_individual_with_its_reason() -> None:
    begun = island(growth={"raise_ending": "1"}).begin()
    broken = [row for row in begun.records.born if row.genotype.endswith("1]")]
    assert broken
    assert all(row.fitness is None and row.error.startswith("exception: ZeroDivisionError: ") for row in broken)
    assert begun.records.generations[0].invalid == len(broken)


def test_notes_of_a_scoring_become_events_with_the_id() -> None:
    begun = island(growth={"fail_ending": "1"}).begin()
    failed = [row.id for row in begun.records.born if row.error]
    assert [(note.kind, note.detail) for note in begun.records.notes] == [
        ("repair", {"id": identity, "labels": [1]}) for identity in failed
    ]


def test_a_fitness_that_is_not_finite_is_invalid(monkeypatch) -> None:
    isle = island()
    scored = isle.biology.evaluate((1,) * LENGTH)
    monkeypatch.setattr(isle.biology, "evaluate", lambda genotype: dataclasses.replace(scored, fitness=math.nan))
    begun = isle.begin()
    assert {row.fitness for row in begun.records.born} == {None}
    assert {row.error for row in begun.records.born} == {"evaluation: the fitness is nan"}


def test_a_pulse_that_raises_abandons_the_epoch() -> None:
    from bits import BitsKind

    from islands.island import Island

    def stop() -> None:
        raise InterruptedError

    isle = Island(spec(), BitsKind().build(spec(), lambda: 0.0), 5, Routes(()), lambda: 0.0, stop)
    with pytest.raises(InterruptedError):
        isle.begin()


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (SystemExit("enough"), "exception: SystemExit: enough"),
        (GeneratorExit(), "exception: GeneratorExit"),
        (ValueError("bad \udcff\n text"), "exception: ValueError: bad \\udcff text"),
        (ValueError("x" * 10**6), "exception: ValueError: xxx"),
    ],
)
def test_whatever_an_evaluation_raises_is_one_invalid_individual_with_a_line(monkeypatch, error, told) -> None:
    isle = island()

    def raises(genotype: object) -> None:
        raise error

    monkeypatch.setattr(isle.biology, "evaluate", raises)
    errors = {row.error for row in isle.begin().records.born}
    (text,) = errors
    assert text.startswith(told)
    assert len(text) <= 400
    assert text.encode().decode().isprintable()


def test_an_error_that_a_kind_gives_is_made_one_line_too(monkeypatch) -> None:
    isle = island()
    given = dataclasses.replace(isle.biology.evaluate((1,) * LENGTH), fitness=None, error="rules: a\nb \udcff")
    monkeypatch.setattr(isle.biology, "evaluate", lambda genotype: given)
    assert {row.error for row in isle.begin().records.born} == {"rules: a b \\udcff"}


def test_ctrl_c_in_an_evaluation_is_no_mishap(monkeypatch) -> None:
    isle = island()
    monkeypatch.setattr(isle.biology, "evaluate", lambda genotype: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        isle.begin()
