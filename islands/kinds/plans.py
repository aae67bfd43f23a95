"""Plans as files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from evaluators.plans import Brief
from genome.errors import InputError
from genome.files import write_whole
from genome.polyform import Assembly, Room, encode
from growth.polyforms import Plan
from growth.protocol import Failure
from islands.kinds.protocol import Facts

FORMATS: Final = ("json",)
USUAL: Final = ("json",)


def write_plans(
    genotype: Room | Assembly, plan: Plan | Failure, brief: Brief, stem: Path, formats: Sequence[str], facts: Facts
) -> list[Path]:
    """Write a plan in some formats, the usual ones without; nothing where there is no plan.

    Raises
    ------
    InputError
        For another format.
    """
    del brief, facts
    for suffix in formats:
        if suffix not in FORMATS:
            raise InputError("--format", f"one of {', '.join(FORMATS)}", f"'{suffix}'")
    if isinstance(plan, Failure):
        return []
    files = []
    for suffix in formats or USUAL:
        path = stem.with_name(f"{stem.name}.{suffix}")
        write_whole(path, encode(genotype).encode())
        files.append(path)
    return files
