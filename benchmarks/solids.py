"""How many evolved forms ``atoll refine --recipe solid`` makes watertight.

``python -m benchmarks.solids [RUN]`` takes the best forms of every group of islands of a run, of ``experiments/
archipelago.yaml`` without (which it runs first, some six minutes in all), writes them as GLB, refines each to a solid,
writes it as STL, which knows no shared corners, and asks trimesh whether what it reads is watertight.
"""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Final

import trimesh
from click.testing import CliRunner

from orchestrator.cli import main
from orchestrator.folder import open_run
from orchestrator.refining import refine_form
from orchestrator.regrow import Nursery, best

ROOT: Final = Path(__file__).parents[1]
EACH: Final = 12
"""Forms of a group."""


def solids(run: str, folder: Path) -> tuple[Counter[str], Counter[str], list[str]]:
    """Count, by kind, the forms that were refined, and those that are watertight; name the others with the reason."""
    found = open_run(run)
    nursery = Nursery(found)
    groups: dict[str, list[str]] = {}
    kinds: dict[str, str] = {}
    for spec in nursery.specs:
        groups.setdefault(spec.group, []).append(spec.name)
        kinds[spec.group] = spec.kind
    tried: Counter[str] = Counter()
    closed: Counter[str] = Counter()
    failed: list[str] = []
    for group, islands in groups.items():
        for logged in best(found, EACH, islands):
            for form in nursery.write_forms(logged, folder, ("glb",)):
                tried[kinds[group]] += 1
                solid = form.with_suffix(".stl")
                told = refine_form(form, "solid", (), solid)
                if isinstance(told, dict) and trimesh.load_mesh(solid).is_watertight:
                    closed[kinds[group]] += 1
                else:
                    failed.append(
                        told if isinstance(told, str) else f"{form.name}: not watertight when it is read again"
                    )
    return tried, closed, failed


def report(run: str, folder: Path) -> None:
    """Print the counts, and what failed."""
    tried, closed, failed = solids(run, folder)
    for kind, count in tried.items():
        print(f"{kind:12} {closed[kind]:4} of {count}")
    print(f"{'all':12} {closed.total():4} of {tried.total()}: {100 * closed.total() / tried.total():.1f}%")
    print(*failed, sep="\n")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="atoll-") as here:
        if len(sys.argv) > 1:
            report(sys.argv[1], Path(here))
        else:
            run = ["run", str(ROOT / "experiments" / "archipelago.yaml"), "--runs-dir", here, "--name", "solids"]
            done = CliRunner().invoke(main, run)
            assert done.exit_code == 0, done.output
            report(f"{here}/solids", Path(here))
