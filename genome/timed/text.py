"""The ``.tl`` file: its parser and its writer.

The paper's notation in ASCII, a statement a line, ``#`` begins a comment::

    #define KL 200
    equiv + bend
    axiom bend(1) @ 0
    bend(x) @ 4 : x < 9 -> bend(x + 1) @ 0
    g bend(x, age, end) = asin(50*sin(2*pi*age/end)/KL)

``docs/formats/tl.md`` gives the grammar. Every error names line and column.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from genome.errors import InputError
from genome.timed.checks import check_system
from genome.timed.expression import Place
from genome.timed.reading import Reader
from genome.timed.statements import (
    read_birth_word,
    read_define,
    read_development,
    read_equiv,
    read_formals,
    read_ignored,
    read_production,
    read_section,
    read_surface,
)
from genome.timed.system import TimedSystem
from genome.timed.tokens import Token, lines
from genome.timed.writing import written

MOST_INSIDE: Final = 10
"""How deep systems may stand inside each other."""


def parse_tl(text: str, name: str = "system") -> TimedSystem:
    """Parse the text of a ``.tl`` file.

    Parameters
    ----------
    text
        The file's text.
    name
        The file's name, for messages.

    Returns
    -------
    TimedSystem
        Checked: its names, parameter counts, brackets and development functions fit together.

    Raises
    ------
    InputError
        With ``name:line:column``, for anything that is no timed system.
    """
    rows = lines(text, name)
    system = _Block(name, "").read(rows)
    check_system(system)
    return system


def format_tl(system: TimedSystem) -> str:
    """Write a system as the text of a ``.tl`` file; :func:`parse_tl` reads an equal one from it."""
    return "\n".join(written(system)) + "\n"


class _Block:
    """Reads the statements of one system."""

    def __init__(self, source: str, name: str, at: Place = (1, 1), depth: int = 0) -> None:
        self.source = source
        self.depth = depth
        self.at = at
        self.system = TimedSystem((), name=name, source=source, at=at)
        self.seen: list[str] = []

    def read(self, rows: Iterator[list[Token]]) -> TimedSystem:
        """Read up to the system's ``end``, or to the end of the file."""
        for row in rows:
            reader = Reader(row, self.source)
            first = reader.next
            if any(token.kind == "mark" and token.text == "->" for token in row):
                self._add("productions", read_production(reader))
            elif self.depth and first.text == "end" and row[1].kind == "end":
                return self._whole()
            elif first.text in ("system", "axiom", "angles", "ignore") and first.kind == "name":
                reader.take()
                self._statement(first, reader, rows)
            elif first.text in ("#define", "equiv", "g", "section", "surface"):
                reader.take()
                self._listed(first, reader)
            else:
                expected = "a production with '->', or a line that begins with axiom, #define, equiv, g, section, ..."
                raise reader.error(expected, token=first)
            if reader.next.kind != "end":
                raise reader.error("the end of the line")
        if self.depth:
            line, column = self.at
            raise InputError(f"{self.source}:{line}:{column}", "a line 'end' for this system", "the end of the file")
        return self._whole()

    def _statement(self, first: Token, reader: Reader, rows: Iterator[list[Token]]) -> None:
        if first.text == "system":
            self._add("systems", self._inside(reader, rows))
            return
        if first.text in self.seen:
            raise reader.error(f"'{first.text}' once", "remove the second", first)
        self.seen.append(first.text)
        if first.text == "axiom":
            reader.accept(":")
            self.system = replace(self.system, axiom=read_birth_word(reader))
        elif first.text == "ignore":
            self.system = replace(self.system, ignored=read_ignored(reader))
        elif self.depth:
            raise reader.error("'angles' outside of all inner systems", "it holds for the whole file", first)
        elif not reader.accept("radians"):
            if not reader.accept("degrees"):
                raise reader.error("'degrees' or 'radians'")
        else:
            self.system = replace(self.system, radians=True)

    def _listed(self, first: Token, reader: Reader) -> None:
        if first.text == "#define":
            self._add("defines", read_define(reader))
        elif first.text == "equiv":
            self._add("equivs", read_equiv(reader))
        elif first.text == "section":
            self._add("sections", read_section(reader))
        elif first.text == "surface":
            self._add("surfaces", read_surface(reader))
        else:
            self._add("developments", read_development(reader))

    def _inside(self, reader: Reader, rows: Iterator[list[Token]]) -> TimedSystem:
        name = reader.name("the name of the system")
        if self.depth == MOST_INSIDE:
            raise reader.error(f"systems at most {MOST_INSIDE} deep inside each other", token=name)
        parameters = read_formals(reader)
        if reader.next.kind != "end":
            raise reader.error("the end of the line")
        block = _Block(self.source, name.text, name.at, self.depth + 1)
        return replace(block.read(rows), parameters=parameters)

    def _whole(self) -> TimedSystem:
        if not self.system.axiom:
            where = self.source if not self.depth else f"{self.source}:{self.at[0]}:{self.at[1]}"
            raise InputError(where, "a line 'axiom ...'", "none", "add one, such as 'axiom A(1) @ 0'")
        return self.system

    def _add(self, group: str, item: object) -> None:
        self.system = replace(self.system, **{group: (*getattr(self.system, group), item)})  # type: ignore[arg-type]
