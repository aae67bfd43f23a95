"""Words as trees: a malformed one cannot be made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

from genome.errors import InputError
from genome.lsystem.symbols import CLOSE, EXPECTED, OPEN, SIBLING, SPELLINGS, SYMBOLS
from genome.settings import describe

MOST_NESTED: Final = 100
"""Branches inside each other, in any one word."""

_SYMBOLS: Final = frozenset(SYMBOLS)


@final
@dataclass(frozen=True, slots=True)
class Branch:
    """A branch point: one word or several siblings that all grow from it, none of them empty.

    Raises
    ------
    InputError
        Without siblings, or with an empty one.
    """

    siblings: tuple[Word, ...]

    def __post_init__(self) -> None:
        if not self.siblings or not all(type(one) is Word and one.items for one in self.siblings):
            raise InputError("branch", "one word or several, none of them empty", describe(self.siblings))

    def __str__(self) -> str:
        return f"{OPEN}{SIBLING.join(map(str, self.siblings))}{CLOSE}"


Item = str | Branch
"""A symbol, or a branch point."""


@final
@dataclass(frozen=True, slots=True)
class Word:
    """A sequence of symbols and branch points, in the order in which the turtle comes to them.

    Attributes
    ----------
    items
        Symbols, each a string of one character of :data:`~genome.lsystem.symbols.SYMBOLS`, and branches.

    Raises
    ------
    InputError
        For anything else among the items.
    """

    items: tuple[Item, ...] = ()

    def __post_init__(self) -> None:
        for item in self.items:
            if item not in _SYMBOLS if isinstance(item, str) else type(item) is not Branch:
                raise InputError("word", "symbols (a capital letter, + - & ^ £ $ %) and branches", describe(item))

    def __str__(self) -> str:
        return "".join(map(str, self.items))

    @property
    def count(self) -> int:
        """How many symbols there are, those on branches too; brackets are none."""
        return sum(1 if isinstance(item, str) else sum(one.count for one in item.siblings) for item in self.items)

    @property
    def depth(self) -> int:
        """How many branches stand inside each other at most; 0 without any."""
        branches = [item for item in self.items if isinstance(item, Branch)]
        return max((1 + max(one.depth for one in branch.siblings) for branch in branches), default=0)

    @property
    def symbols(self) -> tuple[str, ...]:
        """All symbols in the order in which they are written, without brackets."""
        found: list[str] = []
        for item in self.items:
            if isinstance(item, str):
                found.append(item)
            else:
                found.extend(symbol for one in item.siblings for symbol in one.symbols)
        return tuple(found)


def parse_word(text: str, source: str = "word", line: int | None = None, column: int = 1) -> Word:
    """Read a word.

    Parameters
    ----------
    text
        Symbols, brackets and blanks; an ``f`` is read as ``£``. An empty text is the empty word.
    source, line, column
        Where it stands, for messages; without a line, places are counted in the word alone.

    Raises
    ------
    InputError
        For an unknown symbol, brackets that do not balance, ``|`` outside of them, an empty branch, or branches nested
        deeper than :data:`MOST_NESTED`.
    """
    where = f"{source}:{line}" if line is not None else f"{source}, character"
    separator = ":" if line is not None else " "

    def error(at: int, expected: str, got: str, remedy: str = "") -> InputError:
        return InputError(f"{where}{separator}{column + at}", expected, got, remedy)

    levels: list[tuple[int, list[Word]]] = []
    items: list[list[Item]] = [[]]
    for at, written in enumerate(text):
        symbol = SPELLINGS.get(written, written)
        if symbol in _SYMBOLS:
            items[-1].append(symbol)
        elif symbol == OPEN:
            if len(levels) == MOST_NESTED:
                raise error(at, f"at most {MOST_NESTED} branches inside each other", "one more")
            levels.append((at, []))
            items.append([])
        elif symbol in (SIBLING, CLOSE):
            if not levels:
                raise error(at, f"a '[' before this '{symbol}'", "none", "brackets must balance")
            if not items[-1]:
                raise error(at, f"a symbol before this '{symbol}'", "an empty branch")
            levels[-1][1].append(Word(tuple(items.pop())))
            if symbol == SIBLING:
                items.append([])
            else:
                items[-1].append(Branch(tuple(levels.pop()[1])))
        elif not symbol.isspace():
            raise error(at, EXPECTED, f"'{written}'")
    if levels:
        raise error(levels[-1][0], "a ']' for this '['", "the end of the word", "brackets must balance")
    return Word(tuple(items[0]))
