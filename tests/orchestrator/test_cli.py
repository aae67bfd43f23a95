"""The command line: exit codes, one clear message, and JSON on the last line."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from experiments import bits, run, write
from orchestrator.cli import COMMANDS, main

ROOT = Path(__file__).resolve().parents[2]


def atoll(*arguments: object):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def last_json(result) -> dict:
    return json.loads(result.stdout.splitlines()[-1])


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    return run(tmp_path_factory.mktemp("cli")).folder


def refused(result, *parts: str) -> None:
    """Bad input: exit 2, one line on stderr, nothing on stdout, no traceback."""
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert len(result.stderr.strip().splitlines()) == 1
    assert result.stderr.startswith("atoll: ")
    for part in parts:
        assert part in result.stderr


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help_with_an_example(name) -> None:
    result = atoll(name, "--help")
    assert result.exit_code == 0
    assert f"atoll {name}" in result.stdout.split("Example:")[1]


@pytest.mark.parametrize(
    ("error", "code", "said"), [(KeyboardInterrupt(), 130, "interrupted"), (MemoryError(), 1, "not enough memory")]
)
def test_ctrl_c_and_full_memory_are_told_in_a_line(monkeypatch, error, code, said) -> None:
    """A Ctrl-C inside a compiled kernel comes wrapped in a SystemError."""

    def strikes(*arguments: object) -> None:
        if code == 130:
            raise SystemError("returned a result with an exception set") from error
        raise error

    monkeypatch.setattr("growth.hemls.grow", strikes)
    monkeypatch.setattr("orchestrator.growing.grow", strikes, raising=False)
    result = atoll("grow", ROOT / "experiments" / "systems" / "square.hemls")
    assert result.exit_code == code
    assert said in result.stderr
    assert "Traceback" not in result.stderr


def test_a_command_that_is_not_there_is_told_with_the_nearest() -> None:
    for name, said in (("repot", "No such command 'repot'; did you mean 'report'?"), ("x", "'x'; known: chart, check")):
        result = atoll(name, "run")
        assert (result.exit_code, result.stdout) == (2, "")
        assert said in result.stderr


def test_help_lists_the_commands_and_imports_none_of_the_heavy_libraries() -> None:
    code = (
        "import sys\nfrom orchestrator.cli import main\n"
        "try:\n    main(['--help'])\nexcept SystemExit as end:\n    assert end.code == 0\n"
        "heavy = {'ray', 'numpy', 'numba', 'pyarrow', 'duckdb', 'pydantic', 'rich', 'trimesh'} & sys.modules.keys()\n"
        "assert not heavy, heavy\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True)
    for name, text in COMMANDS.items():
        assert name in result.stdout
        assert text in result.stdout


def test_a_run_prints_progress_and_says_what_to_do_next(tmp_path) -> None:
    result = atoll("run", write(tmp_path, bits()), "--runs-dir", tmp_path / "runs", "--name", "mine")
    assert result.exit_code == 0
    assert "epoch 4/4  generation 12  best " in result.stdout
    assert "atoll query" in result.stdout
    assert (tmp_path / "runs" / "mine" / "manifest.json").exists()


def test_a_run_with_json_keeps_stdout_for_it(tmp_path) -> None:
    path = write(tmp_path, bits())
    result = atoll("run", path, "--runs-dir", tmp_path, "--seed", 9, "--set", "generations=4", "--json")
    assert result.exit_code == 0
    (line,) = result.stdout.splitlines()
    told = json.loads(line)
    assert told.keys() >= {"run", "status", "islands", "generations", "evaluations", "best", "wall_s"}
    assert told["best"].keys() == {"island", "id", "fitness"}
    assert (told["status"], told["islands"], told["generations"]) == ("finished", 4, 6)
    assert "epoch 2/2" in result.stderr
    assert json.loads((Path(told["run"]) / "manifest.json").read_text(encoding="utf-8"))["seed"] == 9


def test_bad_input_is_one_message_and_exit_code_two(tmp_path, done) -> None:
    path = write(tmp_path, bits())
    refused(atoll("run", tmp_path / "none.yaml"), "none.yaml: expected a YAML file, got no such file")
    refused(atoll("run", path, "--set", "epok=3"), "--set epok", "did you mean 'epoch'?")
    refused(atoll("run", path, "--name", "../x", "--runs-dir", tmp_path), "--name")
    refused(atoll("run", path, "--address", "x:1"), "--address")
    refused(atoll("run", path, "--set", "backend=ray", "--address", "nonsense"), "--address: expected host:port")
    refused(atoll("show", tmp_path), "expected a run's folder")
    refused(atoll("digest", tmp_path / "none"), "expected a run's folder")
    refused(atoll("query", done, "selec 1"), "SQL", "selec")
    refused(atoll("query", done, "select * from individual"), "individuals")
    refused(atoll("replay", done, "--id", 10**15), "--id: expected an individual of the log")
    refused(atoll("export", done, "--format", "doc", "-o", tmp_path / "forms"), "--format")
    refused(atoll("grow", tmp_path / "none.hemls"), "expected a rule file, got no such file")
    refused(atoll("grow", "x.txt"), "expected a rule file (.hemls, .blocks, .tl, .body.json, .plan)")
    refused(atoll("check", tmp_path / "none.txt"), "no such file")
    assert atoll("run").exit_code == 2
    assert atoll("bogus").exit_code == 2


def test_check_accepts_what_runs_and_refuses_what_would_not(tmp_path) -> None:
    path = write(tmp_path, bits())
    assert last_json(atoll("check", path, "--json")) == {"ok": True, "kind": "experiment"}
    environment = tmp_path / "site.env.yaml"
    environment.write_text("gravity: [0, 0, -1]\n", encoding="utf-8")
    assert last_json(atoll("check", environment, "--json")) == {"ok": True, "kind": "environment"}
    rules = ROOT / "experiments" / "systems" / "square.hemls"
    assert last_json(atoll("check", rules, "--json")) == {"ok": True, "kind": "rules"}
    grammar = ROOT / "genome" / "grammars" / "genr8.bnf"
    assert last_json(atoll("check", grammar, "--json")) == {"ok": True, "kind": "grammar"}
    environment.write_text("gravity: [0, 0, .nan]\n", encoding="utf-8")
    refused(atoll("check", environment), "gravity")
    refused(atoll("check", path, "--set", "channels.0.count=40"), "at most a deme's members")
    refused(atoll("check", path, "--set", "backend=ray", "--set", "hosts=99999"), "hosts")


def test_digest_show_and_schema(done, tmp_path) -> None:
    told = last_json(atoll("digest", done, "--json"))
    assert len(told["digest"]) == 64
    assert told["rows"] == 45 + 12 * 41 + 4 * 13 + 25 + int(_one(done, "select count(*) from evaluations"))
    shown = last_json(atoll("show", done, "--json"))
    assert (shown["status"], shown["generations"]) == ("finished", 12)
    assert [row["island"] for row in shown["islands"]] == ["north-0", "north-1", "north-2", "south"]
    assert shown["evaluations"] == int(_one(done, "select sum(evaluations)::int from generations"))
    assert shown["best"]["fitness"] == _one(done, "select max(fitness) from individuals")
    assert "north-2" in atoll("show", done).stdout
    schema = json.loads(atoll("schema").stdout)
    import jsonschema

    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(bits(), schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(bits(epok=3), schema)


def _one(done, sql: str):
    return last_json(atoll("query", done, sql, "--json"))["rows"][0].popitem()[1]


def test_query_in_every_format(done, tmp_path) -> None:
    import pyarrow.parquet as pq

    columns = "island, count(*) as bred, max(fitness) as best, arg_min(scores, id) as scores"
    sql = f"select {columns} from individuals group by 1 order by 1"
    found = last_json(atoll("query", done, sql, "--format", "json"))["rows"]
    assert found == last_json(atoll("query", done, sql, "--json"))["rows"]
    assert [row["island"] for row in found] == ["north-0", "north-1", "north-2", "south"]
    assert found[0]["scores"].keys() == {"edges", "ones", "zeros"}
    table = list(csv.DictReader(io.StringIO(atoll("query", done, sql, "--format", "csv").stdout)))
    assert [int(row["bred"]) for row in table] == [row["bred"] for row in found]
    assert [float(row["best"]) for row in table] == [row["best"] for row in found]
    lines = atoll("query", done, sql).stdout.splitlines()
    assert lines[0].split() == ["island", "bred", "best", "scores"]
    assert len(lines) == 6
    path = tmp_path / "answer.parquet"
    assert atoll("query", done, sql, "--format", "parquet", "-o", path).exit_code == 0
    assert pq.read_table(path)["bred"].to_pylist() == [row["bred"] for row in found]
    assert atoll("query", done, "select 1 where false").exit_code == 0
    assert last_json(atoll("query", done, "select 1.0 / 0 as x, 'nan'::double as y", "--json")) == {
        "rows": [{"x": None, "y": None}]
    }


def test_a_run_without_a_log_yet_answers_with_empty_tables(tmp_path) -> None:
    (tmp_path / "young").mkdir()
    (tmp_path / "young" / "manifest.json").write_text('{"status": "running"}', encoding="utf-8")
    for table in ("individuals", "evaluations", "generations", "migrations", "events"):
        assert last_json(atoll("query", tmp_path / "young", f"select count(*) as n from {table}", "--json")) == {
            "rows": [{"n": 0}]
        }
    assert last_json(atoll("show", tmp_path / "young", "--json"))["islands"] == []
    refused(atoll("export", tmp_path / "young", "-o", tmp_path / "forms"))


def test_replay_gives_the_same_and_exits_with_one_where_it_does_not(done, tmp_path) -> None:
    import shutil

    best = last_json(atoll("show", done, "--json"))["best"]
    told = last_json(atoll("replay", done, "--id", best["id"], "--json"))
    assert (told["id"], told["fitness"], told["same"]) == (best["id"], best["fitness"], True)
    assert "(the same)" in atoll("replay", done, "--id", best["id"]).stdout
    forged = tmp_path / "forged"
    shutil.copytree(done, forged)
    text = (forged / "experiment.yaml").read_text(encoding="utf-8")
    (forged / "experiment.yaml").write_text(text.replace("weight: 1.0\n", "weight: 2.0\n", 2), encoding="utf-8")
    result = atoll("replay", forged, "--id", best["id"], "--json")
    assert result.exit_code == 1
    assert last_json(result)["same"] is False


def test_export_writes_the_best_and_those_asked_for(done, tmp_path) -> None:
    best = last_json(atoll("show", done, "--json"))["best"]
    told = last_json(atoll("export", done, "--best", 2, "--id", 0, "--format", "txt", "-o", tmp_path / "x", "--json"))
    names = [Path(file).name for file in told["files"]]
    assert names[0] == "north-0-0.txt"
    assert f"{best['island']}-{best['id']}.txt" in names
    assert len(names) == 3
    assert all(Path(file).is_file() for file in told["files"])


def test_grow_measures_the_square_and_writes_it(tmp_path) -> None:
    rules = ROOT / "experiments" / "systems" / "square.hemls"
    told = last_json(atoll("grow", rules, "--steps", 3, "--json", "-o", tmp_path / "square.obj"))
    assert (told["vertices"], told["edges"], told["faces"]) == (81, 144, 64)
    assert told["size"] == pytest.approx(2 * 1.5**3)
    assert told["undulation"] == pytest.approx(0, abs=1e-12)
    assert told["subdivisions"] == pytest.approx(81 / 144)
    assert told.keys() >= {"smoothness", "soft_boundaries", "symmetry", "bounds"}
    assert (tmp_path / "square.obj").read_text(encoding="utf-8").count("\nf ") == 64
    refused(atoll("grow", rules, "--set", "scal=2"), "did you mean 'scale'?")
    refused(atoll("grow", rules, "--steps", -1), "steps")
    refused(atoll("grow", rules, "-o", tmp_path / "square.doc"), "-o")
    refused(atoll("grow", rules, "--time", 2), "--time")
    over = atoll("grow", rules, "--steps", 9, "--set", "max_elements=1000")
    assert over.exit_code == 1
    assert "did not grow: budget" in over.stderr


def test_a_failed_run_exits_with_one_and_says_why(tmp_path, monkeypatch) -> None:
    from islands.host import Host

    monkeypatch.setattr(Host, "finish", lambda self, *given: (_ for _ in ()).throw(OSError(28, "No space left")))
    result = atoll("run", write(tmp_path, bits()), "--runs-dir", tmp_path, "--json")
    assert result.exit_code == 1
    assert last_json(result)["status"] == "failed"
    assert "No space left" in result.stderr


def test_a_folder_whose_name_holds_patterns_can_be_read_by_every_command(done, tmp_path) -> None:
    import shutil

    odd = tmp_path / "a[1]*? 'q'" / "run[x]"
    shutil.copytree(done, odd)
    assert atoll("query", odd, "select count(*) from individuals").exit_code == 0
    assert atoll("query", odd, "select * from events", "--format", "parquet", "-o", odd / "x").exit_code == 0
    best = last_json(atoll("show", odd, "--json"))["best"]
    assert best == last_json(atoll("show", done, "--json"))["best"]
    assert atoll("replay", odd, "--id", best["id"]).exit_code == 0
    assert atoll("export", odd, "--format", "txt", "-o", odd / "forms [2]").exit_code == 0
    assert [path.suffix for path in (odd / "forms [2]").iterdir()] == [".txt"]


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such a name")
def test_a_folder_whose_name_is_no_utf_8_is_told_in_a_line(done, tmp_path) -> None:
    import shutil

    odd = tmp_path / "a\udcff"
    shutil.copytree(done, odd)
    for command in (("query", odd, "select 1"), ("show", odd), ("replay", odd, "--id", 0)):
        refused(atoll(*command), "expected a run's log of Parquet files")


def test_a_log_s_other_files_are_left_alone_and_a_broken_one_is_told(done, tmp_path) -> None:
    import shutil

    copy = tmp_path / "copy"
    shutil.copytree(done, copy)
    (copy / "log" / "events" / "notes.txt").write_text("mine", encoding="utf-8")
    (copy / "log" / "events" / "folder.parquet").mkdir()
    assert atoll("query", copy, "select count(*) from events").exit_code == 0
    (copy / "log" / "events" / "e9.parquet").write_bytes(b"no parquet")
    for command in (("query", copy, "select * from events"), ("show", copy), ("replay", copy, "--id", 0)):
        result = atoll(*command)
        assert "Traceback" not in result.output
        assert result.exit_code in (0, 2)
    refused(atoll("query", copy, "select * from events"), "e9.parquet")


@pytest.mark.parametrize(
    ("sql", "said"),
    [
        ("", "one query, got none"),
        (" ; -- nothing", "one query, got none"),
        ("select 1; select 2", "one query, got 2 statements"),
        ("copy (select 1) to '{}/out.csv'", "only reads"),
        ("copy (select 1) to '{}/log/events/out.csv'", "only reads"),
        ("explain analyze copy (select 1) to '{}/log/events/out.csv'", "only reads"),
        ("attach '{}/new.db'", "only reads"),
        ("create table t as select 1", "only reads"),
        ("drop view events", "only reads"),
        ("insert into events select * from events", "only reads"),
        ("set threads = 1", "only reads"),
        ("install httpfs", "only reads"),
        ("export database '{}/db'", "only reads"),
        ("select * from read_text('{}/manifest.json')", "disabled by configuration"),
        ("select * from '{}/experiment.yaml'", "SQL"),
        ("select '\udcff'", "SQL"),
        ("select ?", "SQL"),
    ],
)
@pytest.mark.parametrize("form", ["table", "parquet"])
def test_only_one_query_that_only_reads_the_log_is_let_in(done, sql, said, form) -> None:
    def files() -> list[Path]:
        return sorted(path for path in done.parent.rglob("*"))

    before = files()
    refused(atoll("query", done, sql.replace("{}", str(done)), "--format", form), said)
    assert files() == before


@pytest.mark.parametrize(
    "sql",
    [
        "from events", "with a as (from events) select * from a", "describe events", "summarize generations",
        "show tables", "values (1)", "pivot individuals on island using count(*)", "table events;",
        "select detail from events -- a remark",
    ],
)  # fmt: skip
def test_all_that_reads_is_let_in(done, tmp_path, sql) -> None:
    assert last_json(atoll("query", done, sql, "--json"))["rows"]
    assert atoll("query", done, sql, "--format", "parquet", "-o", tmp_path / "x.parquet").exit_code == 0


def test_columns_of_one_name_are_all_told(done, tmp_path) -> None:
    import pyarrow.parquet as pq

    sql = "select 1 as a, 2 as a, 3 as a_1, 4 as a"
    expected = {"a": 1, "a_2": 2, "a_1": 3, "a_3": 4}
    assert last_json(atoll("query", done, sql, "--json")) == {"rows": [expected]}
    assert atoll("query", done, sql, "--format", "csv").stdout == "a,a_2,a_1,a_3\n1,2,3,4\n"
    assert atoll("query", done, sql, "--format", "parquet", "-o", tmp_path / "x").exit_code == 0
    assert pq.read_table(tmp_path / "x").to_pylist() == [expected]


def test_show_tells_nothing_stale_of_a_deme_that_is_all_invalid_now(tmp_path) -> None:
    from datetime import UTC, datetime

    from archipelagos import spec

    from islands.log import LogWriter
    from islands.records import Generation, Records

    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "manifest.json").write_text('{"status": "finished"}', encoding="utf-8")
    good = Generation(0, 0, 12, 3.0, 2.0, 0.5, 1.0, 0.5, 2, 1.0)
    bad = Generation(1, 1, 12, None, None, None, None, 0.5, 12, 1.0)
    log = LogWriter(folder / "log", "run", [spec(0)], lambda: datetime.now(UTC))
    log.add(0, 0, Records(generations=(good, bad)))
    log.flush()
    (island,) = last_json(atoll("show", folder, "--json"))["islands"]
    assert (island["generation"], island["best"], island["mean"], island["invalid"]) == (1, None, None, 12)


def test_export_takes_the_best_of_islands_and_of_groups(done, tmp_path) -> None:
    names = [path.stem for path in (Path(done) / "forms").iterdir()]
    island = max(name.split("-best")[0] for name in names)
    told = last_json(atoll("export", done, "--island", island, "--format", "txt", "-o", tmp_path / "x", "--json"))
    (file,) = told["files"]
    assert Path(file).name.startswith(f"{island}-")
    refused(atoll("export", done, "--island", "nowhere", "--format", "txt", "-o", tmp_path / "y"), "--island")


def test_an_export_that_fails_leaves_no_folder_and_one_that_cannot_be_written_is_bad_input(done, tmp_path) -> None:
    refused(atoll("export", done, "--format", "xyz", "-o", tmp_path / "a" / "b"), "--format")
    refused(atoll("export", done, "--id", 10**15, "-o", tmp_path / "a"), "--id")
    assert not list(tmp_path.iterdir())
    (tmp_path / "kept").mkdir()
    refused(atoll("export", done, "--format", "xyz", "-o", tmp_path / "kept"), "--format")
    assert (tmp_path / "kept").is_dir()
    (tmp_path / "afile").write_text("", encoding="utf-8")
    refused(atoll("export", done, "--format", "txt", "-o", tmp_path / "afile" / "x"), "-o: expected a folder")
    refused(atoll("query", done, "select 1", "-o", tmp_path / "afile" / "x"), "-o: expected a file in a folder")
    refused(atoll("query", done, "select 1", "-o", ""), ".: expected a file that can be written")
    if Path("/proc/self").exists():
        refused(atoll("export", done, "--format", "txt", "-o", "/proc/x"), "-o: expected a folder")
        refused(atoll("export", done, "--format", "txt", "-o", "/proc"), "-o: expected a folder")
        refused(atoll("query", done, "select 1", "-o", "/proc/x"), "/proc/x: expected a file")


def test_an_individual_whose_evaluation_raised_replays_as_such(tmp_path) -> None:
    data = bits(epochs=0)
    data["islands"]["south"]["growth"] = {"raise_ending": "1"}
    folder = run(tmp_path, data).folder
    rows = last_json(atoll("query", folder, "select id from individuals where error like 'exception:%'", "--json"))
    told = last_json(atoll("replay", folder, "--id", rows["rows"][0]["id"], "--json"))
    assert told["same"] is True
    assert told["error"].startswith("exception: ZeroDivisionError: ")
