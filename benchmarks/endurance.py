"""Whether memory stays as it is: resident MB of driver and hosts over ten thousand generations of tiny islands."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import psutil

from benchmarks.runs import ROOT

GENERATIONS, GROWTH = 10_000, 1.05
EXPERIMENT = f"""
name: endurance
generations: {GENERATIONS}
epoch: 5
hosts: 2
islands:
  isle: {{kind: bits, count: 4, population: 8, genome: {{length: 32}}, fitness: {{ones: {{goal: maximise}}}}}}
channels:
  - {{kind: migrants, topology: ring, among: isle}}
"""


def memory(process: subprocess.Popen[str]) -> tuple[float, float]:
    """Give the resident MB of the driver, and of its hosts together."""
    driver = psutil.Process(process.pid)
    hosts = [child for child in driver.children(recursive=True) if child.name().startswith("ray::Host")]
    return driver.memory_info().rss / 1e6, sum(host.memory_info().rss for host in hosts) / 1e6


def course(folder: Path) -> list[tuple[int, float, float]]:
    """Run it; give generation, driver's MB and hosts' MB whenever the run told how far it had come."""
    (folder / "endurance.yaml").write_text(EXPERIMENT, encoding="utf-8")
    command = [sys.executable, "-m", "orchestrator.cli", "run", "endurance.yaml", "--json"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    run = subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    assert run.stderr is not None
    found = []
    for line in run.stderr:
        told = re.match(r"epoch \d+/\d+ +generation (\d+)", line)
        if told and int(told[1]) < GENERATIONS:
            found.append((int(told[1]), *memory(run)))
    if run.wait():
        raise RuntimeError(f"the run failed with {run.returncode}")
    return found


def main() -> bool:
    """Print the course; tell whether memory at the end is what it was after a fifth."""
    with tempfile.TemporaryDirectory() as folder:
        rows = course(Path(folder))
    early = next(row for row in rows if row[0] >= GENERATIONS / 5)
    last = rows[-1]
    for generation, driver, hosts in (early, last):
        print(f"endurance: generation {generation}: driver {driver:.0f} MB, hosts {hosts:.0f} MB")
    growth = max(last[1] / early[1], last[2] / early[2])
    print(f"endurance: {growth:.3f} times as much at the end (under {GROWTH:g})")
    return growth < GROWTH


if __name__ == "__main__":
    raise SystemExit(not main())
