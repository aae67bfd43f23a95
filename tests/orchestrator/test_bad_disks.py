"""Runs on disks that are full or cannot be written: a clear message, and nothing half-written."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from experiments import bits, write

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests" / "support")])}


def on_mount(folder: Path, mount: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    """Run ``atoll run`` with something mounted on ``folder / "disk"``, seen by it alone; copy what is there then."""
    unshare = shutil.which("unshare")
    (folder / "disk").mkdir()
    prelude = f"{mount} disk"
    if (
        unshare is None
        or subprocess.run(
            [unshare, "-rm", "sh", "-c", prelude], cwd=folder, capture_output=True, check=False
        ).returncode
    ):
        pytest.skip("nothing can be mounted here")
    command = [sys.executable, "-m", "orchestrator.cli", "run", *map(str, arguments)]
    script = f'{prelude} && "$@"; code=$?; cp -a disk/. found; exit $code'
    return subprocess.run(
        [unshare, "-rm", "sh", "-c", script, "sh", *command],
        cwd=folder, env=ENVIRONMENT, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("size", ["96k", "160k"])
def test_a_disk_that_fills_up_in_mid_run(tmp_path, size: str) -> None:
    path = write(tmp_path, bits(epochs=60))
    done = on_mount(tmp_path, f"mount -t tmpfs -o size={size} tmpfs", path, "--runs-dir", "disk/runs", "--json")
    assert done.returncode == 1, done.stderr
    last = done.stderr.splitlines()[-1]
    assert last.startswith("atoll: ")
    assert "expected a file that can be written, got no space left on device; make room on the disk" in last
    run = tmp_path / "found" / "runs" / "bits"
    assert json.loads((run / "manifest.json").read_text(encoding="utf-8"))["run"] == "bits"
    assert not [file for file in run.rglob("*") if file.is_file() and (file.suffix == ".tmp" or ".tmp" in file.parts)]
    tables = {table.name: pq.read_table(table) for table in (run / "log").iterdir() if not table.name.startswith(".")}
    epochs = [set(tables[name].column("epoch").to_pylist()) for name in ("individuals", "generations")]
    assert epochs[0] == epochs[1] == set(range(len(epochs[0])))
    assert tables["individuals"].num_rows == len(set(tables["individuals"].column("id").to_pylist()))


def test_a_disk_that_is_full_before_the_run_begins(tmp_path) -> None:
    path = write(tmp_path, bits())
    done = on_mount(tmp_path, "mount -t tmpfs -o size=4k tmpfs", path, "--runs-dir", "disk/runs")
    assert (done.returncode, done.stdout) == (2, ""), done.stderr
    (line,) = done.stderr.splitlines()
    assert "o space left on device" in line
    assert list((tmp_path / "found").iterdir()) == []


def test_a_runs_folder_that_cannot_be_written(tmp_path) -> None:
    path = write(tmp_path, bits())
    done = on_mount(tmp_path, "mount -t tmpfs -o ro tmpfs", path, "--runs-dir", "disk")
    assert (done.returncode, done.stdout) == (2, ""), done.stderr
    expected = "--runs-dir: expected a folder that a run can be written to, got disk (Read-only file system)"
    assert done.stderr == f"atoll: {expected}\n"
