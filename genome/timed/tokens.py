"""The pieces of a ``.tl`` file, line by line, each with its place."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, final

from genome.errors import InputError
from genome.timed.expression import Place

END: Final = "the end of the line"

_PIECE: Final = re.compile(
    r"(?P<gap>[ \t\r]+)|(?P<more>\.\.\.[ \t\r]*(?:\#[^\n]*)?\n)|(?P<end>\n)"
    r"|(?P<define>\#define\b)|(?P<comment>\#[^\n]*)"
    r"|(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<mark>->|→|<=|>=|==|!=|&&|\|\||[-+*/%^&|!<>=()\[\]{}@:,\\$~'])"
)


@final
@dataclass(frozen=True, slots=True)
class Token:
    """A piece of a file.

    Attributes
    ----------
    kind
        ``define``, ``number``, ``name``, ``mark`` or, behind the last piece of a line, ``end``.
    text
        As written; of an arrow ``->``.
    at
        Line and column.
    apart
        Whether blanks stand before it.
    """

    kind: str
    text: str
    at: Place
    apart: bool

    @property
    def told(self) -> str:
        """The piece as messages have it."""
        return END if self.kind == "end" else f"'{self.text}'"


def lines(text: str, source: str) -> Iterator[list[Token]]:
    """Give the pieces of each line that is not empty; the last of each is of kind ``end``.

    A line that ends in ``...`` goes on in the next. ``#`` begins a comment, but for ``#define`` at a line's start.

    Raises
    ------
    InputError
        For a character that no piece begins with.
    """
    row: list[Token] = []
    line, start, position, apart = 1, 0, 0, False
    while position < len(text):
        match = _PIECE.match(text, position)
        at = line, position - start + 1
        if match is None:
            where = f"{source}:{at[0]}:{at[1]}"
            raise InputError(where, "a symbol, a name, a number or an operator", f"'{text[position]}'")
        kind, piece = str(match.lastgroup), match.group()
        if kind == "define" and row:  # a comment that happens to begin with the word
            kind, piece = "comment", text[position:].partition("\n")[0]
        position += len(piece)
        if kind in ("number", "name", "mark", "define"):
            row.append(Token(kind, "->" if piece == "→" else piece, at, apart))
        elif kind == "end" and row:
            yield [*row, Token("end", "", at, apart=True)]
            row = []
        apart = kind not in ("number", "name", "mark", "define")
        if piece.endswith("\n"):
            line, start = line + 1, position
    if row:
        yield [*row, Token("end", "", (line, position - start + 1), apart=True)]
