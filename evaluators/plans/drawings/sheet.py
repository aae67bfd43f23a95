"""A sheet of several plans side by side at one scale (Rosenman 1997, Figure 10)."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import Final

from evaluators.plans.drawings.drawing import Drawing
from evaluators.plans.drawings.marks import PALE, PAPER, Fill, Mark, Paper, Pen, Words, abbreviations, extent, plan
from evaluators.plans.drawings.png import paper_png
from evaluators.plans.drawings.svg import paper_svg
from genome.errors import InputError

WIDTH: Final = 297.0
"""Of a sheet, in millimetres."""
MARGIN: Final = 10.0
GAP: Final = 8.0
HEAD: Final = 12.0
LETTERS: Final = 180
"""Of a line of the legend."""
MOST: Final = 48
"""Plans of a sheet."""


def sheet(drawings: Sequence[Drawing], title: str) -> Paper:
    """Put plans side by side, at one scale, in rows.

    Parameters
    ----------
    drawings
        1 to :data:`MOST`; under each stands its title.
    title
        Of the sheet.

    Raises
    ------
    InputError
        For none, or too many.
    """
    if not 1 <= len(drawings) <= MOST:
        raise InputError("sheet", f"1 to {MOST} plans", f"{len(drawings)}")
    columns = math.ceil(math.sqrt(len(drawings) * 4 / 3))
    cell = (WIDTH - 2 * MARGIN - (columns - 1) * GAP) / columns
    boxes = [extent(one, dimensioned=False) for one in drawings]
    sides = [(high[0] - low[0], high[1] - low[1]) for low, high in boxes]
    scale = cell / max(max(side) for side in sides)
    tall = scale * max(side[1] for side in sides)
    short = abbreviations(list(dict.fromkeys(room.name for one in drawings for room in one.rooms)))
    marks: list[Mark] = [Words("title", title, (MARGIN, MARGIN + 4.0), 4.5, "start", bold=True)]
    for place, one in enumerate(drawings):
        row, column = divmod(place, columns)
        left, top = MARGIN + column * (cell + GAP), MARGIN + HEAD + row * (tall + GAP + 6.0)
        (low, _), (wide, high) = boxes[place], sides[place]
        pen = Pen(
            scale, (left + (cell - scale * wide) / 2 - scale * low[0], top + (tall + scale * high) / 2 + scale * low[1])
        )
        marks += plan(one, pen, short)
        marks.append(Words("caption", one.title, (left + cell / 2, top + tall + 5.0), 2.6))
    rows = math.ceil(len(drawings) / columns)
    foot = MARGIN + HEAD + rows * (tall + GAP + 6.0)
    told = textwrap.wrap(", ".join(f"{one} {name.replace('_', ' ')}" for name, one in short.items()), LETTERS)
    for number, line in enumerate(told):
        marks.append(Words("note", line, (MARGIN, foot + 2.0 + 4.0 * number), 2.6, "start", colour=PALE))
    height = foot + MARGIN + 4.0 * (len(told) - 1)
    back = Fill("paper", (((0.0, 0.0), (WIDTH, 0.0), (WIDTH, height), (0.0, height)),), PAPER)
    return Paper(title, WIDTH, height, (back, *marks))


def bare(drawing: Drawing) -> Paper:
    """Put one plan on a page that is no larger than it is, with its rooms' abbreviations and nothing else."""
    (left, low), (right, high) = extent(drawing, dimensioned=False)
    short = abbreviations(list(dict.fromkeys(room.name for room in drawing.rooms)))
    scale = (WIDTH / 3 - MARGIN) / max(right - left, high - low)
    wide, tall = scale * (right - left) + MARGIN, scale * (high - low) + MARGIN
    pen = Pen(scale, (MARGIN / 2 - scale * left, MARGIN / 2 + scale * high))
    back = Fill("paper", (((0.0, 0.0), (wide, 0.0), (wide, tall), (0.0, tall)),), PAPER)
    return Paper(drawing.title, wide, tall, (back, *plan(drawing, pen, short)))


def sheet_svg(drawings: Sequence[Drawing], title: str) -> bytes:
    """Write a sheet as SVG."""
    return paper_svg(sheet(drawings, title))


def sheet_png(drawings: Sequence[Drawing], title: str) -> bytes:
    """Draw a sheet as PNG."""
    return paper_png(sheet(drawings, title))
