"""Sheets of a run's best plans."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from genome.errors import InputError
from genome.files import write_whole
from genome.settings import near
from growth.protocol import Failure
from islands.spec import IslandSpec
from orchestrator import regrow
from orchestrator.folder import RunFolder
from orchestrator.growing import check_output

if TYPE_CHECKING:
    from evaluators.plans.drawings import Drawing

LEVELS: Final = ("house", "zone", "room")
"""Kinds that draw plans, the uppermost first."""
SUFFIXES: Final = (".png", ".svg")


def write_sheet(folder: RunFolder, count: int, groups: Sequence[str], output: Path) -> None:
    """Draw the best plans of a run side by side (Rosenman 1997, Figure 10).

    Parameters
    ----------
    folder
        The run.
    count
        How many plans at most; those of equal scores count as one.
    groups
        Islands, or groups of them, by name; those of the uppermost level that the run has where none is named.
    output
        The file; its suffix chooses PNG or SVG.

    Raises
    ------
    InputError
        When the run has no plans, or no such islands, or the file cannot be written.
    """
    from evaluators.plans.drawings.draw import drawing
    from evaluators.plans.drawings.sheet import sheet_png, sheet_svg

    check_output(output, SUFFIXES)
    nursery = regrow.Nursery(folder)
    islands = _islands(nursery.specs, groups)
    drawings: list[Drawing] = []
    for logged in regrow.best(folder, count, islands) if islands else ():
        layout = nursery.layout(logged)
        if not isinstance(layout, Failure):
            drawings.append(drawing(layout, f"{logged.id}: {logged.fitness:g}"))
    if not drawings:
        raise InputError(folder.name, "a run with valid plans of rooms, zones or houses", "none in its log so far")
    write = sheet_png if output.suffix.lower() == ".png" else sheet_svg
    write_whole(output, write(drawings, ": ".join(dict.fromkeys((folder.name, ", ".join(islands))))))


def _islands(specs: Sequence[IslandSpec], groups: Sequence[str]) -> list[str]:
    """Find islands by their names or groups, or those of the uppermost level."""
    if not groups:
        levels = [[one.name for one in specs if one.kind == kind] for kind in LEVELS]
        return next((level for level in levels if level), [])
    known = list(dict.fromkeys(name for one in specs for name in (one.group, one.name)))
    for name in groups:
        if name not in known:
            raise InputError("--island", "an island of the run", f"'{name}'", near(name, known))
    return [one.name for one in specs if one.name in groups or one.group in groups]
