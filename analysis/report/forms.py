"""The contact sheet of a report."""

from __future__ import annotations

import base64
from collections.abc import Sequence

from analysis.contact_sheets import said
from analysis.report.parts import Figure, Picture, Section, asked
from analysis.stages import SQL, Cell, stages
from analysis.thumbnails import Thumbnails, jpeg
from orchestrator.folder import RunFolder


def forms(folder: RunFolder, islands: Sequence[str]) -> Section:
    """Draw each island's best forms over time."""
    plan = stages(folder, islands)
    sql, answer = asked(folder, SQL)
    thumbnails = Thumbnails(folder)
    sheet = tuple((row.island, tuple(_picture(cell, thumbnails) for cell in row.cells)) for row in plan.rows)
    text = (
        "Of each island the best that it bred in an epoch, or in the last one before in which it bred a valid one, "
        "and the best of all; "
        "species that are scored with partners stand among those that they were first scored with."
    )
    if not sheet:
        return Section("forms", "Forms", "No individual is valid.", troubles=tuple(said(plan)))
    figure = Figure("Which individuals are shown", sql, answer, note="Of each island and epoch the best bred in it.")
    troubles = (*said(plan), *thumbnails.troubles)
    return Section("forms", "Forms", text, (figure,), sheet, plan.columns, troubles=troubles)


def _picture(cell: Cell | None, thumbnails: Thumbnails) -> Picture:
    if cell is None:
        return Picture("", "nobody valid yet")
    image = thumbnails.of(cell.id)
    caption = f"{cell.fitness:.5g}, id {cell.id}"
    if cell.epoch != cell.stage:
        caption += f", bred in epoch {cell.epoch}"
    if image is None:
        return Picture("", caption)
    return Picture("data:image/jpeg;base64," + base64.b64encode(jpeg(image)).decode("ascii"), caption)
