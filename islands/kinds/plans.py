"""Plans as files: drawings for an architect, and the genotype as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, Protocol, runtime_checkable

from evaluators.plans import Brief, Layout, laid_out
from genome.errors import InputError
from genome.files import write_whole
from genome.polyform import Assembly, Room, encode
from growth.polyforms import Plan
from growth.protocol import Failure
from islands.kinds.protocol import Facts

FORMATS: Final = ("svg", "dxf", "ifc", "glb", "png", "json")
USUAL: Final = ("svg", "glb", "json")
"""What is written where no format is asked for; of plans of cubes what can be."""


@runtime_checkable
class Planner(Protocol):
    """A biology whose genotypes grow to plans."""

    def layout(self, genotype: Any, /) -> Layout | Failure:  # noqa: ANN401 - whatever the biology breeds
        """Grow a plan and lay it out."""


def write_plans(
    genotype: Room | Assembly, plan: Plan | Failure, brief: Brief, stem: Path, formats: Sequence[str], facts: Facts
) -> list[Path]:
    """Write a plan in some formats, the usual ones without; nothing where there is no plan.

    Raises
    ------
    InputError
        For another format, or one that plans of cubes have no drawing for.
    """
    from evaluators.plans.drawings.files import OF_CUBES, write_plan

    for suffix in formats:
        if suffix not in FORMATS:
            raise InputError("--format", f"one of {', '.join(FORMATS)}", f"'{suffix}'")
    if isinstance(plan, Failure):
        return []
    usual = [suffix for suffix in USUAL if suffix in (*OF_CUBES, "json")] if plan.tiling.solid else USUAL
    layout = laid_out(plan, brief)
    files = []
    for suffix in formats or usual:
        path = stem.with_name(f"{stem.name}.{suffix}")
        if suffix == "json":
            write_whole(path, encode(genotype).encode())
        else:
            write_plan(layout, path, _title(facts, stem), facts)
        files.append(path)
    return files


def _title(facts: Mapping[str, str | float | bool], stem: Path) -> str:
    """Name a plan by its run, its island and its number, where they are known."""
    words = [str(facts[key]) for key in ("run", "island", "id") if facts.get(key)]
    return " ".join(dict.fromkeys(words)) if words else stem.name
