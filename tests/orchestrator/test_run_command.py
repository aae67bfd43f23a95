"""``atoll run`` at its edges: names, folders, addresses, and output that nobody reads."""

from __future__ import annotations

import builtins
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from experiments import bits, run, write
from genome.errors import InputError
from orchestrator import entry, folder
from orchestrator.cli import main

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests" / "support")])}


def refused(*arguments: object) -> str:
    result = CliRunner().invoke(main, ["run", *map(str, arguments)])
    assert (result.exit_code, result.stdout) == (2, ""), result.output
    assert len(result.stderr.strip().splitlines()) == 1
    return result.stderr


def test_a_runs_folder_without_a_name_is_refused(tmp_path, monkeypatch) -> None:
    path = write(tmp_path, bits())
    monkeypatch.chdir(tmp_path)
    assert "--runs-dir: expected a folder, got ''" in refused(path, "--runs-dir", "")
    assert list(tmp_path.iterdir()) == [path]


def test_a_name_that_is_too_long_is_refused_before_anything_is_made(tmp_path) -> None:
    path, runs = write(tmp_path, bits(epochs=0)), tmp_path / "runs"
    for length in (101, 300):
        told = refused(path, "--runs-dir", runs, "--name", "x" * length)
        assert f"--name: expected at most 100 characters, got {length}" in told
    assert not runs.exists()


def test_the_longest_name_has_room_for_a_number(tmp_path) -> None:
    data = bits(epochs=0, name="x" * 100)
    names = [run(tmp_path, data).folder.name for _ in range(2)]
    assert names == ["x" * 100, "x" * 98 + "-2"]


def another_comes_first(monkeypatch, place: Path) -> None:
    """Let another run take the place while this one's folder is being made."""
    real = folder._first_manifest

    def late(*arguments):
        place.mkdir(parents=True, exist_ok=True)
        (place / "manifest.json").write_text("{}", encoding="utf-8")
        return real(*arguments)

    monkeypatch.setattr(folder, "_first_manifest", late)


def test_of_runs_that_start_together_one_has_the_name_and_the_next_a_number(tmp_path, monkeypatch) -> None:
    runs = tmp_path / "runs"
    another_comes_first(monkeypatch, runs / "bits")
    made = run(tmp_path, bits(epochs=0)).folder
    assert made == runs / "bits-2"
    assert (runs / "bits" / "manifest.json").read_text(encoding="utf-8") == "{}"
    assert json.loads((made / "manifest.json").read_text(encoding="utf-8"))["run"] == "bits-2"
    assert "name: bits-2\n" in (made / "experiment.yaml").read_text(encoding="utf-8")
    assert sorted(path.name for path in runs.iterdir()) == ["bits", "bits-2"]


def test_of_runs_that_ask_for_one_name_together_the_second_is_refused(tmp_path, monkeypatch) -> None:
    another_comes_first(monkeypatch, tmp_path / "runs" / "mine")
    with pytest.raises(InputError, match="--name mine: expected a name that is free"):
        run(tmp_path, bits(epochs=0), name="mine")
    assert [path.name for path in (tmp_path / "runs").iterdir()] == ["mine"]


def test_a_folder_that_cannot_be_filled_is_not_left(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(folder, "_first_manifest", lambda *_: (_ for _ in ()).throw(OSError(28, "No space left")))
    with pytest.raises(InputError, match="--runs-dir: expected a folder that a run can be written to"):
        run(tmp_path)
    assert not (tmp_path / "runs").exists()


def test_an_address_of_ray_client_is_refused(tmp_path) -> None:
    path = write(tmp_path, bits(backend="ray"))
    told = refused(path, "--address", "ray://127.0.0.1:10001")
    assert "--address: expected host:port or auto, got 'ray://127.0.0.1:10001'" in told
    assert "ray://" not in CliRunner().invoke(main, ["run", "--help"]).stdout
    assert "ray://" not in refused(path, "--address", "nonsense")


@pytest.mark.parametrize("arguments", [(), ("--json",)])
def test_output_that_nobody_reads_stops_no_run(tmp_path, arguments) -> None:
    """As ``atoll run ... 2>&1 | head -1`` once ``head`` has gone."""
    path = write(tmp_path, bits())
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "orchestrator.entry", "run", str(path), "--runs-dir", "runs", *arguments]
    # By default a pipe takes stderr, too, only where progress goes there.
    streams = {"stdout": writer, "stderr": writer if arguments else subprocess.PIPE}
    done = subprocess.run(command, cwd=tmp_path, env=ENVIRONMENT, timeout=120, check=False, **streams)
    os.close(writer)
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    manifest = json.loads((tmp_path / "runs" / "bits" / "manifest.json").read_text(encoding="utf-8"))
    assert (manifest["status"], manifest["generations"]) == ("finished", 12)


def test_other_troubles_with_output_are_told() -> None:
    code = "import sys; from orchestrator.unbroken import Unbroken; o = Unbroken(sys.stdout); o.write('x'); o.flush()"
    command = [sys.executable, "-c", code]
    with Path("/dev/full").open("w", encoding="ascii") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, env=ENVIRONMENT, text=True, check=False)
    assert done.returncode != 0
    assert "No space left on device" in done.stderr


def test_ctrl_c_before_the_command_line_is_there_is_no_traceback(monkeypatch, capsys) -> None:
    real = builtins.__import__

    def struck(name, *arguments):
        if name == "orchestrator.cli":
            raise KeyboardInterrupt
        return real(name, *arguments)

    monkeypatch.setattr(builtins, "__import__", struck)
    with pytest.raises(SystemExit) as end:
        entry.main()
    assert end.value.code == 130
    assert capsys.readouterr().err == "atoll: interrupted\n"


def test_the_entry_imports_next_to_nothing() -> None:
    code = "import sys; before = set(sys.modules); import orchestrator.entry; print(sorted(set(sys.modules) - before))"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=ENVIRONMENT, check=True)
    assert result.stdout == "['__future__', 'orchestrator', 'orchestrator.entry']\n"
    scripts = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert 'atoll = "orchestrator.entry:main"' in scripts
