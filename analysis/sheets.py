"""Which sheet of forms fits a run: plans side by side, or islands over time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from analysis.contact_sheets import write_contact_sheet
from analysis.plan_sheets import LEVELS, write_plan_sheet
from genome.errors import InputError
from genome.settings import near
from orchestrator.folder import RunFolder
from orchestrator.growing import check_output
from orchestrator.regrow import Nursery

SUFFIXES: Final = (".png", ".svg")


def write_sheet(folder: RunFolder, count: int, groups: Sequence[str], output: Path) -> list[str]:
    """Draw a run's forms side by side.

    Where the islands that are to be shown breed nothing but plans, the best plans stand at one scale; otherwise there
    is a row for each island, with its best forms over time.

    Parameters
    ----------
    folder
        The run.
    count
        How many plans at most.
    groups
        Islands, or groups of them, by name; all where none is named.
    output
        The file: PNG, of plans also SVG.

    Returns
    -------
    What could not be shown, and why.

    Raises
    ------
    InputError
        When there is nothing to show, there are no such islands, or the file cannot be written.
    """
    check_output(output, SUFFIXES)
    nursery = Nursery(folder)
    known = list(dict.fromkeys(name for one in nursery.specs for name in (one.group, one.name)))
    for name in groups:
        if name not in known:
            raise InputError("--island", "an island of the run", f"'{name}'", near(name, known))
    shown = [one for one in nursery.specs if not groups or one.name in groups or one.group in groups]
    if all(one.kind in LEVELS for one in shown):
        levels = [[one.name for one in shown if one.kind == kind] for kind in LEVELS]
        write_plan_sheet(folder, nursery, count, [[one.name for one in shown]] if groups else levels, output)
        return []
    if output.suffix.lower() != ".png":
        raise InputError("-o", "a file that ends in .png", f"'{output}'", "only sheets of plans alone are drawn as SVG")
    return write_contact_sheet(folder, [one.name for one in shown], output)
