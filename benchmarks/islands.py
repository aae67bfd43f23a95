"""One run on two Ray hosts against two plain Python processes that evolve the same populations.

The plain processes neither migrate nor log: they are the floor. Evaluations all cost the same, so that both sides do
equal work whatever evolves. Start-up is left out on both sides: each is measured for a short and a long run, and the
difference counts. The ratio is to be at most 1.10.
"""

from __future__ import annotations

import json
import multiprocessing
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.fixed_work import Bits, BitsGenome, FixedWork, Work

ROOT = Path(__file__).parents[1]
ISLANDS, POPULATION, EPOCH, ELITE = 8, 40, 5, 1
SHORT, LONG = 2, 14
ROUNDS = 3
LIMIT = 1.10
EXPERIMENT = f"""
name: overhead
epochs: 2
epoch: {EPOCH}
hosts: 2
islands:
  i:
    kind: benchmarks.fixed_work:FixedWorkKind
    count: {ISLANDS}
    population: {POPULATION}
    fitness: {{ones: {{goal: maximise}}}}
    algorithm: {{elite: {ELITE}, tournament: 3, crossover: 0.8, mutation: 0.5}}
channels:
  - {{kind: migrants, topology: ring, among: i, every: 1, count: 2}}
"""


def atoll(folder: Path, epochs: int, name: str) -> float:
    """Run on two Ray hosts, with migration and log, and give the wall time in seconds, start-up included."""
    command = [sys.executable, "-m", "orchestrator.cli", "run", str(folder / "overhead.yaml"), "--json"]
    command += ["--runs-dir", str(folder), "--name", name, "--set", f"epochs={epochs}"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment, cwd=ROOT)
    return float(json.loads(done.stdout.splitlines()[-1])["wall_s"])


def plain(epochs: int) -> float:
    """Evolve the islands in two plain processes and give the seconds that the slower one took, start-up aside."""
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        pool.map(evolve, [(0, 1)] * 2, chunksize=1)  # compiled and warm
        return max(pool.map(evolve, [(number, epochs) for number in range(2)], chunksize=1))


def evolve(task: tuple[int, int]) -> float:
    """Evolve half of the islands one after the other, with the same selection and variation, nothing else."""
    number, epochs = task
    biology = FixedWork(BitsGenome(), Work(), time.perf_counter)
    rng = np.random.default_rng(number)
    started = time.perf_counter()
    for _ in range(ISLANDS // 2):
        deme = [scored(biology, biology.random(rng)) for _ in range(POPULATION)]
        for _ in range(epochs * EPOCH):
            deme = bred(biology, deme, rng)
    return time.perf_counter() - started


def bred(biology: FixedWork, deme: list[tuple[float, Bits]], rng: np.random.Generator) -> list[tuple[float, Bits]]:
    """Breed one generation."""
    following = [max(deme)]
    while len(following) < POPULATION:
        a, b = (max(deme[i] for i in rng.integers(POPULATION, size=3))[1] for _ in range(2))
        crossed = rng.random() < 0.8
        children = biology.crossover(a, b, rng) if crossed else (a, b)
        for child in children:
            mutated = not crossed or rng.random() < 0.5
            following.append(scored(biology, biology.mutate(child, rng) if mutated else child))
    return following[:POPULATION]


def scored(biology: FixedWork, genotype: Bits) -> tuple[float, Bits]:
    """Score a genotype."""
    return biology.evaluate(genotype).fitness or 0.0, genotype


def main() -> bool:
    """Print the ratio; tell whether it is within the limit."""
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "overhead.yaml").write_text(EXPERIMENT, encoding="utf-8")
        for turn in range(ROUNDS):
            ours.append(atoll(folder, LONG, f"long{turn}") - atoll(folder, SHORT, f"short{turn}"))
            theirs.append(plain(LONG) - plain(SHORT))
    ratio = min(ours) / min(theirs)
    print(f"islands: {LONG - SHORT} epochs of {ISLANDS} islands: Atoll on two hosts {min(ours):.2f} s, ", end="")
    print(f"two plain processes {min(theirs):.2f} s")
    print(f"islands: ratio {ratio:.3f} (at most {LIMIT:.2f})")
    return ratio <= LIMIT


if __name__ == "__main__":
    raise SystemExit(not main())
