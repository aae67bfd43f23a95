"""What Rosenman's hierarchical evolution of houses reaches, measured over ten seeds.

``python -m benchmarks.houses_findings [rooms [paper] [mutation]] [house] [flat]`` runs, with seeds 1 to 10, two at a
time (some ten minutes):

- ``rooms``: the paper's eight rooms, by its own way (crossover alone, fresh runs) and with mutation: how many seeds
  reach the least perimeter and four corners, and after how many evaluations;
- ``house``: ``experiments/house.yaml``: how many seeds meet all adjacencies, and after how many evaluations in all;
- ``flat``: the same house as one genotype of 87 genes, with as many evaluations.
"""

from __future__ import annotations

import json
import math
import multiprocessing
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any, Final, NamedTuple

from evaluators.plans import Brief
from orchestrator.folder import RunFolder, open_run
from orchestrator.loading import load_experiment
from orchestrator.query import ask

ROOT: Final = Path(__file__).parents[1]
HOUSE: Final = ROOT / "experiments" / "house.yaml"
SEEDS: Final = range(1, 11)
ROOMS: Final[Mapping[str, int]] = {
    "living": 24, "dining": 15, "kitchen": 9, "entrance": 4,
    "master_bedroom": 15, "bedroom": 12, "bathroom": 6, "hall": 3,
}  # fmt: skip
POPULATION: Final = 60
GENERATIONS: Final = 300
"""18,000 evaluations a room; 30,000 are allowed."""

WAYS: Final[Mapping[str, Mapping[str, Any]]] = {
    "paper": {"crossover": 1.0, "mutation": 0.0, "restart": 32, "elite": 1},
    "mutation": {"crossover": 0.8, "mutation": 0.6, "elite": 1, "tournament": 2},
}
"""The paper's runs converge after 19 to 50 generations, 32 in the mean (section 4). Mutation pays where there
is little pressure."""


class Reached(NamedTuple):
    """What one run reached.

    Attributes
    ----------
    after
        By goal, after how many evaluations it was reached; nothing where it never was.
    figures
        Other figures, by name.
    """

    after: Mapping[str, int | None]
    figures: Mapping[str, float]


def rooms(way: str, seed: int) -> Reached:
    """Run all rooms by one way."""
    goals = {"perimeter_to_area": {"goal": "minimise"}, "corners": {"goal": "minimise", "scale": 20.0}}
    islands = {
        name: {"kind": "room", "population": POPULATION, "genome": {"cells": cells}, "fitness": goals,
               "algorithm": dict(WAYS[way])}
        for name, cells in ROOMS.items()
    }  # fmt: skip
    experiment = {
        "name": "rooms", "seed": seed, "epoch": 20, "generations": GENERATIONS, "backend": "inline",
        "islands": islands, "channels": [{"topology": "unconnected"}], "forms": {"best": 0},
    }  # fmt: skip

    def read(folder: RunFolder) -> Reached:
        after: dict[str, int | None] = {}
        for name, cells in ROOMS.items():
            least = 2 * math.ceil(2 * math.sqrt(cells))
            sql = f"""select min(id & ((1::bigint << 40) - 1)) from individuals where island = '{name}'
                      and scores['perimeter'] = {least} and scores['corners'] = 4"""  # noqa: S608 - own texts
            ((first,),) = ask(folder.log, sql).rows
            after[name] = None if first is None else first + 1
        return Reached(after, {})

    return _run(experiment, read)


def house(seed: int) -> Reached:
    """Run the paper's house."""

    def read(folder: RunFolder) -> Reached:
        # Levels run one after the other: all that was scored before the house's first full one counts.
        sql = """with good as (select min(generation) as first from individuals
                              where island = 'house' and scores['met'] = 1)
                 select coalesce(sum(evaluations) filter (island != 'house' or generation <= first), 0)::bigint,
                        any_value(first)
                 from generations, good"""
        ((evaluations, first),) = ask(folder.log, sql).rows
        all_of_it = ask(folder.log, "select sum(evaluations)::bigint from generations").rows[0][0]
        rim, angles = _of_best(folder, "house")
        return Reached(
            {"all adjacencies": None if first is None else int(evaluations)},
            {"evaluations": float(all_of_it), "perimeter": rim, "corners": angles},
        )

    return _run(None, read, "--seed", str(seed), "--set", "backend=inline", "--set", "forms.best=0")


def flat(seed: int, generations: int) -> Reached:
    """Run the flat genotype."""
    loaded = load_experiment(HOUSE)
    brief = Brief.model_validate(loaded.experiment.islands["house"].growth["brief"])
    goals = {
        "adjacency": {"goal": "minimise"},
        "shape": {"goal": "minimise"},
        "whole": {"goal": "maximise", "weight": 8.0},
    }
    island = {"kind": "benchmarks.flat_house:FlatHouseKind", "population": POPULATION, "fitness": goals,
              "growth": {"brief": brief.model_dump(mode="json", exclude_none=True)},
              "algorithm": dict(WAYS["mutation"])}  # fmt: skip
    experiment = {"name": "flat", "seed": seed, "epoch": 20, "generations": generations, "backend": "inline",
                  "islands": {"flat": island}, "forms": {"best": 0}}  # fmt: skip

    def read(folder: RunFolder) -> Reached:
        after = {}
        for name, condition in (
            ("all adjacencies", "scores['met'] = 1"),
            ("all rooms whole", "scores['whole'] = 1"),
            ("both", "scores['met'] = 1 and scores['whole'] = 1"),
        ):
            sql = f"select min(id) + 1 from individuals where {condition}"  # noqa: S608 - own texts
            after[name] = ask(folder.log, sql).rows[0][0]
        ((met, whole, shape),) = ask(
            folder.log,
            """select arg_max(scores['met'], fitness), arg_max(scores['whole'], fitness),
                      arg_max(scores['shape'], fitness)
               from individuals""",
        ).rows
        return Reached(after, {"met of the best": met, "whole of the best": whole, "shape of the best": shape})

    return _run(experiment, read)


def _of_best(folder: RunFolder, island: str) -> tuple[float, float]:
    sql = f"""select arg_max(scores['perimeter'], fitness), arg_max(scores['corners'], fitness)
              from individuals where island = '{island}'"""  # noqa: S608 - own texts
    ((rim, angles),) = ask(folder.log, sql).rows
    return float(rim), float(angles)


def _run(experiment: Mapping[str, Any] | None, read: Callable[[RunFolder], Reached], *options: str) -> Reached:
    with tempfile.TemporaryDirectory() as folder:
        path = HOUSE
        if experiment is not None:
            path = Path(folder) / "experiment.yaml"
            path.write_text(json.dumps(experiment), encoding="utf-8")  # JSON is YAML
        command = [sys.executable, "-m", "orchestrator.cli", "run", str(path), "--json", "--runs-dir", folder, *options]
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
        return read(open_run(json.loads(done.stdout.splitlines()[-1])["run"]))


Task = tuple[str, str, int, int]


def carried_out(task: Task) -> Reached:
    """Carry out a run: what, which way, which seed, how many generations."""
    what, way, seed, generations = task
    if what == "rooms":
        return rooms(way, seed)
    return house(seed) if what == "house" else flat(seed, generations)


def told(results: Sequence[Reached]) -> None:
    """Print a line for each goal and figure."""
    for goal in results[0].after:
        found = [one.after[goal] for one in results]
        good = [value for value in found if value is not None]
        after = f"{median(good):,.0f} ({min(good):,} to {max(good):,})" if good else "never"
        print(f"| {goal} | {len(good)} of {len(found)} | {after} |")
    for figure in results[0].figures:
        values = [one.figures[figure] for one in results]
        print(f"| {figure} | | {median(values):,.4g} ({min(values):,.4g} to {max(values):,.4g}) |")


def main(names: Sequence[str]) -> int:
    """Print the tables."""
    wanted = [name for name in names if name not in WAYS] or ("rooms", "house", "flat")
    ways = [way for way in WAYS if way in names] or list(WAYS)
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        spent = float(POPULATION * GENERATIONS)
        for what in wanted:
            for way in ways if what == "rooms" else ("",):
                generations = round(spent / POPULATION)
                tasks = [(what, way, seed, generations) for seed in SEEDS]
                results = pool.map(carried_out, tasks, chunksize=1)
                print(f"\n{what} {way}\n\n| goal | seeds that reach it | evaluations, median (least to most) |")
                print("|---|---|---|")
                told(results)
                if what == "house":
                    spent = max(one.figures["evaluations"] for one in results)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
