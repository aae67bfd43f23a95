"""What Senatore's thesis finds of evolved block bodies, measured anew over ten seeds each.

``python -m benchmarks.blocks_findings`` runs the experiments named in ``MEASURES`` with seeds 1 to 10, two at a time
(some eight minutes), and prints a line for each measure: medians over the seeds of both sides, how many seeds agree
with the thesis, and the two-sided p of Wilcoxon's signed-rank test. Nothing is expected of the answers: whatever comes
out is what docs/blocks.md reports.
"""

from __future__ import annotations

import json
import multiprocessing
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Literal, NamedTuple

from scipy.stats import wilcoxon

from orchestrator.folder import open_run
from orchestrator.query import ask

ROOT = Path(__file__).parents[1]
SEEDS = range(1, 11)
LATE = 10
"""Generations at the end of a run that count as its end."""

SIZES = (2, 6, 11, 21, 41, 81, 161, 1000)
"""Blocks at which the classes of size begin, in which bodies are compared with others of their size."""

Rows = list[tuple[float, ...]]


class Measure(NamedTuple):
    """A figure on two sides that the thesis says something about.

    Attributes
    ----------
    name
        What is measured.
    sides
        What the two figures are of.
    way
        Whether the thesis has the second side above the first, or below.
    read
        From a run's query function to both figures.
    """

    name: str
    sides: tuple[str, str]
    way: Literal["rises", "falls"]
    read: Callable[[Callable[[str], Rows]], tuple[float, float]]


def over_time(score: str) -> Callable[[Callable[[str], Rows]], tuple[float, float]]:
    """Compare the first population with what was bred at the end: means over the valid."""

    def read(query: Callable[[str], Rows]) -> tuple[float, float]:
        sql = f"""with last as (select max(generation) as last from individuals)
                  select avg({score}) filter (generation = 0), avg({score}) filter (generation > last - {LATE})
                  from individuals, last where valid"""  # noqa: S608 - this file's own texts
        ((before, after),) = query(sql)
        return before, after

    return read


def of_best(score: str) -> Callable[[Callable[[str], Rows]], tuple[float, float]]:
    """Compare the best of the first population with the best ever bred."""

    def read(query: Callable[[str], Rows]) -> tuple[float, float]:
        sql = f"""select arg_max({score}, (fitness, -id)) filter (generation = 0), arg_max({score}, (fitness, -id))
                  from individuals where valid"""  # noqa: S608 - this file's own texts
        ((before, after),) = query(sql)
        return before, after

    return read


def under_load(score: str, *, matched: bool = False) -> Callable[[Callable[[str], Rows]], tuple[float, float]]:
    """Compare what was bred at the end on ``free`` with ``loaded``: means over different bodies.

    With ``matched`` the means are over classes of size, each weighing as much as the side with fewer bodies in it has.
    """

    def read(query: Callable[[str], Rows]) -> tuple[float, float]:
        size = " + ".join(f"(scores['blocks'] >= {edge})::int" for edge in SIZES) if matched else "0"
        sql = f"""with last as (select max(generation) as last from individuals),
                  bodies as (select distinct island, scores from individuals, last
                             where valid and generation > last - {LATE}),
                  classes as (select island, {score} as value, {size} as class from bodies)
                  select class, avg(value) filter (island = 'free'), avg(value) filter (island = 'loaded'),
                         least(count(*) filter (island = 'free'), count(*) filter (island = 'loaded')) as fewer
                  from classes group by class order by class"""  # noqa: S608 - this file's own texts
        rows = [row for row in query(sql) if row[3]]
        weight = sum(row[3] for row in rows)
        if not weight:
            return 0.0, 0.0
        free, loaded = (sum(row[side] * row[3] for row in rows) / weight for side in (1, 2))
        return free, loaded

    return read


TOGETHER = "(scores['meet'] = 1 and scores['alone_first'] = 0 and scores['alone_second'] = 0)::int"
START_END = ("first population", "last generations")
BEST = ("best at first", "best ever")
LOAD = ("without load", "under load")

VARIANTS: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "bridge, dear feet": ("bridge", ("islands.bridge.fitness.ground.scale=0.75",)),
}
"""Experiments with other settings, by the names of their measures: a foot costs eight cells of span, and not one."""

MEASURES: Mapping[str, Sequence[Measure]] = {
    "bridge": (
        Measure("span along x", START_END, "rises", over_time("scores['span_x']")),
        Measure("ground contacts", START_END, "falls", over_time("scores['ground']")),
        Measure("ground contacts for each cell of span", START_END, "falls",
                over_time("scores['ground'] / scores['span_x']")),
        Measure("span along x", BEST, "rises", of_best("scores['span_x']")),
        Measure("ground contacts", BEST, "falls", of_best("scores['ground']")),
    ),
    "bridge, dear feet": (
        Measure("span along x", START_END, "rises", over_time("scores['span_x']")),
        Measure("ground contacts", START_END, "falls", over_time("scores['ground']")),
        Measure("span along x", BEST, "rises", of_best("scores['span_x']")),
        Measure("ground contacts", BEST, "falls", of_best("scores['ground']")),
    ),
    "high_rise": (
        Measure("height", START_END, "rises", over_time("scores['height']")),
        Measure("accessibility", START_END, "rises", over_time("scores['accessibility']")),
        Measure("height", BEST, "rises", of_best("scores['height']")),
    ),
    "helix": (
        Measure("helicity", LOAD, "rises", under_load("scores['helicity']")),
        Measure("helicity among bodies of one size", LOAD, "rises", under_load("scores['helicity']", matched=True)),
        Measure("height", LOAD, "falls", under_load("scores['height']")),
    ),
    "symmetry": (
        Measure("symmetry", LOAD, "rises", under_load("scores['symmetry']")),
        Measure("symmetry among bodies of one size", LOAD, "rises", under_load("scores['symmetry']", matched=True)),
        Measure("blocks", LOAD, "falls", under_load("scores['blocks']")),
    ),
    "structural_pair": (
        Measure("share of pairs that stand together and not apart", START_END, "rises", over_time(TOGETHER)),
        Measure("the best stands together and not apart", BEST, "rises", of_best(TOGETHER)),
        Measure("height", BEST, "rises", of_best("scores['height']")),
    ),
}  # fmt: skip


def figures(task: tuple[str, int]) -> list[tuple[float, float]]:
    """Run an experiment with a seed and read its measures."""
    name, seed = task
    experiment, settings = VARIANTS.get(name, (name, ()))
    with tempfile.TemporaryDirectory() as folder:
        command = [
            sys.executable,
            "-m",
            "orchestrator.cli",
            "run",
            str(ROOT / "experiments" / f"{experiment}.yaml"),
            "--json",
        ]
        command += ["--seed", str(seed), "--runs-dir", folder]
        command += [part for one in ("backend=inline", *settings) for part in ("--set", one)]
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
        run = open_run(json.loads(done.stdout.splitlines()[-1])["run"])
        return [measure.read(lambda sql: ask(run.log, sql).rows) for measure in MEASURES[name]]


def told(name: str, measure: Measure, pairs: Sequence[tuple[float, float]]) -> str:
    """Give a measure's line of the table."""
    differences = [after - before for before, after in pairs]
    agree = sum(one > 0 if measure.way == "rises" else one < 0 for one in differences)
    p = wilcoxon(differences).pvalue if any(differences) else 1.0
    sides = [median(pair[side] for pair in pairs) for side in (0, 1)]
    change = " to ".join(f"{value:.3g} ({of})" for value, of in zip(sides, measure.sides, strict=True))
    return f"| {name} | {measure.name} | {change} | {agree} of {len(pairs)} | {p:.2g} |"


def main(names: Sequence[str]) -> int:
    """Print the table."""
    wanted = names or list(MEASURES)
    tasks = [(name, seed) for name in wanted for seed in SEEDS]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        results = pool.map(figures, tasks, chunksize=1)
    print("| experiment | measure | medians over ten seeds | seeds as the thesis says | p |")
    print("|---|---|---|---|---|")
    for name in wanted:
        found = [result for (of, _), result in zip(tasks, results, strict=True) if of == name]
        for place, measure in enumerate(MEASURES[name]):
            print(told(name, measure, [one[place] for one in found]))
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
