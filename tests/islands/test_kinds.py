"""One conformance suite for every island kind, and what is particular to surfaces."""

from __future__ import annotations

import json

import numpy as np
import pytest
from archipelagos import spec
from bits import BitsKind
from houses import SUPPLIED_HOUSE, SuppliedHouseKind
from plugged import install

from evaluators.registry import CRITERIA
from genome.errors import InputError
from islands.individual import Evaluation
from islands.kinds.block_pair import BlockPairKind
from islands.kinds.blocks import BlocksKind
from islands.kinds.enclosure import EnclosureKind
from islands.kinds.protocol import Biology, Kind
from islands.kinds.registry import KINDS, resolve_kind
from islands.kinds.room import RoomKind
from islands.kinds.route import RouteKind
from islands.kinds.space import SpaceKind
from islands.kinds.surface import SurfaceKind
from islands.kinds.timed import TimedKind

SURFACE = {
    "kind": "surface",
    "genome": {"length": 120},
    "growth": {"steps": 3, "environment": None},
    "fitness": {"size": {"goal": "target", "value": 6.0}, "undulation": {"goal": "maximise"}},
}
LOADED = {"growth": {"max_blocks": 80, "load": {"axial_strength": 90}}, "fitness": {"height": {"goal": "maximise"}}}
CELLS = {"genome": {}, "growth": {"max_blocks": 80}, "fitness": {"evenness": {"goal": "maximise"}}}
TIMED = {
    "kind": "timed",
    "genome": {"system": "flower", "numbers": {"FORK": [10, 60]}},
    "growth": {"time": 8.0, "samples": 3, "max_modules": 2000, "max_events": 20_000},
    "fitness": {"size": {"goal": "maximise"}},
}
EVERY = [
    (BitsKind, {}),
    (SurfaceKind, SURFACE),
    (BlocksKind, {"kind": "blocks", "genome": {}, **LOADED}),
    (BlockPairKind, {"kind": "block_pair", "genome": {}, **LOADED}),
    (EnclosureKind, {"kind": "enclosure", **CELLS}),
    (RouteKind, {"kind": "route", **CELLS}),
    (SpaceKind, {"kind": "space", **CELLS}),
    (RoomKind, {"kind": "room", "genome": {"cells": 9}, "growth": {}, "fitness": {"corners": {"goal": "minimise"}}}),
    (SuppliedHouseKind, SUPPLIED_HOUSE),
    (TimedKind, TIMED),
]


def resolved(kind, changes):
    """Give a spec with every default written out, as the orchestrator does."""
    made = spec(**changes)
    genome = kind.genome.model_validate(dict(made.genome)).model_dump(mode="json")
    growth = kind.growth.model_validate(dict(made.growth)).model_dump(mode="json")
    return spec(**{**changes, "genome": genome, "growth": growth})


def ticking():
    ticks = iter(range(10**9))
    return lambda: next(ticks) / 1e6


@pytest.fixture(params=EVERY, ids=[kind.name for kind, _ in EVERY])
def kind_and_spec(request):
    kind, changes = request.param
    return kind(), resolved(kind, changes)


@pytest.fixture
def biology(kind_and_spec):
    kind, made = kind_and_spec
    return kind.build(made, ticking())


def test_it_is_a_kind_with_a_biology(kind_and_spec, biology) -> None:
    assert isinstance(kind_and_spec[0], Kind)
    assert isinstance(biology, Biology)
    assert biology.seconds > 0


def some(biology, count=12, seed=1):
    rng = np.random.default_rng(seed)
    return [biology.random(rng) for _ in range(count)]


def test_genotypes_are_immutable_values_that_survive_their_encoding(biology) -> None:
    for genotype in some(biology):
        text = biology.encode(genotype)
        assert biology.decode(text) == genotype
        assert biology.encode(biology.decode(text)) == text
        assert isinstance(json.loads(text), list | dict)
        hash(genotype)


def test_the_same_stream_gives_the_same_genotypes(biology) -> None:
    assert some(biology, seed=3) == some(biology, seed=3)
    assert some(biology, seed=3) != some(biology, seed=4)
    first, second = some(biology, 2)
    for make in (
        lambda rng: biology.crossover(first, second, rng),
        lambda rng: biology.mutate(first, rng),
    ):
        assert make(np.random.default_rng(5)) == make(np.random.default_rng(5))


def test_variation_leaves_the_parents_and_the_global_stream_alone(biology) -> None:
    import random

    first, second = some(biology, 2)
    before = biology.encode(first), biology.encode(second), random.getstate(), str(np.random.get_state())  # noqa: NPY002
    rng = np.random.default_rng(5)
    biology.crossover(first, second, rng)
    biology.mutate(first, rng)
    after = biology.encode(first), biology.encode(second), random.getstate(), str(np.random.get_state())  # noqa: NPY002
    assert before == after


def test_mutation_and_crossover_change_something_in_the_long_run(biology) -> None:
    rng = np.random.default_rng(5)
    first, second = some(biology, 2)
    assert any(biology.mutate(first, rng) != first for _ in range(20))
    assert any(biology.crossover(first, second, rng)[0] not in (first, second) for _ in range(20))


def test_an_evaluation_is_a_function_of_the_genotype_alone(kind_and_spec, biology) -> None:
    kind, made = kind_and_spec
    other = kind.build(made, ticking())
    valid = 0
    for genotype in some(biology):
        once, again = biology.evaluate(genotype), other.evaluate(biology.decode(biology.encode(genotype)))
        assert isinstance(once, Evaluation)
        assert (once.fitness, once.scores, once.error, once.notes) == (
            again.fitness,
            again.scores,
            again.error,
            again.notes,
        )
        assert (once.fitness is None) == (once.error != "")
        assert once.growth_ms >= 0
        assert list(once.scores) == sorted(once.scores)
        if once.fitness is not None:
            valid += 1
            assert np.isfinite([once.fitness, *(value for _, value in once.scores)]).all()
            assert set(made.fitness) <= dict(once.scores).keys()
        json.dumps(once.notes, allow_nan=False)
    assert valid


def test_the_scoring_key_is_equal_exactly_when_islands_score_alike(kind_and_spec, biology) -> None:
    from dataclasses import replace

    kind, made = kind_and_spec
    assert kind.build(replace(made, name="x", number=4, population=3), ticking()).scoring == biology.scoring
    (name, goal), *rest = made.fitness.items()
    heavier = {name: {**goal, "weight": 3.0}, **dict(rest)}
    assert kind.build(replace(made, fitness=heavier), ticking()).scoring != biology.scoring


def test_diversity_runs_from_nought_to_one(biology) -> None:
    members = some(biology)
    assert biology.diversity(members[:1]) is None
    assert biology.diversity([members[0]] * 3) == 0
    assert 0 < biology.diversity(members) <= 1


def test_an_unknown_criterion_and_format_are_bad_input(kind_and_spec, biology, tmp_path) -> None:
    from dataclasses import replace

    kind, made = kind_and_spec
    with pytest.raises(InputError, match=r"islands\.isle\.fitness"):
        kind.build(replace(made, fitness={"nonsense": {"goal": "maximise"}}), ticking())
    with pytest.raises(InputError, match="--format"):
        biology.write_forms(some(biology, 1)[0], tmp_path / "x", ["doc"], {})


def test_forms_are_written_under_the_stem(biology, tmp_path) -> None:
    valid = [genotype for genotype in some(biology, 20) if biology.evaluate(genotype).fitness is not None]
    files = biology.write_forms(valid[0], tmp_path / "a.b-1", (), {"run": "test"})
    assert files
    assert all(path.is_file() and path.name.startswith(("a.b-1.", "a.b-1-part")) for path in files)


def test_kinds_are_found_by_name_by_import_path_and_by_entry_point(tmp_path, monkeypatch) -> None:
    assert isinstance(resolve_kind("bits:BitsKind", "here"), BitsKind)
    assert {resolve_kind(name, "here").name for name in KINDS} == set(KINDS)
    names = {
        "words": "bits:BitsKind",
        "surface": "bits:BitsKind",
        "extra": "bits:BitsKind [x]",
    }
    install(tmp_path, monkeypatch, "atoll.kinds", **names)
    assert {resolve_kind(name, "here").name for name in ("words", "extra")} == {"bits"}
    assert resolve_kind("surface", "here").name == "surface"
    known = sorted({*KINDS, "words", "extra"})
    with pytest.raises(InputError, match=f"an island kind, got 'sprawl'; known: {', '.join(known)}"):
        resolve_kind("sprawl", "here")


@pytest.fixture
def surfaces():
    return SurfaceKind().build(resolved(SurfaceKind, SURFACE), ticking())


def test_all_of_genr8_s_criteria_are_measured_goals_or_not(surfaces) -> None:
    scored = [surfaces.evaluate(genotype) for genotype in some(surfaces)]
    assert {tuple(dict(one.scores)) for one in scored if one.fitness is not None} == {tuple(sorted(CRITERIA))}


def test_fitness_is_the_sum_of_the_goals(surfaces) -> None:
    for genotype in some(surfaces):
        scored = surfaces.evaluate(genotype)
        if scored.fitness is not None:
            scores = dict(scored.scores)
            assert scored.fitness == pytest.approx(-abs(scores["size"] - 6) / 7 + scores["undulation"], abs=1e-12)


def test_repairs_are_told(surfaces) -> None:
    notes = [note for genotype in some(surfaces, 40) for note in surfaces.evaluate(genotype).notes]
    assert {kind for kind, _ in notes} == {"repair"}
    assert all(detail.keys() == {"labels"} and detail["labels"] for _, detail in notes)


def test_a_genome_that_maps_to_nothing_or_explodes_is_invalid_with_its_reason() -> None:
    strangled = resolved(SurfaceKind, {**SURFACE, "growth": {"steps": 6, "max_elements": 5}})
    biology = SurfaceKind().build(strangled, ticking())
    reasons = {biology.evaluate(genotype).error.split(":")[0] for genotype in some(biology, 20)}
    assert "budget" in reasons
    starved = resolved(SurfaceKind, {**SURFACE, "genome": {"length": 2, "wraps": 0}})
    biology = SurfaceKind().build(starved, ticking())
    assert {biology.evaluate(genotype).error.split(":")[0] for genotype in some(biology, 20)} >= {"mapping"}


def test_a_growth_that_the_clock_breaks_off_is_an_event() -> None:
    ticks = iter(range(10**9))
    made = resolved(SurfaceKind, {**SURFACE, "growth": {"steps": 3, "max_seconds": 0.5}})
    biology = SurfaceKind().build(made, lambda: float(next(ticks)))
    scored = biology.evaluate(some(biology, 1)[0])
    assert scored.fitness is None
    assert scored.error.startswith("clock: ")
    assert "clock" in dict(scored.notes)


def test_the_environment_may_be_a_file_or_keys_and_must_be_right(tmp_path) -> None:
    (tmp_path / "a.env.yaml").write_text("gravity: [0, 0, -1]\n", encoding="utf-8")
    keys = {"steps": 2, "environment": {"gravity": [0, 0, -1]}}
    by_file = resolved(SurfaceKind, {**SURFACE, "growth": {**keys, "environment": "a.env.yaml"}, "base": str(tmp_path)})
    by_keys = resolved(SurfaceKind, {**SURFACE, "growth": keys})
    empty = resolved(SurfaceKind, {**SURFACE, "growth": {"steps": 2}})
    scorings = [SurfaceKind().build(made, ticking()).scoring for made in (by_file, by_keys, empty)]
    assert scorings[0] == scorings[1] != scorings[2]
    for wrong in ("none.env.yaml", {"gravity": [0, 0]}, {"gravityy": [0, 0, 1]}):
        made = resolved(SurfaceKind, {**SURFACE, "growth": {"environment": wrong}, "base": str(tmp_path)})
        with pytest.raises(InputError):
            SurfaceKind().build(made, ticking())
