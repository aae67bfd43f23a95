"""Sheets of a run's best plans at one scale."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from genome.errors import InputError
from genome.files import write_whole
from growth.protocol import Failure
from orchestrator.folder import RunFolder
from orchestrator.regrow import Nursery, best

if TYPE_CHECKING:
    from evaluators.plans.drawings import Drawing

LEVELS: Final = ("house", "zone", "room")
"""Kinds that draw plans, the uppermost first."""


def write_plan_sheet(
    folder: RunFolder, nursery: Nursery, count: int, levels: Sequence[Sequence[str]], output: Path
) -> None:
    """Draw the best plans of some islands side by side (Rosenman 1997, Figure 10).

    Parameters
    ----------
    folder
        The run.
    nursery
        Its islands.
    count
        How many plans at most; those of equal scores count as one.
    levels
        Names of islands, all of which breed plans: the first level that has bred valid ones is drawn.
    output
        The file; its suffix chooses PNG or SVG.

    Raises
    ------
    InputError
        When the run has no valid plans of these islands, or the file cannot be written.
    """
    from evaluators.plans.drawings.draw import drawing
    from evaluators.plans.drawings.sheet import sheet_png, sheet_svg

    for islands in levels:
        drawings: list[Drawing] = []
        for logged in best(folder, count, islands) if islands else ():
            layout = nursery.layout(logged)
            if not isinstance(layout, Failure):
                drawings.append(drawing(layout, f"{logged.id}: {logged.fitness:g}"))
        if drawings:
            break
    else:
        raise InputError(folder.name, "a run with valid plans of rooms, zones or houses", "none in its log so far")
    write = sheet_png if output.suffix.lower() == ".png" else sheet_svg
    write_whole(output, write(drawings, ": ".join(dict.fromkeys((folder.name, ", ".join(islands))))))
