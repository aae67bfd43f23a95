"""What a report is made of: sections of figures, each with the query that gives its numbers."""

from __future__ import annotations

from dataclasses import dataclass, field
from decimal import Decimal
from typing import Any, final

from orchestrator.folder import RunFolder
from orchestrator.query import Answer, ask


@final
@dataclass(frozen=True, slots=True)
class Figure:
    """A figure.

    Attributes
    ----------
    title
        What it shows.
    sql
        The query whose answer it draws, all of it; ``atoll query RUN`` gives the same numbers.
    answer
        That answer.
    svg
        The drawing; a table alone where empty.
    note
        How to read it.
    shown
        Whether the table of numbers is open, and not folded in.
    """

    title: str
    sql: str
    answer: Answer
    svg: str = ""
    note: str = ""
    shown: bool = False

    @property
    def rows(self) -> list[list[str]]:
        """The answer's cells as text."""
        return [[cell_text(cell) for cell in row] for row in self.answer.rows]

    @property
    def numeric(self) -> list[bool]:
        """Which columns are of numbers; found out anew each time that it is asked for."""
        kinds = (int, float, Decimal)
        return [all(row[at] is None or isinstance(row[at], kinds) for row in self.answer.rows)
                for at in range(len(self.answer.columns))]  # fmt: skip


@final
@dataclass(frozen=True, slots=True)
class Picture:
    """One picture of a sheet, as a data URI; empty where there is none."""

    image: str
    caption: str


@final
@dataclass(frozen=True, slots=True)
class Section:
    """A part of the report under a heading.

    Attributes
    ----------
    anchor, title
        Its place in the page, and its heading.
    text
        Sentences before the figures.
    figures
        Drawings and tables.
    sheet
        Rows of pictures: a name, and its pictures.
    columns
        Headings of the sheet's columns.
    facts
        Names and values.
    code
        Text as it stands in a file.
    troubles
        What could not be shown, and why.
    """

    anchor: str
    title: str
    text: str = ""
    figures: tuple[Figure, ...] = ()
    sheet: tuple[tuple[str, tuple[Picture, ...]], ...] = ()
    columns: tuple[str, ...] = ()
    facts: tuple[tuple[str, str], ...] = ()
    code: str = ""
    troubles: tuple[str, ...] = field(default=())


def asked(folder: RunFolder, sql: str) -> tuple[str, Answer]:
    """Put a query to a run's log; give it as it is shown, without blank lines, and its answer."""
    shown = "\n".join(line for line in sql.strip("\n").splitlines() if line.strip())
    return shown, ask(folder.log, shown)


def cell_text(value: Any) -> str:  # noqa: ANN401 - whatever DuckDB gives
    """Write a cell: numbers short but for whole ones, nothing for null."""
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.6g}"
    return str(value)
