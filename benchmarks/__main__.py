"""``python -m benchmarks`` (``make bench``): every ratio that README and docs claim, and the table that docs show.

Each benchmark measures side by side with its peer in one run. Peers that are engines of their own stand in an
environment of theirs, which ``make bench`` makes. What is found is written to ``docs/bench.md``. With names only those
are run, and nothing is written.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Final, NamedTuple

ROOT: Final = Path(__file__).parents[1]
PAGE: Final = ROOT / "docs" / "bench.md"

NAMES: Final = (
    "growth",
    "blocks_growth",
    "blocks_loads",
    "timed_rewriting",
    "timed_turtle",
    "timed_animation",
    "symbiosis_measures",
    "space_syntax",
    "houses",
    "bnf_mapping",
    "mesh_queries",
    "start",
    "islands",
    "schedules",
    "many_islands",
    "recovery",
    "endurance",
    "peers",
)


class Outcome(NamedTuple):
    """What a benchmark printed, and whether all was within its limits."""

    name: str
    lines: tuple[str, ...]
    met: bool


def measured(name: str) -> Outcome:
    """Run one benchmark in a process of its own, and show what it prints as it comes."""
    lines = []
    command = [sys.executable, "-u", "-m", f"benchmarks.{name}"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as process:
        assert process.stdout is not None
        for line in process.stdout:
            print(line, end="", flush=True)
            lines.append(line.rstrip())
    return Outcome(name, tuple(line for line in lines if line), process.returncode == 0)


def page(outcomes: Sequence[Outcome], now: datetime) -> str:
    """Write the page that docs show."""
    machine = f"{os.cpu_count()} CPUs ({platform.machine()}), Python {platform.python_version()}"
    rows = [f"| [`{one.name}`](#{one.name}) | {'yes' if one.met else '**no**'} |" for one in outcomes]
    texts = [f"## {one.name}\n\n```\n" + "\n".join(one.lines) + "\n```\n" for one in outcomes]
    return "\n".join(
        [
            "# What the benchmarks found",
            "",
            f"Written by `make bench` on {now:%Y-%m-%d}, on {machine}.",
            "[benchmarks/README.md](../benchmarks/README.md) says what each measures, and its limit.",
            "Each stands beside its peer in one run; ratios travel, times do not.",
            "",
            "| benchmark | within its limits |",
            "|---|---|",
            *rows,
            "",
            *texts,
        ]
    )


def main(names: Sequence[str]) -> int:
    """Run all, or those named; give 1 when one missed its limit."""
    outcomes = [measured(name) for name in names or NAMES]
    if not names:
        waiting = PAGE.with_suffix(".tmp")
        waiting.write_text(page(outcomes, datetime.now(UTC)), encoding="utf-8")
        waiting.replace(PAGE)
        print(f"written: {PAGE.relative_to(ROOT)}")
    missed = [one.name for one in outcomes if not one.met]
    print(f"missed: {', '.join(missed)}" if missed else "all within their limits")
    return bool(missed)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
