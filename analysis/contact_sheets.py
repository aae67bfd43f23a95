"""Contact sheets: each island's best forms, from the run's beginning to its end."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from analysis.stages import Row, Stages, stages
from analysis.thumbnails import SIZE, Thumbnails
from genome.errors import InputError
from genome.files import write_whole
from orchestrator.folder import RunFolder

if TYPE_CHECKING:
    from PIL.Image import Image

LABEL: Final = 150
"""Of the column with the islands' names, in pixels."""

HEAD: Final = 56
CAPTION: Final = 22
GAP: Final = 8
INK: Final = "#1a1a1a"
PALE: Final = "#6b6b6b"
EMPTY: Final = "#f2f2f0"


def write_contact_sheet(folder: RunFolder, islands: Sequence[str], output: Path) -> list[str]:
    """Draw a contact sheet as PNG.

    Returns
    -------
    What could not be shown, and why.

    Raises
    ------
    InputError
        When no island has bred a valid individual, or the file cannot be written.
    """
    plan = stages(folder, islands)
    if not plan.rows:
        raise InputError(folder.name, "a run with valid individuals", "none in its log so far")
    thumbnails = Thumbnails(folder)
    stream = io.BytesIO()
    sheet = contact_sheet(folder.name, plan, thumbnails)
    if not thumbnails.shown:
        raise InputError(folder.name, "a run whose individuals have pictures", "; ".join(thumbnails.troubles))
    sheet.save(stream, format="PNG", optimize=True)
    write_whole(output, stream.getvalue())
    return [*said(plan), *thumbnails.troubles]


def said(plan: Stages) -> list[str]:
    """Say which islands a sheet does not show."""
    told = []
    if plan.left_out:
        told.append(f"{len(plan.left_out)} more islands are not shown: {', '.join(plan.left_out)}")
    if plan.without:
        told.append(f"without a valid individual: {', '.join(plan.without)}")
    return told


def contact_sheet(title: str, plan: Stages, thumbnails: Thumbnails) -> Image:
    """Draw rows of islands and columns of epochs."""
    from PIL import Image, ImageDraw

    wide, tall = SIZE
    width = LABEL + len(plan.columns) * (wide + GAP) + GAP
    height = HEAD + len(plan.rows) * (tall + CAPTION + GAP) + GAP
    sheet = Image.new("RGB", (width, height), "#ffffff")
    pen = ImageDraw.Draw(sheet)
    pen.text((GAP, 10), title, INK, _font(18))
    for column, heading in enumerate(plan.columns):
        pen.text((LABEL + column * (wide + GAP), HEAD - 20), heading, PALE, _font(13))
    for place, row in enumerate(plan.rows):
        top = HEAD + place * (tall + CAPTION + GAP)
        pen.text((GAP, top + tall // 2 - 8), row.island, INK, _font(14))
        _row(sheet, row, top, thumbnails)
    return sheet


def _row(sheet: Image, row: Row, top: int, thumbnails: Thumbnails) -> None:
    from PIL import ImageDraw

    wide, tall = SIZE
    pen = ImageDraw.Draw(sheet)
    for column, cell in enumerate(row.cells):
        left = LABEL + column * (wide + GAP)
        image = None if cell is None else thumbnails.of(cell.id)
        if image is None:
            pen.rectangle((left, top, left + wide - 1, top + tall - 1), EMPTY)
        else:
            sheet.paste(image, (left, top))
        if cell is not None:
            pen.text((left, top + tall + 3), f"{cell.fitness:.5g}  (id {cell.id})", PALE, _font(12))


def _font(size: int) -> Any:  # noqa: ANN401 - Pillow's
    from PIL import ImageFont

    return ImageFont.load_default(size)
