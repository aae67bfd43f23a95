"""Runs in a bucket of a real S3 server: the same as on a disk, and told clearly when they cannot be."""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest
from buckets import KEYS, environment, reaching, serving
from click.testing import CliRunner

from experiments import Silent, bits, run, write
from genome.errors import InputError
from islands.host import Host
from islands.schemas import TABLES
from islands.store import Store, StoreError
from islands.stores.remote import RemoteStore
from orchestrator import query
from orchestrator.backends.protocol import RunFailedError
from orchestrator.cli import main
from orchestrator.digest import digest
from orchestrator.folder import create, open_run
from orchestrator.loading import load_experiment
from orchestrator.plan import host_plans, make_plan
from orchestrator.query import ask
from orchestrator.run import Outcome, make_backend, run_experiment

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def endpoint():
    with serving() as url, reaching(url):
        yield url


def run_far(folder: Path, place: str, data: dict | None = None, *overrides: str, name: str | None = None) -> Outcome:
    loaded = load_experiment(write(folder, bits() if data is None else data), overrides)
    return run_experiment(loaded, make_backend(loaded, None), Store.open(place), name, Silent())


@pytest.fixture(scope="module")
def pair(endpoint: str, tmp_path_factory) -> tuple[Path, Store]:
    """One run on the disk, and the same in the bucket."""
    folder = tmp_path_factory.mktemp("pair")
    near = run(folder).folder
    return near, run_far(folder, "s3://bucket/runs").store


def files(store: Store) -> list[str]:
    """All files, also hidden ones in folders that are not."""
    below = [f"{folder}/{name}" for folder in store.folders() for name in files(store.at(folder))]
    return sorted([*store.names(hidden=True), *below])


def atoll(*arguments: object) -> dict:
    result = CliRunner().invoke(main, [*map(str, arguments), "--json"])
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout.splitlines()[-1])


def refused(*arguments: object) -> str:
    """One line, exit code 2, nothing on stdout."""
    result = CliRunner().invoke(main, list(map(str, arguments)))
    assert (result.exit_code, result.stdout) == (2, ""), result.output
    assert len(result.stderr.strip().splitlines()) == 1
    assert not [value for value in KEYS.values() if value in result.stderr]
    return result.stderr


def test_a_run_in_a_bucket_is_the_run_on_the_disk(pair) -> None:
    near, far = pair
    assert digest(far.at("log")) == digest(near / "log")
    # On a disk a lock keeps others away, which stays; in a bucket a file that goes.
    assert [".lock", *files(far)] == files(Store.open(near))
    for name in files(far):
        if name.endswith((".txt", ".yaml")):  # forms, and the experiment
            assert far.read(name) == (near / name).read_bytes()
    manifest = json.loads(far.read("manifest.json"))
    assert (manifest["status"], manifest["run"]) == ("finished", "bits")


def test_nothing_in_the_bucket_holds_a_key(pair) -> None:
    _, far = pair
    for name in files(far):
        assert not [value for value in KEYS.values() if value.encode() in far.read(name)]
    rows = ask(far.at("log"), "select detail from events").rows
    assert rows
    assert not [value for value in KEYS.values() if value in str(rows)]


@pytest.mark.parametrize("table", TABLES)
def test_queries_give_the_same_values_of_the_same_types(pair, table: str) -> None:
    near, far = pair
    described = f"select column_name, column_type from (describe {table})"
    assert ask(far.at("log"), described).rows == ask(near / "log", described).rows
    clocked = "(growth_ms, evaluation_ms)" if table == "individuals" else "(evaluation_ms)"
    kept = {"individuals": clocked, "evaluations": clocked, "generations": "(wall_ms)", "events": "(time)"}
    sql = f"select * {'exclude ' + kept[table] if table in kept else ''} from {table}"
    found = [ask(log, sql) for log in (far.at("log"), near / "log")]
    assert found[0].columns == found[1].columns
    assert sorted(map(repr, found[0].rows)) == sorted(map(repr, found[1].rows))
    if table != "events":  # of those with a clock the order is as it was written
        assert found[0].rows == found[1].rows


def test_every_command_takes_the_place(pair, tmp_path) -> None:
    near, far = pair
    place = str(far)
    assert place == "s3://bucket/runs/bits"
    told = [atoll("show", one) for one in (place, near)]
    for each in told:
        for key in ("started", "ended", "evaluations_per_s"):
            each.pop(key)
    assert told[0] == told[1]
    assert atoll("digest", place) == atoll("digest", near)
    identity = told[0]["best"]["id"]
    assert atoll("replay", place, "--id", identity) == atoll("replay", near, "--id", identity)
    again = atoll("replay", place, "--runs-dir", "s3://bucket/replays")
    assert (again["same"], again["run"]) == (True, "s3://bucket/replays/bits-replay")
    written = [Path(one) for one in atoll("export", place, "--format", "txt", "-o", tmp_path / "forms")["files"]]
    assert [path.exists() for path in written] == [True]
    sql = "select count(*) as bred from individuals"
    assert atoll("query", place, sql) == atoll("query", near, sql)


def test_what_an_experiment_names_goes_with_the_run(endpoint: str, tmp_path) -> None:
    import trimesh

    trimesh.creation.icosphere(subdivisions=1).export(tmp_path / "ball.stl")
    (tmp_path / ".site.env.yaml").write_text(
        "gravity: [0, 0, -0.1]\nboundaries:\n  - {mesh: ball.stl, at: [0, 0, -3], solid: inside}\n", encoding="utf-8"
    )
    data = {
        "name": "kept", "epochs": 1, "epoch": 1, "backend": "inline",
        "islands": {"only": {"kind": "surface", "population": 3, "fitness": {"size": {"goal": "maximise"}},
                             "growth": {"steps": 1, "environment": ".site.env.yaml"}}},
    }  # fmt: skip
    far = run_far(tmp_path, "s3://bucket/kept", data).store
    for path in (tmp_path / "ball.stl", tmp_path / ".site.env.yaml"):
        path.unlink()
    assert [name for name in files(far) if name.startswith("environment/")]
    assert atoll("replay", far, "--runs-dir", tmp_path / "again")["same"]
    # A host on another machine has nothing but the place.
    made = open_run(str(far))
    loaded = load_experiment(made.experiment)
    (plan,) = host_plans(loaded, make_plan(loaded), 1, made.name, made.store)
    elsewhere = tuple(replace(spec, base="/nowhere") for spec in plan.islands)
    assert Host(replace(plan, islands=elsewhere)).ready() == 0


def test_names_are_numbered_by_default_and_refused_when_asked_for(endpoint: str, tmp_path) -> None:
    small = bits(epochs=0)
    place = "s3://bucket/numbered"
    assert [run_far(tmp_path, place, small).store.name for _ in range(3)] == ["bits", "bits-2", "bits-3"]
    with pytest.raises(
        InputError, match="--name bits-2: expected a name that is free, got s3://bucket/numbered/bits-2, w"
    ):
        run_far(tmp_path, place, small, name="bits-2")
    assert Store.open(place).folders() == ["bits", "bits-2", "bits-3"]


def test_of_runs_that_start_together_each_has_a_name_of_its_own(endpoint: str, tmp_path) -> None:
    loaded, now = load_experiment(write(tmp_path, bits(epochs=0))), datetime.now(UTC)

    def make(number: int, *, explicit: bool) -> str:
        runs = Store.open(f"s3://bucket/together-{explicit}")
        try:
            return create(runs, "bits", loaded, now, {"number": number}, explicit=explicit).name
        except InputError as error:
            return error.expected

    with ThreadPoolExecutor(4) as pool:
        named = sorted(pool.map(lambda number: make(number, explicit=False), range(4)))
        asked = sorted(pool.map(lambda number: make(number, explicit=True), range(4)))
    assert len(set(named)) == 4
    assert all(name.startswith("bits") for name in named)
    assert asked == [*["a name that is free"] * 3, "bits"]
    for name in named:
        assert open_run(f"s3://bucket/together-False/{name}").manifest()["run"] == name


def test_a_folder_is_filled_before_its_manifest_and_goes_when_that_fails(endpoint: str, tmp_path, monkeypatch) -> None:
    real, seen = RemoteStore.write, []

    def failing(self, name, content, staging=""):
        if name == "manifest.json":
            seen.extend(files(self))
            raise StoreError(name, "a file that can be written", "nothing of the kind")
        real(self, name, content, staging)

    monkeypatch.setattr(RemoteStore, "write", failing)
    with pytest.raises(StoreError, match="nothing of the kind"):
        run_far(tmp_path, "s3://bucket/unfilled")
    assert seen == ["experiment.yaml"]
    assert files(Store.open("s3://bucket/unfilled")) == []


def test_a_failed_start_leaves_nothing(endpoint: str, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(Host, "ready", lambda self: (_ for _ in ()).throw(InputError("here", "a", "b")))
    with pytest.raises(RunFailedError, match="here: expected a, got b"):
        run_far(tmp_path, "s3://bucket/failed")
    assert files(Store.open("s3://bucket/failed")) == []


def test_a_place_without_a_run_is_bad_input(endpoint: str) -> None:
    for command in (("show",), ("digest",), ("replay",), ("query", "select 1")):
        told = refused(command[0], "s3://bucket/nothing", *command[1:])
        assert "s3://bucket/nothing: expected a run's folder, got one without manifest.json" in told


def test_a_run_that_lost_its_manifest_is_read_by_its_log(pair) -> None:
    _, far = pair
    lost = Store.open("s3://bucket/lost")
    for name in files(far):
        if name != "manifest.json":
            lost.write(name, far.read(name))
    assert atoll("digest", "s3://bucket/lost")["digest"] == digest(far.at("log"))[0]
    assert "got one without manifest.json" in refused("show", "s3://bucket/lost")


def test_a_bucket_that_is_not_there_is_told_before_anything_runs(endpoint: str, tmp_path) -> None:
    path = write(tmp_path, bits())
    for arguments in (("run", path, "--runs-dir", "s3://none/runs"), ("show", "s3://none/runs/bits")):
        assert "expected a bucket that is there, got none by that name; make the bucket first" in refused(*arguments)


def test_a_server_that_is_not_there_is_told_before_anything_runs(endpoint: str, tmp_path, monkeypatch) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{free.getsockname()[1]}")
        path = write(tmp_path, bits())
        for arguments in (("run", path, "--runs-dir", "s3://bucket/runs"), ("show", "s3://bucket/runs/bits")):
            assert "; check the network and the endpoint" in refused(*arguments)


def test_keys_that_are_wrong_are_told_before_anything_runs(tmp_path) -> None:
    path = write(tmp_path, bits())
    with serving(closed=True) as url, reaching(url):
        for arguments in (("run", path, "--runs-dir", "s3://bucket/runs"), ("show", "s3://bucket/runs/bits")):
            assert "; check AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY" in refused(*arguments)
        told = refused("run", path, "--runs-dir", "s3://anybody:hush-hush-hush@bucket/runs")
        assert "expected a place without keys or passwords" in told


def test_a_store_that_goes_away_in_mid_run_fails_the_run_with_its_reason(tmp_path, monkeypatch) -> None:
    real, server = Host._take_turn, ExitStack()

    def leaving(self, number, epoch):
        if epoch == 2:
            server.close()
        return real(self, number, epoch)

    monkeypatch.setattr(Host, "_take_turn", leaving)
    with ExitStack() as stack:
        url = server.enter_context(serving())
        stack.enter_context(server)
        stack.enter_context(reaching(url))
        path = write(tmp_path, bits())
        result = CliRunner().invoke(main, ["run", str(path), "--runs-dir", "s3://bucket/runs", "--json"])
    assert (result.exit_code, result.stdout) == (1, ""), result.output
    # Whoever is the first to need the store: a host its log, or the driver its inbox.
    last = result.stderr.splitlines()[-1]
    assert re.search(r"s3://bucket/runs/bits/\S+: expected a f[a-z]+ that can be [a-z]+, got no connection \(", last)


def test_a_store_that_goes_away_in_mid_query_is_no_fault_of_the_query(tmp_path, monkeypatch) -> None:
    with serving() as url, reaching(url):
        log = run_far(tmp_path, "s3://bucket/runs").store.at("log")
        connection = query.connect(log)
    monkeypatch.setattr(query, "connect", lambda log, sql: connection)
    with pytest.raises(
        StoreError, match=r"s3://bucket/runs/bits/log: expected a log that can be read, got no connection"
    ):
        ask(log, "select max(fitness) from individuals")


@pytest.mark.ray
def test_two_hosts_write_to_the_bucket(endpoint: str, pair, tmp_path) -> None:
    near, _ = pair
    path = write(tmp_path, bits(backend="ray", hosts=2))
    command = [sys.executable, "-m", "orchestrator.cli", "run", str(path), "--runs-dir", "s3://bucket/ray", "--json"]
    places = os.pathsep.join([str(ROOT), str(ROOT / "tests" / "support")])
    variables = {**os.environ, **environment(endpoint), "PYTHONPATH": places}
    done = subprocess.run(
        command, cwd=tmp_path, env=variables, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout.splitlines()[-1])
    assert (told["run"], told["status"]) == ("s3://bucket/ray/bits", "finished")
    far = open_run(told["run"])
    assert far.manifest()["hosts"] == 2
    assert digest(far.log) == digest(near / "log")
    assert sorted(path.name for path in (near / "forms").iterdir()) == far.store.names("forms")
