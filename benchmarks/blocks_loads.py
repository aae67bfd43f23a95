"""Load models of block bodies against each other and against PyNiteFEA: agreement, and speed as ratios.

make peers                                  # once, for PyNiteFEA
python -m benchmarks.blocks_loads           # the tables of docs/blocks.md
python -m benchmarks.blocks_loads --record  # tests/evaluators/blocks/pynite.json anew
"""

from __future__ import annotations

import argparse
import itertools
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.timing import best_of
from evaluators.blocks.load import Load, LoadSettings, analyse
from evaluators.blocks.load.frame import AREA, BENDING, POISSON, TORSION, frame
from genome.lsystem import LSystemGenome, decode, random_system
from growth.blocks import BlockGrowth, Body, grow, stand
from growth.blocks.body import BOUNDARY
from growth.blocks.lattice import CUBIC

ROOT = Path(__file__).parents[1]
RECORD = ROOT / "tests" / "evaluators" / "blocks" / "pynite.json"
COUNT, LEAST, MOST = 500, 30, 300
EXPERIMENTS, SEEDS = ("bridge", "high_rise", "helix", "symmetry"), range(1, 3)
BRED = f"valid and scores['blocks'] between {LEAST} and {MOST} and generation > 0"
SMALL, FEW = 60, 40
LIMITS = 100
LARGEST_LIMIT = 150
"""The linear programs take up to seconds each: as many bodies, of so many blocks at most."""


def walk(rng: np.random.Generator, count: int, branch: float, straight: float) -> Body:
    """Grow a body by a walk that goes straight on, turns, or starts anew from an earlier block."""
    cells, at, way = [(0, 0, 0)], (0, 0, 0), CUBIC.heading
    seen = {at}
    while len(cells) < count:
        if rng.random() < branch:
            at = cells[rng.integers(len(cells))]
        if rng.random() > straight:
            way = int(rng.integers(len(CUBIC.offsets)))
        x, y, z = CUBIC.offsets[way].tolist()
        at = (at[0] + x, at[1] + y, at[2] + z)
        if at not in seen:
            seen.add(at)
            cells.append(at)
    return stand(np.array(cells), BlockGrowth())


def walks(rng: np.random.Generator, most: int = MOST) -> list[Body]:
    """Give bodies of random walks, from stringy to clotted."""
    draws = ((int(rng.integers(LEAST, most + 1)), rng.uniform(0.05, 0.4), rng.uniform(0.1, 0.9)) for _ in range(COUNT))
    return [walk(rng, *draw) for draw in draws]


def words(rng: np.random.Generator) -> list[Body]:
    """Give bodies of random L-systems."""
    out: list[Body] = []
    while len(out) < COUNT:
        body = grow(random_system(LSystemGenome(), rng), BlockGrowth(max_blocks=MOST))
        if isinstance(body, Body) and len(body.internal) >= LEAST:
            out.append(body)
    return out


def evolved(rng: np.random.Generator) -> list[Body]:
    """Give a sample of the bodies of such size that experiments bred, none twice."""
    from orchestrator.folder import open_run
    from orchestrator.query import ask

    found: dict[str, tuple[str, ...]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, seed in itertools.product(EXPERIMENTS, SEEDS):
            words = [str(ROOT / "experiments" / f"{name}.yaml"), "--runs-dir", folder, "--name", f"{name}-{seed}"]
            words += ["--seed", str(seed), "--set", "backend=inline", "--json"]
            command = [sys.executable, "-m", "orchestrator.cli", "run", *words]
            subprocess.run(command, check=True, cwd=ROOT, capture_output=True)
            run = open_run(f"{folder}/{name}-{seed}")
            rows = ask(run.log, f"select distinct genotype from individuals where {BRED}").rows  # noqa: S608
            found[f"{name}-{seed}"] = tuple(sorted(row[0] for row in rows))
    share = -(-COUNT // len(found))
    out: list[Body] = []
    for genotypes in found.values():
        for place in rng.permutation(len(genotypes))[:share].tolist():
            body = grow(decode(genotypes[place]), BlockGrowth(max_blocks=MOST))
            assert isinstance(body, Body)
            out.append(body)
    return out


def largest(load: Load) -> float:
    """Give the largest joint force."""
    return float(load.translational.max())


def correlations(bodies: list[Body]) -> dict[str, tuple[float, float]]:
    """Give each model's rank correlation with ``frame``: of the largest joint force, and of the largest moment."""
    from scipy.stats import spearmanr

    found: dict[str, list[Load]] = {name: [] for name in ("frame", "rigid", "galasyn", "frame, bending doubled")}
    for body in bodies:
        for name in ("frame", "rigid", "galasyn"):
            found[name].append(analyse(body, LoadSettings(model=name)))
        found["frame, bending doubled"].append(frame(body, LoadSettings(model="frame"), bending=2.0))
    worst = max(load.residual for name in ("frame", "rigid") for load in found[name])
    print(f"largest residual of rigid and frame {worst:.1e}; of galasyn, median and largest:", end=" ")
    residuals = [load.residual for load in found["galasyn"]]
    print(f"{np.median(residuals):.2g}, {max(residuals):.2g}")
    reference = found.pop("frame")
    out = {}
    for name, loads in found.items():
        force = spearmanr([largest(load) for load in reference], [largest(load) for load in loads]).statistic
        moments = [[load.torsional.max() for load in both] for both in (reference, loads)]
        out[name] = (float(force), float(spearmanr(*moments).statistic))
        ratio = np.array([largest(a) / largest(b) for a, b in zip(loads, reference, strict=True)])
        low, middle, high = np.quantile(ratio, (0.1, 0.5, 0.9))
        print(f"| {name} | {out[name][0]:.3f} | {out[name][1]:.3f} | {low:.2f} / {middle:.2f} / {high:.2f} |")
    return out


def agreement(bodies: list[Body]) -> None:
    """Print how often each model's verdict is that of ``limit``, with strengths at which half of the bodies stand."""
    loads = [analyse(body, LoadSettings(model="frame")) for body in bodies]
    axial = float(np.median([largest(load) for load in loads]))
    torsion = float(np.median([load.torsional.max() for load in loads]))
    strengths = {"axial_strength": axial * 1.2, "torsion_strength": torsion * 1.2}
    print(f"strengths: axial {strengths['axial_strength']:.4g}, torsion {strengths['torsion_strength']:.4g}")

    def stable(name: str) -> NDArray[np.bool_]:
        settings = LoadSettings.model_validate({"model": name, **strengths})
        return np.array([analyse(body, settings).stable for body in bodies])

    truth = stable("limit")
    for name in ("frame", "rigid", "galasyn"):
        said = stable(name)
        counts = [np.count_nonzero(a & b) for a, b in ((said, truth), (~said, ~truth), (said, ~truth), (~said, truth))]
        print(f"| {name} | {' | '.join(str(count) for count in counts)} |")


def asked(body: Body, load: Load) -> dict[str, Any]:
    """Write a body's frame down for PyNite."""
    return {
        "nodes": body.cells.tolist(),
        "clamped": np.flatnonzero(body.systems == BOUNDARY).tolist(),
        "members": load.joints.tolist(),
        "section": [1.0, 1.0 / (2.0 * (1.0 + POISSON)), AREA, BENDING, TORSION],
        "weight": 1.0,
    }


def pynite(python: Path, frames: list[dict[str, Any]], rounds: int) -> list[dict[str, Any]]:
    """Let PyNiteFEA solve frames in the peers' environment."""
    side = Path(__file__).parent / "peers" / "pynite_side.py"
    text = json.dumps({"frames": frames, "rounds": rounds})
    done = subprocess.run([str(python), str(side)], input=text, capture_output=True, text=True, check=True)
    answers: list[dict[str, Any]] = json.loads(done.stdout)
    return answers


def speed(python: Path) -> bool:
    """Print ratios at 400 blocks; tell whether they are within the limits."""
    body = walk(np.random.default_rng(1), 400, 0.15, 0.6)
    times = {}
    for name in ("rigid", "galasyn", "frame"):
        settings = LoadSettings(model=name)
        (times[name],) = best_of(lambda settings=settings: analyse(body, settings), rounds=15)
    load = analyse(body, LoadSettings(model="frame"))
    peer = pynite(python, [asked(body, load)], 3)[0]["seconds"]
    print(f"400 blocks, {len(load.joints)} joints: PyNiteFEA {peer:.2f} s")
    good = peer / times["frame"] >= 5
    for name, taken in times.items():
        print(f"| {name} | {peer / taken:.0f} | {times['frame'] / taken:.1f} |")
        good = good and (name == "frame" or (peer / taken >= 50 and times["frame"] / taken >= 10))
    return good


def recorded() -> dict[str, Body]:
    """Give the ten bodies whose frames the tests compare: five by hand with loops or trees, and walks."""
    ring = [(0, 0, 0), (1, 0, 1), (2, 0, 2), (1, 0, 3), (0, 0, 4), (-1, 0, 3), (-2, 0, 2), (-1, 0, 1)]
    table = [*((x, y, z) for x in (0, 3) for y in (0, 3) for z in range(3))]
    table += [(x, y, 3) for x in range(4) for y in range(4) if x in (0, 3) or y in (0, 3)]
    arch = [*((x, 0, z) for x in (-2, 2) for z in range(4)), *((x, 0, 3) for x in (-1, 0, 1))]
    edges = [(0, 0, 0), (1, 0, 1), (2, 1, 1), (3, 1, 2), (3, 2, 3), (2, 2, 4), (0, 0, 2), (0, -1, 3)]
    corners = [(0, 0, 0), (1, 1, 1), (2, 2, 2), (3, 1, 3), (2, 0, 4), (1, 3, 3), (0, 4, 4)]
    by_hand = {"column": [(0, 0, z) for z in range(6)], "arch": arch, "ring": ring, "table": table}
    by_hand |= {"tree over edges": edges, "tree over corners": corners}
    bodies = {name: stand(np.array(cells), BlockGrowth()) for name, cells in by_hand.items()}
    wall = BlockGrowth(supports=((-1, 0, 0),))
    bodies["cantilever"] = stand(np.array([(x, 0, 0) for x in range(5)]), wall)
    for seed, straight in enumerate((0.2, 0.5, 0.8)):
        bodies[f"walk {seed}"] = walk(np.random.default_rng(seed), 25, 0.2, straight)
    return bodies


def record(python: Path) -> None:
    """Write what PyNiteFEA finds for the ten bodies."""
    rows = []
    for name, body in recorded().items():
        load = analyse(body, LoadSettings(model="frame"))
        answer = pynite(python, [asked(body, load)], 1)[0]
        carried = [[float(f"{value:.10g}") + 0.0 for value in row] for row in answer["carried"]]
        one = {"name": name, "cells": body.cells.tolist(), "systems": body.systems.tolist()}
        rows.append({**one, "joints": load.joints.tolist(), "carried": carried})
    RECORD.write_text("[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]\n", encoding="utf-8")


def examples() -> None:
    """Print the largest force and moment, by model, of shapes that are easily understood."""
    wall = BlockGrowth(supports=tuple((-1, y, z) for y in range(2) for z in range(2)))
    bars = {f"cantilever of 8, {high} high": [(x, 0, z) for x in range(8) for z in range(high)] for high in (1, 2)}
    bars["cantilever of 8, 2 high and wide"] = [(x, y, z) for x in range(8) for y in range(2) for z in range(2)]
    sides = [(x, 0, z) for x in (-3, 3) for z in range(4)]
    ground = {"arch, 7 wide and 4 high": [*sides, *((x, 0, 3) for x in range(-2, 3))]}
    ground["leaning column of 8"] = [(z, 0, z) for z in range(8)]
    bodies = {name: stand(np.array(cells), wall) for name, cells in bars.items()}
    bodies |= {name: stand(np.array(cells), BlockGrowth()) for name, cells in ground.items()}
    for name, body in bodies.items():
        loads = [
            analyse(body, LoadSettings.model_validate({"model": model})) for model in ("frame", "rigid", "galasyn")
        ]
        cells = [f"{largest(load):.2f}, {load.torsional.max():.2f}" for load in loads]
        print(f"| {name} | {' | '.join(cells)} | {loads[2].residual:.2f} |")


def main() -> int:
    """Print the tables; give 1 when a limit is missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--record", action="store_true", help="write the table that the tests compare with")
    parser.add_argument("--peers", type=Path, default=ROOT / ".venv-peers" / "bin" / "python")
    flags = parser.parse_args()
    if flags.record:
        record(flags.peers)
        return 0
    examples()
    good = speed(flags.peers)
    for name, source in (("evolved", evolved), ("random walks", walks), ("random L-systems", words)):
        bodies = source(np.random.default_rng(7))
        print(f"{name}: {len(bodies)} bodies of {LEAST} to {MOST} blocks")
        good = correlations(bodies)["rigid"][0] >= 0.9 and good
        if source is evolved:
            few = [body for body in bodies if len(body.internal) <= SMALL][:FEW]
            print(f"verdicts on {len(few)} of them of {LEAST} to {SMALL} blocks, beside limit's")
            agreement(few)
    few = walks(np.random.default_rng(8), LARGEST_LIMIT)[:LIMITS]
    print(f"verdicts on {LIMITS} walks of {LEAST} to {LARGEST_LIMIT} blocks, beside limit's")
    agreement(few)
    return 0 if good else 1


if __name__ == "__main__":
    raise SystemExit(main())
