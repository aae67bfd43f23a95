"""On Ray: the same digest whatever the hosts, and clean ends. Each of these starts a local Ray, which takes seconds."""

from __future__ import annotations

import ipaddress
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pyarrow.dataset as ds
import pytest

from experiments import bits, run, write
from genome.errors import InputError
from orchestrator.backends import cluster
from orchestrator.backends.cluster import HOSTS_PER_CPU, hosts_for, machine_cpus
from orchestrator.backends.protocol import RunFailedError
from orchestrator.digest import digest

ROOT = Path(__file__).resolve().parents[2]


def start(folder: Path, data: dict, *arguments: str, hash_seed: str = "random") -> subprocess.Popen:
    """Start the command line in a process group of its own, in another folder than the project's."""
    write(folder, data)
    kept = {key: value for key, value in os.environ.items() if not key.startswith("RAY_")}
    environment = {
        **kept,
        "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests" / "support")]),
        "PYTHONHASHSEED": hash_seed,
        "ATOLL_TEST": str(folder),
    }
    command = [sys.executable, "-m", "orchestrator.cli", "run", "bits.yaml", "--runs-dir", "runs", "--json", *arguments]
    return subprocess.Popen(
        command,
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def ended(process: subprocess.Popen, code: int) -> tuple[dict, str]:
    """Wait for the end; nothing but the JSON is on stdout, no traceback on stderr, and no process of it is left."""
    try:
        out, err = process.communicate(timeout=120)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        raise
    assert process.returncode == code, err
    assert "Traceback" not in err
    assert len(out.splitlines()) == 1, out
    return json.loads(out), err


@pytest.fixture
def clean(tmp_path):
    """No process that the test started outlives it by more than a moment."""
    yield
    for _ in range(50):
        left = [process for process in psutil.process_iter() if _belongs(process, str(tmp_path))]
        if not left:
            return
        time.sleep(0.2)
    raise AssertionError(left)


def _belongs(process: psutil.Process, folder: str) -> bool:
    try:
        return process.environ().get("ATOLL_TEST", "").startswith(folder)
    except psutil.Error:
        return False


def told_of(folder: Path, name: str, *sets: str, hash_seed: str = "0") -> tuple[Path, dict]:
    """Run to the end in a folder of its own; give the run's folder and what the command said."""
    place = folder / name
    place.mkdir()
    arguments = [part for one in ("backend=ray", *sets) for part in ("--set", one)]
    told, _ = ended(start(place, bits(), *arguments, hash_seed=hash_seed), 0)
    return Path(told["run"]), told


@pytest.mark.ray
def test_the_digest_is_the_same_on_any_number_of_hosts(tmp_path, clean) -> None:
    """In this process, and on 1, 2 and 4 hosts, by both schedules that promise it, under different hash seeds."""
    whole = digest(run(tmp_path).folder / "log")
    assert whole[1] > 500
    for hosts, schedule, seed in (
        (1, "barrier", "1"), (2, "barrier", "0"), (4, "barrier", "1"), (2, "dataflow", "1"), (4, "dataflow", "0"),
    ):  # fmt: skip
        sets = [f"hosts={hosts}", f"schedule={schedule}"]
        folder, told = told_of(tmp_path, f"{schedule}-{hosts}", *sets, hash_seed=seed)
        manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
        assert (manifest["status"], manifest["hosts"]) == ("finished", hosts)
        assert digest(folder / "log") == whole
        assert 0 < told["busy"] <= 1
        files = list((folder / "log" / "generations").iterdir())
        assert len({path.name.split("-i")[1] for path in files}) == hosts


@pytest.mark.ray
def test_an_async_run_replays_on_another_number_of_hosts(tmp_path, clean) -> None:
    folder, _ = told_of(tmp_path, "free", "hosts=3", "schedule=async", "epochs=20")
    command = [sys.executable, "-m", "orchestrator.cli", "replay", str(folder), "--runs-dir", str(tmp_path), "--json"]
    paths = os.pathsep.join([str(ROOT), str(ROOT / "tests" / "support")])
    environment = {**os.environ, "PYTHONPATH": paths, "ATOLL_TEST": str(tmp_path)}
    done = subprocess.run([*command, "--set", "hosts=2"], capture_output=True, text=True, env=environment, timeout=120)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert (told["same"], told["digest"]) == (True, digest(folder / "log")[0])
    assert json.loads((Path(told["run"]) / "manifest.json").read_text(encoding="utf-8"))["hosts"] == 2


def slow() -> dict:
    data = bits(backend="ray", hosts=2, epochs=1000)
    data["defaults"]["growth"] = {"delay_ms": 5.0}
    return data


def until_settled(folder: Path, process: subprocess.Popen) -> None:
    """Wait until the run has written its first generations."""
    for _ in range(600):
        if list(folder.glob("runs/bits/log/generations/*.parquet")):
            return
        assert process.poll() is None, process.communicate()
        time.sleep(0.1)
    raise AssertionError("no generation within a minute")


def strangers_can_reach(process: subprocess.Popen) -> list[str]:
    """Give the addresses, other than loopback's, on which a run's processes listen."""
    driver = psutil.Process(process.pid)
    listening = [
        connection.laddr.ip
        for member in (driver, *driver.children(recursive=True))
        for connection in member.net_connections(kind="inet")
        if connection.status == psutil.CONN_LISTEN
    ]
    assert len(listening) > 3
    return [ip for ip in listening if not ipaddress.ip_address(ip.removeprefix("::ffff:")).is_loopback]


@pytest.mark.ray
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_to_the_whole_group_stops_cleanly(tmp_path, clean, number) -> None:
    """As from a terminal or from ``timeout``: the driver hears it, and the hosts live to write their log."""
    process = start(tmp_path, slow())
    until_settled(tmp_path, process)
    assert strangers_can_reach(process) == []
    others = psutil.Process(process.pid).children(recursive=True)
    assert [other for other in others if os.getpgid(other.pid) == process.pid] == []
    os.killpg(process.pid, number)
    told, _ = ended(process, 130)
    assert told["status"] == "stopped"
    manifest = json.loads((tmp_path / "runs/bits/manifest.json").read_text(encoding="utf-8"))
    assert (manifest["status"], manifest["error"]) == ("stopped", "asked to stop")
    assert manifest["ended"]
    assert manifest["best"] == told["best"]
    counts = ds.dataset(tmp_path / "runs/bits/log/generations").to_table(columns=["evaluations"])["evaluations"]
    assert sum(counts.to_pylist()) == manifest["evaluations"] == told["evaluations"]
    assert list((tmp_path / "runs/bits/forms").iterdir())


@pytest.mark.ray
def test_a_host_that_hangs_is_given_up_and_its_island_named_whoever_waits_for_it(tmp_path, clean) -> None:
    data = bits(backend="ray", hosts=2, schedule="dataflow", deadlines={"epoch": 1})
    data["islands"]["south"]["growth"]["delay_ms"] = 1e6
    process = start(tmp_path, data)
    out, err = process.communicate(timeout=120)
    assert (process.returncode, out) == (1, "")
    assert "host 1 did not finish epoch 0 within 1 s (it has been in epoch 0 of island south for " in err
    assert "Traceback" not in err


@pytest.mark.ray
def test_a_plug_in_that_fails_on_the_host_leaves_no_folder(tmp_path, clean) -> None:
    data = bits(backend="ray", hosts=1)
    data["islands"]["north"]["growth"]["only_in_driver"] = True
    process = start(tmp_path, data)
    out, err = process.communicate(timeout=120)
    assert (process.returncode, out) == (1, "")
    assert "host 0 could not start: " in err
    assert "Traceback" not in err
    assert list((tmp_path / "runs").iterdir()) == []


def test_an_unreachable_cluster_is_told_at_once(tmp_path) -> None:
    started = time.monotonic()
    process = start(tmp_path, bits(backend="ray"), "--address", "127.0.0.1:9")
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (1, "")
    assert "no Ray cluster at 127.0.0.1:9" in err
    assert "Traceback" not in err
    assert time.monotonic() - started < 30
    assert not (tmp_path / "runs").exists()


def test_something_else_at_the_address_is_given_up(monkeypatch) -> None:
    import socket

    monkeypatch.setattr(cluster, "PROBE_S", 4.0)
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(RunFailedError, match=f"no Ray cluster at {address}: .* within 4 s"):
            cluster.reach(address)
    for address in ("nonsense", "ray://127.0.0.1:10001", "127.0.0.1:"):
        with pytest.raises(InputError, match="--address: expected host:port or auto, got"):
            cluster.reach(address)


def test_hosts_are_as_many_as_there_is_room_and_use_for() -> None:
    assert hosts_for("auto", 100, 8) == 8
    assert hosts_for("auto", 3, 8) == 3
    assert hosts_for(5, 3, 8) == 3
    assert hosts_for(8, 100, 2) == 2 * HOSTS_PER_CPU
    with pytest.raises(InputError, match="expected at most 4 hosts on 1 CPU, got 5"):
        hosts_for(5, 2, 1)
    assert 1 <= machine_cpus() <= (os.cpu_count() or 1)
