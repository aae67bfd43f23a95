"""``atoll replay RUN``: the whole run again, in a new folder, with an equal digest."""

from __future__ import annotations

import json
import shutil

import pyarrow as pa
import pyarrow.dataset as ds
import pyarrow.parquet as pq
import pytest
from click.testing import CliRunner
from hosts import run_on_threads

from experiments import bits, run, write
from orchestrator.cli import main
from orchestrator.digest import digest
from orchestrator.folder import open_run


def replay(*arguments: object):
    return CliRunner().invoke(main, ["replay", *(str(argument) for argument in arguments)])


@pytest.fixture(scope="module")
def late(tmp_path_factory):
    """A run on three hosts whose packets came late, shuffled, and some of them not at all."""
    folder = tmp_path_factory.mktemp("late")
    log, end = run_on_threads(folder, write(folder, bits(seed=9)), 3, "schedule=async", storm=2)
    assert end.status == "finished"
    assert digest(log) != digest(run(folder, bits(seed=9)).folder / "log")
    made = open_run(str(log.parent))
    made.update(status="finished")
    return made


def test_a_run_of_async_replays_as_it_went_and_its_replay_does_too(late, tmp_path) -> None:
    result = replay(late.path, "--runs-dir", tmp_path, "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout.splitlines()[-1])
    assert told.keys() == {"run", "digest", "same"}
    assert (told["digest"], told["same"]) == (digest(late.log)[0], True)
    assert told["run"].endswith("-replay")
    again = replay(told["run"], "--runs-dir", tmp_path, "--name", "third", "--set", "log.flush_generations=1")
    assert again.exit_code == 0
    assert f"{told['digest']} third (the same)" in again.stdout


@pytest.mark.parametrize("schedule", ["barrier", "dataflow"])
def test_runs_of_other_schedules_replay_and_stopped_ones_up_to_where_they_came(tmp_path, monkeypatch, schedule) -> None:
    from islands.host import Host

    real = Host.advance

    def stopping(self, through, horizon, settled):
        if through >= 2:
            self.stop()
        return real(self, through, horizon, settled)

    monkeypatch.setattr(Host, "advance", stopping)
    outcome = run(tmp_path, bits(schedule=schedule))
    monkeypatch.undo()
    assert outcome.status == "stopped"
    result = replay(outcome.folder, "--runs-dir", tmp_path / "again", "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout.splitlines()[-1])["same"]


def test_a_log_that_says_otherwise_exits_with_one(late, tmp_path) -> None:
    forged = tmp_path / "forged"
    shutil.copytree(late.path, forged)
    path = min((forged / "log" / "generations").iterdir())
    table = pq.read_table(path)
    changed = pa.array([*table["evaluations"].to_pylist()[:-1], 77], pa.int64())
    pq.write_table(table.set_column(table.schema.get_field_index("evaluations"), "evaluations", changed), path)
    result = replay(forged, "--runs-dir", tmp_path, "--json")
    assert result.exit_code == 1
    assert not json.loads(result.stdout.splitlines()[-1])["same"]
    assert "the log of forged has the digest" in result.stderr


def test_arrivals_hang_on_the_record_alone(late, tmp_path) -> None:
    """Without its arrivals the same run goes otherwise."""
    silent = tmp_path / "silent"
    shutil.copytree(late.path, silent)
    for path in (silent / "log" / "events").glob("e*.parquet"):
        table = pq.read_table(path)
        pq.write_table(table.slice(0, 0), path)
    assert replay(silent, "--runs-dir", tmp_path).exit_code == 1
    joined = ds.dataset(tmp_path / "silent-replay" / "log" / "migrations").to_table().num_rows
    assert joined == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--set", "seed=3"), "--set seed=3: expected a setting of hosts, backend, deadlines, log, got 'seed'"),
        (("--name", "a/b"), "--name: expected letters"),
        (("--runs-dir", " "), "--runs-dir: expected a folder"),
        (("--id", 1, "--name", "x"), "--id: expected no --name and no --set beside it"),
    ],
)
def test_bad_input_is_one_message(late, arguments, message) -> None:
    result = replay(late.path, *arguments)
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert message in result.stderr


def test_a_run_that_is_not_over_is_refused(late, tmp_path) -> None:
    going = tmp_path / "going"
    shutil.copytree(late.path, going)
    for status in ("running", "failed"):
        open_run(str(going)).update(status=status)
        result = replay(going, "--runs-dir", tmp_path)
        assert result.exit_code == 2
        assert f"expected a run that finished or was stopped, got one that is {status}" in result.stderr
