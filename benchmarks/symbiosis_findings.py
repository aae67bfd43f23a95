"""Whether enclosure and space gain by each other: coevolved against fixed random partners, and with the channel cut.

``python -m benchmarks.symbiosis_findings`` runs ``experiments/enclosure_space.yaml`` with seeds 1 to 10, on one island
of each species and on two, two runs at a time (some half an hour):

- ``coevolved``: as it stands;
- ``fixed``: each island keeps the partner that it was shown at first, the best of eight random ones of the first
  population, since many a random one is too small a room to be shown;
- ``cut``: the channels of partners carry in the first two epochs, and each island goes on with the partner that it has.

Of each run the champions of both species at its end are scored: with the partner that they evolved with (``own``), and
with each other as they are now (``together``). Two-sided p of Mann-Whitney's test.
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
from typing import Final, NamedTuple

from scipy.stats import mannwhitneyu

from islands.migration.channel import Migrant
from orchestrator.folder import RunFolder, open_run
from orchestrator.query import ask
from orchestrator.regrow import Nursery

ROOT: Final = Path(__file__).parents[1]
SEEDS: Final = range(1, 11)
NEVER: Final = 1_000_000
CUT: Final = 2

VARIANTS: Final[Mapping[str, Sequence[str]]] = {
    "coevolved": (),
    "fixed": tuple(
        f"channels.{{{channel}}}.{key}"
        for channel in ("walls", "rooms")
        for key in (f"every={NEVER}", "select=random", "count=8")
    ),
    "cut": tuple(f"channels.{{{channel}}}.until={CUT}" for channel in ("walls", "rooms")),
}
ISLANDS: Final[Mapping[int, Sequence[str]]] = {
    2: (),
    1: ("defaults.count=1",),
}


class Ended(NamedTuple):
    """How a run ended: means over its pairs of islands.

    Attributes
    ----------
    own, together
        Symbiotic scores; see the module's docstring.
    cells
        Of the champions of space.
    economy
        Of the champions of enclosure: enclosed over enclosed plus own volume; 0 of a solid block.
    """

    own: float
    together: float
    cells: float
    economy: float


CHAMPION: Final = """
    with scored as (
        select island, generation, id, fitness, scores from individuals
        union all select island, generation, id, fitness, scores from evaluations
    ), last as (select id, max(generation) as at from scored where island = '{island}' group by id)
    select s.id, s.scores, i.genotype from scored s join last l on s.id = l.id and s.generation = l.at
    join individuals i on i.id = s.id
    where s.island = '{island}' and s.fitness is not null
      and s.generation > (select max(generation) from scored) - 3
    order by s.fitness desc, s.id limit 1
"""


def ended(folder: RunFolder, pairs: int) -> Ended:
    """Score the champions of a run."""
    nursery = Nursery(folder)
    found = []
    for pair in range(pairs):
        walls, rooms = (f"{kind}-{pair}" if pairs > 1 else kind for kind in ("walls", "rooms"))
        ((wall, wall_scores, wall_text),) = ask(folder.log, CHAMPION.format(island=walls)).rows
        ((room, room_scores, room_text),) = ask(folder.log, CHAMPION.format(island=rooms)).rows
        biology, other = nursery.biology(walls), nursery.biology(rooms)
        shown = other.offer(other.decode(room_text), "partners")  # type: ignore[attr-defined]
        scored = biology.evaluate_with(  # type: ignore[attr-defined]
            biology.decode(wall_text), (Migrant(room, shown, None, (), ""),)
        )
        together = dict(scored.scores)
        own = (wall_scores["symbiotic"] + room_scores["symbiotic"]) / 2
        found.append((own, together["symbiotic"], together["space_cells"], together["economy"]))
        assert wall != room
    return Ended(*(sum(values) / len(found) for values in zip(*found, strict=True)))


def carried_out(task: tuple[str, int, int]) -> Ended:
    """Run a variant on so many islands of each species with a seed."""
    variant, islands, seed = task
    places = {"walls": 2, "rooms": 3} if islands > 1 else {"walls": 0, "rooms": 1}
    with tempfile.TemporaryDirectory() as folder:
        path = ROOT / "experiments" / "enclosure_space.yaml"
        if islands == 1:
            text = path.read_text(encoding="utf-8")
            path = Path(folder) / "alone.yaml"
            lines = [line for line in text.splitlines() if "topology: ring" not in line]
            path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        command = [sys.executable, "-m", "orchestrator.cli", "run", str(path), "--json", "--runs-dir", folder]
        command += ["--seed", str(seed)]
        settings = [one.format(**places) for one in VARIANTS[variant]]
        for one in ("backend=inline", "forms.best=0", *ISLANDS[islands], *settings):
            command += ["--set", one]
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
        return ended(open_run(json.loads(done.stdout.splitlines()[-1])["run"]), islands)


def told(name: str, results: Sequence[Ended]) -> str:
    """Give a line of the table."""
    cells = [f"{median(values):.3f} ({min(values):.2f} to {max(values):.2f})" for values in zip(*results, strict=True)]
    return f"| {name} | {' | '.join(cells)} |"


def main(names: Sequence[str]) -> int:
    """Print the tables."""
    wanted = [int(name) for name in names if name.isdigit()] or list(ISLANDS)
    variants = [name for name in VARIANTS if name in names or not any(one in VARIANTS for one in names)]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        for islands in wanted:
            print(f"\nislands of each species: {islands}\n")
            print("| variant | own | together | cells of space | economy |\n|---|---|---|---|---|")
            found = {
                variant: pool.map(carried_out, [(variant, islands, seed) for seed in SEEDS], chunksize=1)
                for variant in variants
            }
            for variant, results in found.items():
                print(told(variant, results))
            for variant in variants:
                if variant == "coevolved" or "coevolved" not in found:
                    continue
                for place, score in enumerate(("own", "together")):
                    sides = [[one[place] for one in found[which]] for which in ("coevolved", variant)]
                    p = mannwhitneyu(*sides, alternative="two-sided").pvalue
                    print(f"coevolved against {variant}, {score}: p = {p:.2g}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
