"""Troubles of coevolution without remedies and with them, over ten seeds: docs/experiments/arms_race.md reports it.

Each run of ``experiments/arms_race.yaml`` holds two pairs of species that differ by the remedy alone. Figures are means
over the second half of the epochs and over both islands of a pair; p is of the two-sided Mann-Whitney test against the
pair without a remedy. Whatever comes out is told.
"""

from __future__ import annotations

import json
import multiprocessing
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median

from scipy.stats import mannwhitneyu

from orchestrator.folder import open_run
from orchestrator.query import ask

ROOT = Path(__file__).parents[1]
RACE = ROOT / "experiments" / "arms_race.yaml"
SEEDS = range(1, 11)
LEVEL = 0.01
PLAIN = "the best of now"
CONTROL = "five best of now"
"""As many pairings as with the hall of fame."""

HALL = "hall of fame"

GAMES: Mapping[str, tuple[str, ...]] = {
    "rivalry": (),
    "agreement": (
        "defaults.fitness={agreement: {goal: maximise}}",
        "islands.plain-parasite.fitness={agreement: {goal: minimise}}",
        "islands.hall-parasite.fitness={agreement: {goal: minimise}}",
    ),
}
"""The race of the experiment; and one in which parasites want as little as can be of what hosts want: hosts follow,
parasites flee. There ones mean nothing."""


def remedy(pairing: str, count: int, sharing: str) -> tuple[str, ...]:
    """Give the settings of the second pair."""
    settings = [f"islands.hall-{end}.algorithm.sharing={sharing}" for end in ("host", "parasite")]
    for place in (2, 3):
        settings += [f"channels.{place}.pairing={pairing}", f"channels.{place}.count={count}"]
    return tuple(settings)


REMEDIES: Mapping[str, tuple[str, ...]] = {
    CONTROL: remedy("several", 5, "none"),
    "five best of now, shared": remedy("several", 5, "competitive"),
    HALL: remedy("archive", 1, "none"),
    "hall of fame, shared": remedy("archive", 1, "competitive"),
    "mixed": remedy("mixed", 5, "none"),
    "mixed, shared": remedy("mixed", 5, "competitive"),
}

FIGURES = ("archive score", "cycling", "distinct", "ones")
SQL = """
    with told as (
        select split_part(e.island, '-', 1) as pair, (detail->'archive'->>'mean')::double as score,
               ((detail->>'forgetting')::double > 0)::int as cycling, (detail->>'distinct')::double as variety,
               length(genotype) - length(replace(genotype, '1', '')) as ones
        from events as e join individuals as i on i.id = (detail->>'champion')::bigint
        where e.kind = 'coevolution' and e.epoch > (select max(epoch) / 2 from generations)
    )
    select pair, avg(score), avg(cycling), avg(variety), avg(ones) from told group by pair order by pair
"""
Row = tuple[float, ...]


def contest(task: tuple[str, str, int]) -> dict[str, Row]:
    """Run one game with one remedy and seed; give the figures of both pairs."""
    game, name, seed = task
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "orchestrator.cli", "run", str(RACE), "--seed", str(seed), "--json"]
        command += ["--runs-dir", folder]
        command += [part for one in (*GAMES[game], *REMEDIES[name]) for part in ("--set", one)]
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
        run = open_run(json.loads(done.stdout.splitlines()[-1])["run"])
        return {str(pair): (*row,) for pair, *row in ask(run.log, SQL).rows}


def told(game: str, name: str, found: Sequence[Row], plain: Sequence[Row]) -> str:
    """Give one line of the table."""
    cells = []
    for place in range(len(FIGURES)):
        values, before = [row[place] for row in found], [row[place] for row in plain]
        cell = f"{median(values):.3g}"
        if found is not plain:
            cell += f" ({mannwhitneyu(values, before).pvalue:.1g})"
        cells.append(cell)
    return f"| {game} | {name} | {' | '.join(cells)} |"


def main(games: Sequence[str]) -> bool:
    """Print the table of some games, and how sure it is that the hall of fame raises the archive score of rivals."""
    tasks = [(game, name, seed) for game in games for name in REMEDIES for seed in SEEDS]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        results = dict(zip(tasks, pool.map(contest, tasks, chunksize=1), strict=True))
    print("medians over ten seeds, in brackets p against the best of now")
    print(f"| game | paired with | {' | '.join(FIGURES)} |")
    print("|---|---|---|---|---|---|")
    worst = 0.0
    for game in games:
        # The pair without a remedy is the same whatever the other has.
        plain = [results[game, CONTROL, seed]["plain"] for seed in SEEDS]
        found = {name: [results[game, name, seed]["hall"] for seed in SEEDS] for name in REMEDIES}
        print(told(game, PLAIN, plain, plain))
        for name, rows in found.items():
            print(told(game, name, rows, plain))
        hall = [row[0] for row in found[HALL]]
        for name, rows in ((PLAIN, plain), (CONTROL, found[CONTROL])):
            p = mannwhitneyu(hall, [row[0] for row in rows], alternative="greater").pvalue
            print(f"arms_race: {game}, archive score, {HALL} above {name}: p = {p:.2g} (under {LEVEL:g} is wanted)")
            worst = max(worst, p)
    return bool(worst < LEVEL)


if __name__ == "__main__":
    raise SystemExit(not main(sys.argv[1:] or [*GAMES]))
