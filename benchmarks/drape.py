"""The drape against random search with as many evaluations, over ten seeds (Mann-Whitney, one-sided, p < 0.01).

Random search scores as many random genomes by the same goals as the run scored individuals, and keeps the best.
"""

from __future__ import annotations

import json
import multiprocessing
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np
from scipy.stats import mannwhitneyu

from islands.kinds.registry import resolve_kind
from orchestrator.loading import load_experiment
from orchestrator.plan import make_plan

ROOT = Path(__file__).parents[1]
DRAPE = ROOT / "experiments" / "drape.yaml"
SEEDS = range(1, 11)
LEVEL = 0.01


def contest(seed: int) -> tuple[float, float, int]:
    """Give the best fitness of the run and of random search for one seed, and the evaluations of each."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "orchestrator.cli", "run", str(DRAPE), "--seed", str(seed), "--json"]
        command += ["--set", "backend=inline", "--runs-dir", folder]
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    outcome = json.loads(done.stdout.splitlines()[-1])
    return outcome["best"]["fitness"], random_search(seed, outcome["evaluations"]), outcome["evaluations"]


def random_search(seed: int, evaluations: int) -> float:
    """Give the best fitness among so many random genomes."""
    spec = make_plan(load_experiment(DRAPE)).islands[0]
    biology = resolve_kind(spec.kind, "islands").build(spec, time.perf_counter)
    rng = np.random.default_rng([seed, 1])
    found = (biology.evaluate(biology.random(rng)).fitness for _ in range(evaluations))
    return max(fitness for fitness in found if fitness is not None)


def main() -> bool:
    """Print both samples and the verdict of the test."""
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        results = pool.map(contest, SEEDS, chunksize=1)
    evolved, drawn = [row[0] for row in results], [row[1] for row in results]
    p = mannwhitneyu(evolved, drawn, alternative="greater").pvalue
    print(f"drape: {results[0][2]} evaluations each, best fitness over {len(results)} seeds")
    print("drape: evolved", *(f"{value:.3f}" for value in sorted(evolved)), f"median {median(evolved):.3f}")
    print("drape: random ", *(f"{value:.3f}" for value in sorted(drawn)), f"median {median(drawn):.3f}")
    print(f"drape: Mann-Whitney p = {p:.2g} (under {LEVEL:g} is wanted)")
    return bool(p < LEVEL)


if __name__ == "__main__":
    raise SystemExit(not main())
