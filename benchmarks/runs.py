"""Runs of an experiment by the command line, as a user starts them, for the benchmarks."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil

ROOT = Path(__file__).parents[1]


def run(folder: Path, experiment: str, name: str, *overrides: str) -> dict[str, Any]:
    """Run an experiment to its end; give what the command said."""
    return watched(folder, experiment, name, *overrides)[0]


def watched(folder: Path, experiment: str, name: str, *overrides: str) -> tuple[dict[str, Any], float, float]:
    """Run an experiment; give what the command said, and the most MB that the driver and all hosts together held."""
    (folder / f"{name}.yaml").write_text(experiment, encoding="utf-8")
    command = [sys.executable, "-m", "orchestrator.cli", "run", f"{name}.yaml", "--json"]
    command += [part for one in overrides for part in ("--set", one)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    process = subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    peaks, over = [0.0, 0.0], threading.Event()
    watcher = threading.Thread(target=_watch, args=(process.pid, peaks, over))
    watcher.start()
    out, _ = process.communicate()
    over.set()
    watcher.join()
    if process.returncode:
        raise RuntimeError(f"the run {name} failed with {process.returncode}")
    return json.loads(out.splitlines()[-1]), peaks[0], peaks[1]


def _watch(pid: int, peaks: list[float], over: threading.Event) -> None:
    while not over.wait(0.5):
        try:
            driver = psutil.Process(pid)
            hosts = [child for child in driver.children(recursive=True) if child.name().startswith("ray::Host")]
            peaks[0] = max(peaks[0], driver.memory_info().rss / 1e6)
            peaks[1] = max(peaks[1], sum(host.memory_info().rss for host in hosts) / 1e6)
        except psutil.Error:
            continue


def stolen() -> float:
    """Give the seconds that a virtual machine's CPUs were taken away since it stands; 0 where nothing tells."""
    try:
        return int(Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()[8]) / os.sysconf(
            "SC_CLK_TCK"
        )
    except (OSError, IndexError, ValueError):
        return 0.0


def undisturbed(measure: Callable[[int], float], rounds: int, most: int = 8, share: float = 0.02) -> list[float]:
    """Measure some times, and once more for each time that the machine's CPUs were taken away meanwhile.

    Parameters
    ----------
    measure
        Gives seconds; is given the turn, from 0.
    rounds
        How many times are wanted.
    most
        After so many all that there are have to do.
    share
        Of the two cores' time, how much may be taken away.
    """
    quiet: list[float] = []
    noisy: list[float] = []
    for turn in range(most):
        began, before = time.perf_counter(), stolen()
        seconds = measure(turn)
        lost = (stolen() - before) / (2 * (time.perf_counter() - began))
        (quiet if lost <= share else noisy).append(seconds)
        if len(quiet) == rounds:
            return quiet
    print(f"(the machine's CPUs were taken away in {len(noisy)} of {most} rounds)")
    return quiet or noisy
