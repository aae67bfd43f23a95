"""The experiment file: what it may say, how defaults and overrides go in, and what each mistake is told."""

from __future__ import annotations

import copy

import pytest
from bits import pairs
from plugged import install

from experiments import bits, write
from genome.errors import InputError
from orchestrator.loading import load_experiment
from orchestrator.run import make_backend, prepare
from orchestrator.topology.registry import edges_of
from orchestrator.topology.ring import ring

SHEET = """
name: drape
seed: 7
epochs: 12              # epoch 0 is the first population
epoch: 5
schedule: barrier
hosts: auto
islands:
  north:
    kind: surface
    species: drapery
    count: 4
    population: 48
    genome: {grammar: genr8, length: 200}
    growth: {steps: 4, scale: 1.5, environment: sphere.env.yaml}
    fitness:
      size: {goal: target, value: 6, weight: 1}
      undulation: {goal: maximise, weight: 0.5, scale: 2}
    algorithm: {name: generational, elite: 2, selection: tournament, tournament: 3, crossover: 0.8, mutation: 0.1}
channels:
  - {kind: migrants, topology: ring, among: north, every: 1, count: 2, select: best, replace: worst}
log: {flush_generations: 25}
checkpoint: {every: 4, keep: 2}   # epochs
"""


def test_the_design_s_own_example_is_accepted_whole(tmp_path) -> None:
    path = tmp_path / "drape.yaml"
    path.write_text(SHEET, encoding="utf-8")
    (tmp_path / "sphere.env.yaml").write_text("gravity: [0, 0, -0.2]\n", encoding="utf-8")
    loaded = load_experiment(path)
    plan, _ = prepare(loaded)
    assert [spec.name for spec in plan.islands] == ["north-0", "north-1", "north-2", "north-3"]
    assert [(edge.source, edge.target) for edge in plan.edges] == [(0, 1), (1, 2), (2, 3), (3, 0)]
    assert {spec.species for spec in plan.islands} == {"drapery"}
    assert loaded.notes == ()


def test_resolved_data_resolve_to_themselves(tmp_path) -> None:
    loaded = load_experiment(write(tmp_path, bits()))
    again = load_experiment(write(tmp_path, loaded.data(), "again.yaml"))
    assert again.experiment == loaded.experiment
    assert again.data() == loaded.data()
    island = loaded.data()["islands"]["north"]
    assert island["algorithm"]["elite"] == 1
    assert island["genome"] == {"length": 32, "rate": 0.05}
    assert "defaults" not in loaded.data()


def test_defaults_merge_key_by_key_and_the_island_wins(tmp_path) -> None:
    data = bits()
    data["defaults"]["growth"] = {"delay_ms": 1.0, "fail_ending": "0"}
    data["islands"]["south"]["fitness"] = {"zeros": {"goal": "minimise"}}
    islands = load_experiment(write(tmp_path, data)).experiment.islands
    assert islands["north"].growth["delay_ms"] == 1.0
    assert islands["north"].growth["fail_ending"] == "1111"
    assert islands["south"].growth["fail_ending"] == "0"
    assert set(islands["south"].fitness) == {"ones", "zeros"}


@pytest.mark.parametrize(
    ("given", "override", "epochs"),
    [
        ({"epochs": 4}, (), 4),
        ({"generations": 7}, (), 3),
        ({"generations": 6}, (), 2),
        ({"generations": 0}, (), 0),
        ({}, (), 10),
        ({"epochs": 4}, ("generations=4",), 2),
        ({"generations": 9}, ("epochs=1",), 1),
        ({"epochs": 4}, ("generations=4", "epochs=9"), 9),
    ],
)
def test_generations_round_up_to_whole_epochs_and_overrides_take_their_place(tmp_path, given, override, epochs) -> None:
    data = {key: value for key, value in bits().items() if key != "epochs"}
    assert load_experiment(write(tmp_path, {**data, **given}), override).experiment.epochs == epochs


def test_the_name_is_the_file_s_unless_given(tmp_path) -> None:
    data = {key: value for key, value in bits().items() if key != "name"}
    assert load_experiment(write(tmp_path, data, "mine.yaml")).experiment.name == "mine"


def test_species_follow_kind_and_genome(tmp_path) -> None:
    data = bits()
    data["islands"]["south"]["genome"] = {"rate": 0.05}
    islands = load_experiment(write(tmp_path, data)).experiment.islands
    assert islands["north"].species == islands["south"].species
    data["islands"]["south"]["genome"] = {"length": 16}
    other = load_experiment(write(tmp_path, data)).experiment.islands["south"].species
    assert other.startswith("bits-")
    assert other != islands["north"].species


def broken(path: str, value: object) -> dict:
    data = copy.deepcopy(bits())
    here = data
    *parts, last = [int(part) if part.isdecimal() else part for part in path.split(".")]
    for part in parts:
        here = here[part]
    here[last] = value
    return data


MISTAKES = [
    ("epoch", 0, "bits.yaml:5: epoch: expected greater than or equal to 1, got 0"),
    ("epochs", "ten", "bits.yaml:4: epochs: expected a whole number, got 'ten'"),
    ("generations", 7, "expected either 'epochs' or 'generations', got both (epochs 4, generations 7)"),
    ("seeds", 7, "seeds: expected a known key, got 'seeds'; did you mean 'seed'?"),
    ("schedule", "sync", "schedule: expected 'barrier', 'dataflow' or 'async', got 'sync'"),
    ("hosts", 0, "hosts: expected 'auto' or a number of at least 1, got 0"),
    ("hosts", True, "hosts: expected 'auto' or a number of at least 1, got True"),
    ("islands", {}, "islands: expected"),
    ("islands.north.population", 0, "islands.north.population: expected greater than or equal to 1, got 0"),
    ("islands.north.kind", "times", "islands.north.kind: expected an island kind, got 'times'; did you mean 'timed'?"),
    ("islands.north.kind", "surfaces", "expected an island kind, got 'surfaces'; did you mean 'surface'?"),
    ("islands.north.kind", "bits:Nothing", "an island kind that can be imported, got 'bits:Nothing', which does not"),
    ("islands.north.kind", "nowhere.at.all:X", "'nowhere.at.all:X', which does not import (ModuleNotFoundError"),
    ("islands.north.kind", "bits:Bits Kind", "an island kind's name or an import path 'package.module:object'"),
    ("islands.north.kind", "bits:BitsGenome", "'bits:BitsGenome', a BitsGenome without name"),
    ("islands.north.genome", {"lenght": 4}, "genome.lenght: expected a known key, got 'lenght'; did you mean 'length'"),
    ("islands.north.growth", {"delay_ms": float("nan")}, "growth.delay_ms: expected a finite number, got nan"),
    ("islands.north.fitness", {"one": {"goal": "maximise"}}, "fitness.one: expected a criterion, got 'one'"),
    ("islands.north.fitness", {"ones": {"goal": "target"}}, "fitness.ones: expected a value for the goal 'target'"),
    ("islands.north.algorithm", {"elite": 12}, "algorithm.elite: expected less than the population of 12, got 12"),
    (
        "islands.north.algorithm",
        {"name": "parents", "parents": 13},
        "algorithm.parents: expected at most the population of 12, got 13",
    ),
    ("islands.north.algorithm", {"crossover": 1.5}, "algorithm.crossover: expected less than or equal to 1, got 1.5"),
    ("islands.north-1", {}, "islands.north-1: expected islands of different names, got 'north-1', a name that the"),
    ("islands.no rth", {}, "islands.no rth"),
    ("channels.0.topology", "tours", "channels.0.topology: expected a topology, got 'tours'; did you mean 'torus'?"),
    ("channels.0.topology", 4, "channels.0.topology: expected a topology's name, or its 'name' with parameters, got 4"),
    ("channels.0.topology", {"rows": 2}, "channels.0.topology: expected a topology's name, or its 'name' with par"),
    ("channels.0.topology", {"name": "torus", "row": 2}, "channels.0.topology.row: expected a known key, got 'row'"),
    ("channels.0.topology", "rnig", "channels.0.topology: expected a topology, got 'rnig'; did you mean 'ring'?"),
    ("channels.0.topology", "bits:CRITERIA", "expected a topology that can be called, got 'bits:CRITERIA', a tuple"),
    ("channels.0.kind", "parters", "channels.0.kind: expected 'migrants', 'partners', 'components' or 'surroundings'"),
    ("channels.0.kind", "partners", "channels.0: expected islands of which one gives partners that the other takes"),
    ("channels.0.among", "nort", "channels.0.among: expected an island of the experiment, got 'nort'; did you mean"),
    ("channels.0.among", ["north", 4], "channels.0.among: expected an island's name or a list of names, got"),
    ("channels.0.count", 10, "channels.0.count: expected at most a deme's members, got 10, more than the 9 members of"),
    ("channels.0.every", 0, "channels.0.every: expected greater than or equal to 1, got 0"),
    (
        "channels.0.select",
        "worst",
        "channels.0.select: expected 'best', 'tournament', 'random', 'roulette', 'diverse' or 'spread'",
    ),
    ("channels.1.to", "west", "channels.1.to: expected an island of the experiment, got 'west'"),
    ("channels.1.to", "south", "channels.1.to: expected two islands, got 'south' twice"),
    ("channels.1.to", [], "channels.1.to: expected an island or a group, got none; name one"),
    ("channels.1.to", None, "channels.1: expected both 'from' and 'to', got no 'to'"),
    ("channels.1.topology", "ring", "channels.1: expected 'from' and 'to', or 'topology' and 'among', got both"),
    ("channels.1.name", "migrants-0", "channels.1.name: expected a name of its own, got 'migrants-0', as channel 0"),
    ("islands.south.species", "others", "expected islands of one species, got north-2 (bits-"),
    ("defaults.populations", 4, "defaults.populations: expected a known key, got 'populations'; did you mean"),
    ("log", {"flush_generations": 0}, "log.flush_generations: expected greater than or equal to 1, got 0"),
]


@pytest.mark.parametrize(("path", "value", "message"), MISTAKES)
def test_each_mistake_is_one_clear_error(tmp_path, path, value, message) -> None:
    text = write(tmp_path, broken(path, value))
    if "nan" in str(value):  # JSON's NaN is not YAML's
        text.write_text(text.read_text(encoding="utf-8").replace("NaN", ".nan"), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        prepare(load_experiment(text))
    assert message in str(caught.value)
    assert str(caught.value).startswith(f"{text}:")


def test_an_island_named_twice_is_refused(tmp_path) -> None:
    path = tmp_path / "twice.yaml"
    path.write_text("islands:\n  north: {}\n  north: {}\n", encoding="utf-8")
    with pytest.raises(InputError, match="each key once, got 'north' again"):
        load_experiment(path)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        (
            "islands.nort.population=4",
            "--set islands.nort.population: expected an island of the experiment, got 'nort'",
        ),
        ("islands.north.populaton=4", "--set islands.north.populaton: expected a known key, got 'populaton'; did you"),
        ("islands.north.population=0", "--set islands.north.population: expected greater than or equal to 1, got 0"),
        ("channels.7.count=1", "--set channels.7.count: expected a number from 0 to 1, got '7'"),
        ("seed.x=1", "--set seed.x: expected a key with keys below it, got 'seed', which has none"),
        ("seed", "--set seed: expected key.path=value, got 'seed'"),
        ("=4", "expected key.path=value"),
        ("seed=[1", "--set seed"),
        ("seed=null", "--set seed: expected"),
        ("seed=1e400", "--set seed: expected"),
    ],
)
def test_a_wrong_override_is_told_as_such(tmp_path, override, message) -> None:
    with pytest.raises(InputError) as caught:
        prepare(load_experiment(write(tmp_path, bits()), [override]))
    assert message in str(caught.value)


def test_topologies_come_from_plug_ins_but_not_under_the_projects_names(tmp_path, monkeypatch) -> None:
    names = {"pairs": "bits:pairs", "ring": "bits:pairs", "stars": "bits:pairs"}
    install(tmp_path, monkeypatch, "atoll.topologies", **names)
    assert edges_of("ring", 4, "here") == ring(4)
    for name in ("pairs", "stars", "bits:pairs"):
        assert edges_of(name, 4, "here") == pairs(4)
    with pytest.raises(InputError, match="here: expected a topology, got 'pair'; did you mean 'pairs'"):
        edges_of("pair", 4, "here")


def test_overrides_reach_any_path(tmp_path) -> None:
    sets = ["islands.north.population=16", "channels.0.count=3", "defaults.algorithm={elite: 3}", "hosts=2"]
    experiment = load_experiment(write(tmp_path, bits()), sets).experiment
    assert experiment.islands["north"].population == 16
    assert experiment.channels[0].count == 3
    assert experiment.islands["south"].algorithm.elite == 3
    assert experiment.hosts == 2


def test_more_than_four_hosts_a_cpu_are_refused_before_anything_is_made(tmp_path) -> None:
    loaded = load_experiment(write(tmp_path, bits(backend="ray", hosts=100_000)))
    with pytest.raises(InputError, match=r"bits\.yaml:48: hosts: expected at most .* hosts on .*, got 100000"):
        make_backend(loaded, None)


def test_an_address_is_refused_by_the_backend_in_this_process(tmp_path) -> None:
    with pytest.raises(InputError, match="no address with backend: inline"):
        make_backend(load_experiment(write(tmp_path, bits())), "10.0.0.1:6379")


def test_only_an_elite_that_is_kept_has_to_be_smaller_than_the_deme(tmp_path) -> None:
    for algorithm in ({"name": "plus", "offspring": 1}, {"elitism": "restore"}):
        data = bits(channels=[])
        data["defaults"] |= {"population": 1, "algorithm": algorithm}
        del data["islands"]["south"]["population"]
        plan, _ = prepare(load_experiment(write(tmp_path, data)))
        assert [(spec.population, spec.algorithm.elite) for spec in plan.islands] == [(1, 1)] * 4
    data["defaults"]["algorithm"] = {"elitism": "keep"}
    with pytest.raises(InputError, match="less than the population of 1, got 1"):
        load_experiment(write(tmp_path, data))
