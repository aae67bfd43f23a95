"""Atoll against pygmo's archipelago (mp_island), LEAP with dask and DEAP with multiprocessing on one shared problem.

All score as many strings on two processes, start-up aside; what counts is wall time for each. With constant times of
about a millisecond Atoll is to take at most 1.05 of the best peer's, with log-normal times (sigma 1) less than any.

    make peers                       # once: an environment of their own for the peers
    python -m benchmarks.peers
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from pathlib import Path

from benchmarks.peers.problem import DEME, EPOCH, GENERATIONS, ISLANDS, cost, evaluations
from benchmarks.runs import run

ROOT = Path(__file__).parents[2]
PEERS = ROOT / ".venv-peers" / "bin" / "python"
ROUNDS = 3
LIMIT = {"constant": 1.05, "lognormal": 1.0}
EXPERIMENT = f"""
name: peers
epochs: {GENERATIONS // EPOCH}
epoch: {EPOCH}
hosts: 2
forms: {{best: 0}}
islands:
  i:
    kind: benchmarks.peers.work:WorkKind
    count: {ISLANDS}
    population: {DEME}
    genome: {{length: 100}}
    fitness: {{ones: {{goal: maximise}}}}
    algorithm: {{name: plus, tournament: 3, crossover: 0.8, mutation: 0.5}}
channels:
  - {{kind: migrants, topology: ring, among: i, every: 1, count: 1}}
"""


def atoll(folder: Path, schedule: str, times: str, turn: int) -> float:
    """Run on two Ray hosts, with migration and log, and give seconds an evaluation, start-up aside."""
    settings = (f"schedule={schedule}", f"islands.i.growth.times={times}")
    told = run(folder, EXPERIMENT, f"{schedule}-{times}-{turn}", *settings)
    manifest = json.loads((folder / told["run"] / "manifest.json").read_text(encoding="utf-8"))
    # What is written after the last epoch counts.
    return float((manifest["wall_s"] - manifest["startup_s"]) / told["evaluations"])


def peer(name: str, times: str) -> float:
    """Run a peer and give seconds an evaluation, start-up aside."""
    command = [str(PEERS), f"{name}_side.py", times]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=Path(__file__).parent)
    told = json.loads(done.stdout.splitlines()[-1])
    return float(told["seconds"] / told["evaluations"])


def main() -> bool:
    """Print the ratios; tell whether they are within their limits."""
    if not PEERS.exists():
        print("peers: not measured; `make peers` makes the environment that the peers run in")
        return True
    kept = True
    print(f"peers: {evaluations()} evaluations on two processes; at its best one takes {cost() * 1e3:.3f} ms")
    with tempfile.TemporaryDirectory() as name:
        for times, limit in LIMIT.items():
            sides = {side: [] for side in ("dataflow", "async", "pygmo", "leap", "deap")}  # type: dict[str, list[float]]
            for turn in range(ROUNDS):
                for side, found in sides.items():
                    if side in ("dataflow", "async"):
                        found.append(atoll(Path(name), side, times, turn))
                    elif turn == 0 or side != "leap":
                        found.append(peer(side, times))
            best = {side: min(found) for side, found in sides.items()}
            ours = min(best["dataflow"], best["async"])
            theirs = min(best["pygmo"], best["leap"], best["deap"])
            figures = ", ".join(f"{side} {value * 1e3:.3f}" for side, value in best.items())
            print(f"peers: {times} times, ms of wall an evaluation: {figures}")
            print(f"peers: {times} ratio {ours / theirs:.3f} (at most {limit:.2f})")
            kept &= ours / theirs <= limit
    return kept


if __name__ == "__main__":
    raise SystemExit(not main())
