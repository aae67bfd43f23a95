"""What a run stands on fails: its disk is full or read-only, files are damaged, two want to go on with it."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from ordeal import DEADLINE_S, Ordeal, slowed, tortured
from traps import Trap

MIDWAY = Trap("evaluate", "south", nth=170)
ATOLL = f"{sys.executable} -m orchestrator.cli"


def in_a_room_of_its_own(ordeal: Ordeal, *lines: str) -> subprocess.CompletedProcess[str]:
    """Run lines of a shell that may mount things which nobody else sees."""
    unshare = shutil.which("unshare")
    trial = [str(unshare), "-rm", "mount", "-t", "tmpfs", "tmpfs", "."]
    if unshare is None or subprocess.run(trial, cwd=ordeal.folder, capture_output=True, check=False).returncode:
        pytest.skip("nothing can be mounted here")
    root = Path(__file__).resolve().parents[2]
    paths = os.pathsep.join([str(root), str(root / "tests" / "support")])
    environment = {
        **os.environ,
        "PYTHONPATH": paths,
        "ATOLL_TRAPS": str(ordeal.folder),
        "ATOLL_TEST": str(ordeal.folder),
    }
    return subprocess.run(
        [unshare, "-rm", "sh", "-c", "\n".join(lines)],
        cwd=ordeal.folder, env=environment, capture_output=True, text=True, timeout=DEADLINE_S, check=False,
    )  # fmt: skip


def test_a_full_disk(place, note) -> None:
    ordeal = Ordeal(place, tortured())
    (place / "runs").mkdir()
    done = in_a_room_of_its_own(
        ordeal,
        "mount -t tmpfs -o size=160k tmpfs runs",
        f"{ATOLL} run bits.yaml --runs-dir runs --json; echo $?",
        "echo === >&2",
        "mount -o remount,size=64m runs",
        f"{ATOLL} resume runs/bits --json; echo $?",
        "cp -a runs found",
    )
    full, after = done.stderr.split("===\n")
    assert [line for line in done.stdout.splitlines() if not line.startswith("{")] == ["1", "0"], done.stderr
    last = full.splitlines()[-1]
    assert last.startswith("atoll: ")
    assert "no space left on device; make room on the disk" in last
    assert "atoll resume" in last
    assert "Traceback" not in done.stderr
    assert "going on after epoch" in after or "beginning anew" in after
    shutil.move(place / "found" / "bits", place / "runs" / "bits")
    assert ordeal.same()
    note("disk full", "in mid-run, then room", None)


def test_a_read_only_folder(place, note) -> None:
    ordeal = Ordeal(place, slowed(), MIDWAY)
    ordeal.ended(ordeal.run(), -signal.SIGKILL)
    done = in_a_room_of_its_own(
        ordeal,
        "mount --bind runs runs && mount -o remount,ro,bind runs",
        f"{ATOLL} show runs/bits && {ATOLL} resume runs/bits",
    )
    assert done.returncode == 2, done.stderr
    assert "its process is gone; go on with: atoll resume runs/bits" in done.stdout
    (line,) = done.stderr.splitlines()
    assert "expected a run's folder that can be written to, got read-only file system" in line
    ordeal.ended(ordeal.resume(), 0)
    assert ordeal.same()
    note("folder read-only", "at resume", ordeal.recovered_s(ordeal.started))


@pytest.mark.parametrize("pattern", ["e*.json", "e*/host-*.parquet"])
@pytest.mark.parametrize("damage", ["cut", "lost", "spoilt"])
def test_a_damaged_checkpoint(place, note, pattern: str, damage: str) -> None:
    ordeal = Ordeal(place, slowed(), MIDWAY)
    ordeal.ended(ordeal.run(), -signal.SIGKILL)
    before, last = ordeal.checkpoints()[-2:]
    spoil(max(ordeal.path.glob(f"checkpoints/{pattern}")), damage)
    ended = ordeal.ended(ordeal.resume(), 0)
    lost = damage == "lost" and pattern == "e*.json"  # as if it had never been made whole
    assert ("passed over: checkpoints/" in ended.err) != lost
    assert f"going on after epoch {before}\n" in ended.err
    assert last > before
    assert ordeal.same()
    note(
        f"newest checkpoint {damage}",
        "its JSON" if pattern == "e*.json" else "its part",
        ordeal.recovered_s(ordeal.started),
    )


def spoil(path: Path, damage: str) -> None:
    content = path.read_bytes()
    if damage == "lost":
        path.unlink()
    elif damage == "cut":
        path.write_bytes(content[: len(content) // 2])
    else:
        middle = len(content) // 2
        path.write_bytes(
            content[:middle] + bytes(byte ^ 0x55 for byte in content[middle : middle + 8]) + content[middle + 8 :]
        )


@pytest.mark.parametrize("damage", ["cut", "lost"])
def test_a_damaged_log(place, note, damage: str) -> None:
    """The checkpoints that list the file fall; where none is left, the run begins anew."""
    ordeal = Ordeal(place, slowed(), MIDWAY)
    ordeal.ended(ordeal.run(), -signal.SIGKILL)
    spoil(min(ordeal.path.glob("log/individuals/e*.parquet")), damage)
    ended = ordeal.ended(ordeal.resume(), 0)
    assert ended.err.count("passed over: log/individuals/") == 2
    assert "no checkpoint: beginning anew" in ended.err
    assert ordeal.same()
    note(f"log file {damage}", "the first of individuals", ordeal.recovered_s(ordeal.started))


@pytest.mark.parametrize("table", ["individuals", "generations"])
def test_a_log_that_is_spoilt_within(place, note, table: str) -> None:
    ordeal = Ordeal(place, slowed(), MIDWAY)
    ordeal.ended(ordeal.run(), -signal.SIGKILL)
    file = min(ordeal.path.glob(f"log/{table}/e*.parquet"))
    content = bytearray(file.read_bytes())
    content[4:200] = bytes(196)
    file.write_bytes(content)
    complaint = ordeal.ended(ordeal.start("digest", ordeal.place), 2).complaint
    assert f"{table}/{file.name}" in complaint
    ended = ordeal.ended(ordeal.resume(), 0)
    assert f"passed over: log/{table}/{file.name}: expected content of the CRC-32 " in ended.err
    assert ordeal.same()
    note("log file spoilt within", f"the first of {table}", ordeal.recovered_s(ordeal.started))


@pytest.mark.ray
def test_two_processes_resume_one_run(place, note) -> None:
    ordeal = Ordeal(place, slowed(), MIDWAY)
    ordeal.ended(ordeal.run(), -signal.SIGKILL)
    first = ordeal.resume()
    ordeal.until(lambda: ordeal.marks("back"), first)
    began = time.monotonic()
    second = ordeal.ended(ordeal.resume(), 2)
    assert "expected a run that nobody drives, got one that another process drives" in second.complaint
    assert first.poll() is None
    assert time.monotonic() - began < 30
    ordeal.ended(first, 0)
    assert ordeal.same()
    note("two processes resume one run", "the second is refused", None)


@pytest.mark.parametrize("backend", ["inline", "ray"])
def test_ctrl_c_twice(place, note, backend: str) -> None:
    ordeal = Ordeal(place, slowed(20))
    process = ordeal.run("--set", f"backend={backend}", "--set", "hosts=2")
    ordeal.until(ordeal.checkpoints, process)
    for _ in range(2):
        process.send_signal(signal.SIGINT)
        time.sleep(0.01)
    ended = ordeal.ended(process, 130, 30)
    assert "Traceback" not in ended.err
    assert ordeal.manifest()["status"] == "stopped"
    ordeal.ended(ordeal.resume("--set", "backend=inline"), 0)
    assert ordeal.same()
    note("Ctrl-C twice", f"in mid-run, {backend}", None)
