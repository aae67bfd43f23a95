"""``python -m benchmarks`` (``make bench``): every benchmark that takes minutes rather than a quarter of an hour."""

from __future__ import annotations

import subprocess
import sys

NAMES = (
    "growth",
    "blocks_growth",
    "timed_rewriting",
    "timed_turtle",
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
)


def failed(name: str) -> bool:
    """Run one benchmark in a process of its own; tell whether it missed its limit."""
    return subprocess.run([sys.executable, "-m", f"benchmarks.{name}"], check=False).returncode != 0


def main() -> int:
    """Run all; give 1 when one missed its limit."""
    missed = [name for name in NAMES if failed(name)]
    print(f"missed: {', '.join(missed)}" if missed else "all within their limits")
    return bool(missed)


if __name__ == "__main__":
    raise SystemExit(main())
