"""Runs of an experiment by the command line, as a user starts them, for the benchmarks."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
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
