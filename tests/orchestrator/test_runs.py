"""Whole runs in this process: the folder, the log and its inner agreement, and what is left when one fails."""

from __future__ import annotations

import json
from collections import Counter, defaultdict

import duckdb
import pandas as pd
import polars as pl
import pyarrow.dataset as ds
import pytest

from experiments import Silent, bits, run, write
from genome.errors import InputError
from islands.individual import home_of
from islands.schemas import columns
from orchestrator.backends.protocol import RunFailedError
from orchestrator.digest import digest
from orchestrator.folder import open_run
from orchestrator.loading import load_experiment
from orchestrator.query import ask
from orchestrator.regrow import Nursery, best, by_id, same
from orchestrator.run import make_backend, run_experiment
from orchestrator.standing import standing

ISLANDS = ["north-0", "north-1", "north-2", "south"]


@pytest.fixture(scope="module")
def outcome(tmp_path_factory):
    return run(tmp_path_factory.mktemp("whole"))


def rows(outcome, table: str) -> list[dict]:
    return ds.dataset(outcome.folder / "log" / table).to_table().to_pylist()


def test_the_outcome_says_what_the_log_says(outcome) -> None:
    assert (outcome.status, outcome.islands, outcome.generations) == ("finished", 4, 12)
    log = outcome.folder / "log"
    ((bred,),) = ask(log, "select count(*) from individuals").rows
    ((again,),) = ask(log, "select count(*) from evaluations").rows
    ((counted,),) = ask(log, "select sum(evaluations)::int from generations").rows
    assert outcome.evaluations == bred + again == counted
    assert bred == 45 + 12 * (3 * 11 + 8)
    ((best,),) = ask(log, "select max(fitness) from individuals").rows
    assert outcome.best["fitness"] == best


def test_the_best_is_the_best_ever_bred_also_where_no_elite_keeps_it(tmp_path) -> None:
    data = bits(channels=[{"topology": "ring", "count": 1}])
    data["defaults"]["algorithm"] = {"elite": 0, "tournament": 1, "mutation": 1.0}
    outcome = run(tmp_path, data)
    bred = [row for row in rows(outcome, "individuals") if row["valid"]]
    best = min(bred, key=lambda row: (-row["fitness"], row["id"]))
    assert outcome.best == {key: best[key] for key in ("island", "id", "fitness")}
    assert best["epoch"] < 4  # it was bred before the last epoch
    last = [row["best"] for row in rows(outcome, "generations") if row["generation"] == 12]
    assert max(last) < best["fitness"]  # and it is lost
    folder = open_run(str(outcome.folder))
    assert standing(folder)["best"] == folder.manifest()["best"] == outcome.best


def test_the_folder_is_as_the_interface_has_it(outcome) -> None:
    folder = outcome.folder
    names = [".lock", "checkpoints", "experiment.yaml", "forms", "log", "manifest.json"]
    assert sorted(path.name for path in folder.iterdir()) == names
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    assert manifest["run"] == "bits"
    assert manifest["status"] == "finished"
    assert manifest["seed"] == 7
    assert {"versions", "started", "ended", "schema"} <= manifest.keys()
    forms = sorted(path.name for path in (folder / "forms").iterdir())
    assert forms == [f"{island}-best{rank}.txt" for island in ISLANDS for rank in (1, 2, 3)]
    best = max(rows(outcome, "generations"), key=lambda row: (row["generation"], row["best"]))
    assert (folder / "forms" / f"{best['island']}-best1.txt").read_text(encoding="utf-8").count("1") >= best["best"] - 1


def test_every_individual_is_there_once_and_its_parents_come_before_it(outcome) -> None:
    individuals = rows(outcome, "individuals")
    found = {row["id"]: row for row in individuals}
    assert len(found) == len(individuals)
    numbers = {name: number for number, name in enumerate(ISLANDS)}
    for row in individuals:
        assert home_of(row["id"]) == numbers[row["island"]]
        assert (row["origin"] == "random") == (row["parents"] == []) == (row["generation"] == 0)
        assert (row["fitness"] is not None) == row["valid"] == (row["error"] == "")
        for parent in row["parents"]:
            assert found[parent]["generation"] < row["generation"]
    foreign = [row for row in individuals if any(home_of(p) != home_of(row["id"]) for p in row["parents"])]
    assert foreign
    moved: dict = {}  # one that was replaced can come again: its first arrival counts
    for row in rows(outcome, "migrations"):
        if row["accepted"]:
            moved.setdefault((row["id"], row["target"]), row["epoch"])
    for row in foreign:
        for parent in row["parents"]:
            if home_of(parent) != home_of(row["id"]):
                assert moved[parent, row["island"]] <= row["epoch"]


def test_ids_count_up_without_gaps_on_each_island(outcome) -> None:
    counts = defaultdict(list)
    for row in rows(outcome, "individuals"):
        counts[home_of(row["id"])].append(row["id"] & (2**40 - 1))
    for ids in counts.values():
        assert sorted(ids) == list(range(len(ids)))


def test_migrations_agree_with_both_ends(outcome) -> None:
    individuals = {row["id"]: row for row in rows(outcome, "individuals")}
    again = {(row["id"], row["island"], row["epoch"]) for row in rows(outcome, "evaluations")}
    migrations = rows(outcome, "migrations")
    sent = Counter((row["channel"], row["epoch"]) for row in migrations)
    # Channel 0: a ring of four, two migrants an edge; epoch 1's arrivals left at the end of epoch 0, which sends none.
    assert sent == {("migrants-0", 2): 8, ("migrants-0", 3): 8, ("migrants-0", 4): 8, ("migrants-1", 3): 1}
    for row in migrations:
        assert row["island"] == row["target"]
        assert individuals[row["id"]]["epoch"] < row["epoch"]
        assert row["accepted"] == (row["reason"] == "")
        crosses = "south" in (row["source"], row["target"])
        if row["accepted"]:
            assert ((row["id"], row["target"], row["epoch"]) in again) == crosses
    assert {row["reason"] for row in rows(outcome, "evaluations")} == {"migrant"}


def test_generations_agree_with_individuals(outcome) -> None:
    bred = Counter((row["island"], row["generation"]) for row in rows(outcome, "individuals"))
    for row in rows(outcome, "generations"):
        size = 9 if row["island"] == "south" else 12
        if row["generation"] == 0:
            assert bred[row["island"], 0] == row["evaluations"] == size
        else:
            assert bred[row["island"], row["generation"]] == size - 1 <= row["evaluations"]
        assert row["epoch"] == -(-row["generation"] // 3)
        assert 0 <= row["diversity"] <= 1
    assert {row["island"] for row in rows(outcome, "generations")} == set(ISLANDS)


def test_events_tell_of_start_end_and_repairs(outcome) -> None:
    events = rows(outcome, "events")
    assert [row["kind"] for row in events if row["island"] is None] == ["start", "finish"]
    repaired = [json.loads(row["detail"])["id"] for row in events if row["kind"] == "repair"]
    failed = [row["id"] for row in rows(outcome, "individuals") if row["error"] and row["island"] != "south"]
    assert set(failed) <= set(repaired)


def test_four_readers_give_the_same_totals_with_a_plain_glob(outcome) -> None:
    for table, value in (
        ("individuals", "fitness"),
        ("evaluations", "fitness"),
        ("generations", "mean"),
        ("migrations", "fitness"),
        ("events", "epoch"),
    ):
        folder = outcome.folder / "log" / table
        glob = str(folder / "*.parquet")
        connection = duckdb.connect()
        count, total = connection.execute(f"select count(*), sum({value}) from '{glob}'").fetchall()[0]
        lazy, frame = pl.read_parquet(glob), pd.concat([pd.read_parquet(path) for path in folder.glob("*.parquet")])
        whole = ds.dataset(folder).to_table().to_pandas()
        assert len({count, lazy.height, len(frame), len(whole)}) == 1
        for other in (lazy[value].sum(), frame[value].sum(), whole[value].sum()):
            assert other == pytest.approx(total, rel=1e-12)


def test_a_table_that_nothing_came_into_is_there_too(tmp_path) -> None:
    alike = bits()
    alike["islands"] = {"one": next(iter(alike["islands"].values()))}
    alike["channels"] = []
    log = run(tmp_path, alike).folder / "log"
    for table in ("evaluations", "migrations"):
        glob = str(log / table / "*.parquet")
        assert duckdb.sql(f"select count(*) from '{glob}'").fetchall() == [(0,)]
        assert pl.read_parquet(glob).height == len(pd.read_parquet(log / table)) == 0
        assert ds.dataset(log / table).schema.names == list(columns(table))


def test_the_same_run_twice_has_the_same_digest_and_another_seed_another(outcome, tmp_path) -> None:
    first = digest(outcome.folder / "log")
    assert digest(run(tmp_path, name="other-name").folder / "log") == first
    assert digest(run(tmp_path, bits(seed=8)).folder / "log") != first
    flushed_otherwise = run(tmp_path, bits(log={"flush_generations": 1}), name="flushed")
    assert digest(flushed_otherwise.folder / "log") == first


def test_the_resolved_experiment_runs_to_the_same_digest(outcome, tmp_path) -> None:
    loaded = load_experiment(outcome.folder / "experiment.yaml")
    again = run_experiment(loaded, make_backend(loaded, None), tmp_path, "again", Silent())
    assert digest(again.folder / "log") == digest(outcome.folder / "log")
    first = (outcome.folder / "experiment.yaml").read_text(encoding="utf-8")
    assert (again.folder / "experiment.yaml").read_text(encoding="utf-8") == first.replace(
        "name: bits", "name: again", 1
    )


def test_a_digest_sees_every_column_but_clocks_and_the_run_s_name(outcome, tmp_path) -> None:
    import shutil

    import pyarrow as pa
    import pyarrow.parquet as pq

    before = digest(outcome.folder / "log")
    for table in ("individuals", "evaluations", "generations", "migrations"):
        source = outcome.folder / "log" / table
        for column in pq.read_schema(next(source.glob("*.parquet"))).names:
            copied = tmp_path / f"{table}-{column}"
            shutil.copytree(outcome.folder / "log", copied)
            path = min((copied / table).glob("*.parquet"))
            data = pq.read_table(path)
            values = data[column].to_pylist()
            values[0] = {
                str: "changed", int: 99, float: 99.5, bool: not values[0], list: [], type(None): None,
            }[type(values[0])]  # fmt: skip
            if data[column].to_pylist()[0] == values[0]:
                continue  # an empty list cannot be told apart from what it was
            changed = data.set_column(data.schema.get_field_index(column), column, pa.array(values, data[column].type))
            pq.write_table(changed, path)
            clocked = column == "run" or column.endswith("_ms")
            assert (digest(copied) == before) == clocked, (table, column)


def test_logged_individuals_replay_bit_for_bit(outcome) -> None:
    folder = open_run(str(outcome.folder))
    nursery = Nursery(folder)
    ids = [row["id"] for row in rows(outcome, "individuals")][::40]
    for logged in by_id(folder, ids):
        assert same(logged, nursery.score(logged))
    (logged,) = by_id(folder, [ids[0]])
    from dataclasses import replace

    assert not same(replace(logged, fitness=-1.0), nursery.score(logged))


def test_names_are_numbered_by_default_and_refused_when_asked_for(tmp_path) -> None:
    small = bits(epochs=0)
    assert [run(tmp_path, small).folder.name for _ in range(3)] == ["bits", "bits-2", "bits-3"]
    with pytest.raises(InputError, match="--name bits-2: expected a name that is free"):
        run(tmp_path, small, name="bits-2")


def test_a_failed_start_leaves_no_folder(tmp_path, monkeypatch) -> None:
    for data in (bits(epochs=-1), bits(channels=[{"topology": "stars"}])):
        with pytest.raises(InputError):
            run(tmp_path, data)
    from islands.host import Host

    monkeypatch.setattr(Host, "ready", lambda self: (_ for _ in ()).throw(InputError("here", "a", "b")))
    with pytest.raises(RunFailedError, match="here: expected a, got b"):
        run(tmp_path, bits())
    assert not (tmp_path / "runs").exists() or not list((tmp_path / "runs").iterdir())


def test_a_folder_that_cannot_be_written_is_bad_input(tmp_path) -> None:
    (tmp_path / "runs").write_text("a file", encoding="utf-8")
    with pytest.raises(InputError, match="--runs-dir: expected a folder that a run can be written to"):
        run(tmp_path)


def test_a_failure_later_keeps_what_was_logged(tmp_path, monkeypatch) -> None:
    from islands.host import Host

    real = Host._take_turn

    def failing(self, number, epoch):
        if epoch == 3:
            raise OSError(28, "No space left on device")
        return real(self, number, epoch)

    monkeypatch.setattr(Host, "_take_turn", failing)
    outcome = run(tmp_path)
    assert outcome.status == "failed"
    assert "No space left on device" in outcome.reason
    manifest = json.loads((outcome.folder / "manifest.json").read_text(encoding="utf-8"))
    assert (manifest["status"], manifest["error"]) == ("failed", outcome.reason)
    assert {row["epoch"] for row in rows(outcome, "generations")} == {0, 1, 2}
    assert "failure" in {row["kind"] for row in rows(outcome, "events")}


def test_a_stop_in_mid_run_keeps_whole_epochs(tmp_path, monkeypatch) -> None:
    from islands.host import Host

    real = Host._take_turn

    def stopping(self, number, epoch):
        if epoch == 2:
            self.stop()
        return real(self, number, epoch)

    monkeypatch.setattr(Host, "_take_turn", stopping)
    outcome = run(tmp_path)
    assert (outcome.status, outcome.generations) == ("stopped", 3)
    assert {row["generation"] for row in rows(outcome, "generations")} == {0, 1, 2, 3}
    assert list((outcome.folder / "forms").iterdir())


def test_a_run_of_the_first_population_alone(tmp_path) -> None:
    outcome = run(tmp_path, bits(epochs=0))
    assert (outcome.generations, outcome.evaluations) == (0, 45)


def test_a_run_in_which_all_are_invalid_finishes(tmp_path) -> None:
    data = bits()
    data["defaults"]["growth"] = {"raise_ending": ""}
    data["islands"] = {"only": {"count": 2, "growth": {"fail_ending": "0"}, "genome": {"length": 2, "rate": 0.0}}}
    data["channels"] = [{"topology": "ring", "count": 3}]
    outcome = run(tmp_path, data, "islands.only.population=4", "seed=3")
    assert outcome.status == "finished"


def test_inputs_are_kept_with_the_run(tmp_path) -> None:
    """A surface island's environment and meshes are copied, so that a replay outlives the originals."""
    pytest.importorskip("islands.kinds.surface")
    import trimesh

    trimesh.creation.icosphere(subdivisions=1).export(tmp_path / "ball.stl")
    (tmp_path / "site.env.yaml").write_text(
        "gravity: [0, 0, -0.1]\nboundaries:\n  - {mesh: ball.stl, at: [0, 0, -3], solid: inside}\n", encoding="utf-8"
    )
    data = {
        "name": "kept", "epochs": 1, "epoch": 1, "backend": "inline",
        "islands": {
            "file": {"kind": "surface", "population": 3, "growth": {"steps": 1, "environment": "site.env.yaml"},
                     "fitness": {"size": {"goal": "maximise"}}},
            "keys": {"kind": "surface", "population": 3, "fitness": {"size": {"goal": "maximise"}},
                     "growth": {"steps": 1, "environment": {"boundaries": [
                         {"mesh": "ball.stl", "at": [0, 0, -3], "solid": "inside"}]}}},
        },
    }  # fmt: skip
    outcome = run(tmp_path, data)
    (tmp_path / "ball.stl").unlink()
    (tmp_path / "site.env.yaml").unlink()
    folder = open_run(str(outcome.folder))
    kept = sorted(path.name for path in (outcome.folder / "environment").iterdir())
    assert kept == ["ball.stl", "site.env.yaml"]
    nursery = Nursery(folder)
    for logged in by_id(folder, [row["id"] for row in rows(outcome, "individuals")]):
        assert same(logged, nursery.score(logged))
    assert {path.suffix for path in (outcome.folder / "forms").iterdir()} <= {".glb", ".hemls"}
    write(tmp_path, data)


def test_forms_of_an_island_are_different_ones(tmp_path) -> None:
    """A converged deme holds one form many times: as many genotypes, or one."""
    data = bits(epochs=12, forms={"best": 6}, channels=[])
    folder = run(tmp_path, data).folder
    for island in ("north-0", "north-1", "north-2", "south"):
        words = [path.read_text() for path in sorted((folder / "forms").glob(f"{island}-best*.txt"))]
        assert words
        assert len({(word.count("1"), word.count("01")) for word in words}) == len(words)


def test_the_best_of_a_run_are_of_different_scores_and_as_many_as_there_are(outcome) -> None:
    everyone = [row for row in rows(outcome, "individuals") if row["valid"]]
    first: dict[tuple, dict] = {}
    for row in sorted(everyone, key=lambda row: (-row["fitness"], row["id"])):
        first.setdefault(tuple(sorted(dict(row["scores"]).items())), row)
    expected = [row["id"] for row in first.values()]
    folder = open_run(str(outcome.folder))
    for count in (1, 3, len(expected), len(expected) + 5):
        assert [logged.id for logged in best(folder, count)] == expected[:count]
