"""The ``.hemls`` rule file: its text, its parser, and the rewrite system that comes out.

A rewrite system is an axiom, rewrite rules, two angles and the switch ``Sync`` (Hemberg 2006, definition 4 and
Figure 4). The file has one of them a line, ``;`` counts as a line end, ``#`` begins a comment::

    A + B + A + B
    A -> A [ [ + B ] - B ] A
    B -> B [ [ + A ] - A ] B
    Angle 90
    BranchAngle 90

``docs/formats/hemls.md`` gives the grammar. Every error names line and column.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from genome.errors import InputError

TURNS = "+-&^\\/"
MOST_NESTED = 100
_TOKEN = re.compile(
    r"(?P<space>[ \t\r]+|\#[^\n]*)|(?P<end>[\n;])|(?P<arrow>->|→)|(?P<later>Edge_i(?:[+-]1)?|Edge[XYZ]\b|Weight\b|If\b)"
    r"|(?P<keyword>(?:BranchAngle|Angle|Sync)\b)|(?P<label>Edge\d+\b|E\d+\b|[A-Z](?![A-Za-z0-9_]))"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<symbol>[+\-&^\\/~\[\]<>])"
)
_LATER = {
    "Weight": "probabilistic rules",
    "If": "rules that depend on an edge's age",
    "Edge_i": "ages of edges",
}


@dataclass(frozen=True, slots=True)
class Token:
    """A piece of a rule file with its place, both counted from one."""

    kind: str
    text: str
    line: int
    column: int


@dataclass(frozen=True, slots=True)
class Segment:
    """A drawn edge: an index into the system's labels, and whether a ``~`` swaps its start and end."""

    label: int
    reversed: bool = False


Symbol = str | Segment
"""A turtle command (``+ - & ^ \\ / [ ]``) or a drawn segment."""


@dataclass(frozen=True, slots=True)
class Rule:
    """A rewrite rule for one label.

    Attributes
    ----------
    label
        The predecessor, an index into the system's labels.
    before, after
        The label that an edge at the predecessor's start (end) vertex must bear, or ``None``.
    successor
        Turtle commands with balanced brackets, at least one of them a segment.
    """

    label: int
    before: int | None
    after: int | None
    successor: tuple[Symbol, ...]


@dataclass(frozen=True, slots=True)
class System:
    """A HEMLS rewrite system.

    Attributes
    ----------
    axiom
        The seed polygon's sides in order, at least three.
    rules
        In the order written; a rule with several predecessors stands here once for each of them.
    angle, branch_angle
        In degrees, within 0 and 90.
    sync
        Whether branches are joined once a step, after all rules.
    labels
        The labels as the file writes them, in order of appearance.
    """

    axiom: tuple[Segment, ...]
    rules: tuple[Rule, ...]
    angle: float
    branch_angle: float
    sync: bool
    labels: tuple[str, ...]


def parse_system(text: str, source: str = "rules") -> System:
    """Parse the text of a ``.hemls`` file.

    Parameters
    ----------
    text
        The file's text.
    source
        The file's name, for messages.

    Raises
    ------
    InputError
        With ``source:line:column``, for anything that is no rewrite system.
    """
    return _Parser(source).parse(text)


def _tokens(text: str, source: str) -> Iterator[list[Token]]:
    """Give the tokens of each line that is not empty."""
    row: list[Token] = []
    line, line_start, position = 1, 0, 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        column = position - line_start + 1
        if match is None:
            word = re.match(r"\S\w*", text[position:])
            got = f"'{word.group() if word else text[position]}'"
            remedy = "an edge is Edge0, Edge1, ... or a single capital letter"
            raise InputError(f"{source}:{line}:{column}", "an edge, a turtle command or a keyword", got, remedy)
        kind = str(match.lastgroup)
        if kind == "later":
            name = match.group()
            what = _LATER.get(name, _LATER["Edge_i"] if name.startswith("Edge_i") else "bound edges")
            raise InputError(
                f"{source}:{line}:{column}", "an edge, a turtle command or a keyword", f"'{name}'",
                f"{what} are not built yet",
            )  # fmt: skip
        if kind == "end":
            if row:
                yield row
            row = []
        elif kind != "space":
            row.append(Token(kind, match.group(), line, column))
        position = match.end()
        if match.group() == "\n":
            line, line_start = line + 1, position
    if row:
        yield row


class _Parser:
    """Recursive descent over the lines of one file."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.labels: dict[str, int] = {}
        self.rules: list[Rule] = []
        self.numbers: dict[str, float] = {}
        self.sync = False

    def parse(self, text: str) -> System:
        lines = _tokens(text, self.source)
        first = next(lines, None)
        if first is None:
            raise InputError(self.source, "an axiom such as 'A + B + A + B'", "an empty file", "write one")
        axiom = self._axiom(first)
        for row in lines:
            self._line(row)
        for keyword in ("Angle", "BranchAngle"):
            if keyword not in self.numbers:
                raise InputError(self.source, f"a line '{keyword} <degrees>'", "none", "add the line")
        if not self.rules:
            raise InputError(self.source, "at least one rule such as 'A -> A A'", "none", "add a rule")
        return System(
            axiom, tuple(self.rules), self.numbers["Angle"], self.numbers["BranchAngle"], self.sync, tuple(self.labels)
        )

    def _axiom(self, row: list[Token]) -> tuple[Segment, ...]:
        segments: list[Segment] = []
        want_segment, flipped = True, False
        for token in row:
            if token.text == "~":
                flipped = not flipped
            elif want_segment and token.kind == "label":
                segments.append(Segment(self._label(token), flipped))
                want_segment, flipped = False, False
            elif not want_segment and token.text == "+":
                want_segment = True
            else:
                expected = "an edge of the axiom" if want_segment else "'+' or the end of the axiom"
                raise self._error(token, expected, "the first line is the axiom, such as 'A + B + A + B'")
        if want_segment or flipped:
            raise self._error(row[-1], f"an edge after '{row[-1].text}'", "", after=True)
        if len(segments) < 3:
            raise self._error(row[0], "at least three edges in the axiom", "the seed is a polygon", f"{len(segments)}")
        return tuple(segments)

    def _line(self, row: list[Token]) -> None:
        head = row[0]
        if head.kind == "keyword":
            self._keyword(row)
            return
        arrows = [index for index, token in enumerate(row) if token.kind == "arrow"]
        if not arrows:
            raise self._error(row[-1], "'->' in a rule", "a rule is 'A -> successor'", after=True)
        if len(arrows) > 1:
            raise self._error(row[arrows[1]], "one '->' a rule", "several successors of one rule are not built yet")
        labels, before, after = self._predecessor(row[: arrows[0]], row[arrows[0]])
        successor = self._successor(row[arrows[0] + 1 :], row[arrows[0]])
        self.rules.extend(Rule(label, before, after, successor) for label in dict.fromkeys(labels))

    def _keyword(self, row: list[Token]) -> None:
        head = row[0]
        if head.text == "Sync":
            if self.sync:
                raise self._error(head, "'Sync' once", "remove the second")
            if len(row) > 1:
                raise self._error(row[1], "nothing after 'Sync'", "")
            self.sync = True
            return
        if head.text in self.numbers:
            raise self._error(head, f"'{head.text}' once", "remove the second")
        if len(row) < 2:
            raise self._error(head, "a number of degrees", "", after=True)
        if row[1].kind != "number":
            raise self._error(row[1], "a number of degrees", "")
        if len(row) > 2:
            raise self._error(row[2], f"nothing after '{head.text} {row[1].text}'", "")
        value = float(row[1].text)
        if not 0 <= value <= 90:
            raise self._error(row[1], "degrees within 0 and 90", "write a larger turn as several of smaller angle")
        self.numbers[head.text] = value

    def _predecessor(self, row: Sequence[Token], arrow: Token) -> tuple[list[int], int | None, int | None]:
        if not row:
            raise self._error(arrow, "an edge before '->'", "")
        names = [token.text if token.text in "<>" else "e" for token in row]
        for token in row:
            if token.kind != "label" and token.text not in "<>":
                raise self._error(token, "an edge, '<' or '>' before '->'", "")
        pattern = "".join(names)
        known = ("e<e", "e>e", "e<e>e")
        if set(pattern) == {"e"}:
            return [self._label(token) for token in row], None, None
        if pattern not in known:
            written = " ".join(token.text for token in row)
            raise self._error(row[0], "'A', 'A B', 'A < B', 'B > C' or 'A < B > C' before '->'", "", f"'{written}'")
        labels = [self._label(token) if token.kind == "label" else -1 for token in row]
        if pattern == "e<e":
            return [labels[2]], labels[0], None
        if pattern == "e>e":
            return [labels[0]], None, labels[2]
        return [labels[2]], labels[0], labels[4]

    def _successor(self, row: Sequence[Token], arrow: Token) -> tuple[Symbol, ...]:
        if not row:
            raise self._error(arrow, "a successor", "", after=True)
        symbols: list[Symbol] = []
        open_brackets: list[Token] = []
        flipped = False
        for token in row:
            if token.kind == "label":
                symbols.append(Segment(self._label(token), flipped))
                flipped = False
            elif token.text == "~":
                flipped = not flipped
            elif token.text in TURNS:
                symbols.append(token.text)
            elif token.text == "[":
                open_brackets.append(token)
                if len(open_brackets) > MOST_NESTED:
                    raise self._error(token, f"at most {MOST_NESTED} brackets inside each other", "")
                symbols.append("[")
            elif token.text == "]":
                if not open_brackets:
                    raise self._error(token, "a '[' before this ']'", "brackets must balance")
                open_brackets.pop()
                symbols.append("]")
                flipped = False
            else:
                raise self._error(token, "an edge or a turtle command + - & ^ \\ / ~ [ ]", "")
        if open_brackets:
            raise self._error(open_brackets[-1], "a ']' for this '['", "brackets must balance")
        if not any(isinstance(symbol, Segment) for symbol in symbols):
            raise self._error(row[0], "at least one edge in a successor", "")
        return tuple(symbols)

    def _label(self, token: Token) -> int:
        name = token.text
        if name[0] == "E" and name[1:].isdigit():
            name = f"Edge{name[1:]}"
        if name.startswith("Edge"):
            name = f"Edge{int(name[4:])}"
        return self.labels.setdefault(name, len(self.labels))

    def _error(
        self, token: Token, expected: str, remedy: str, got: str | None = None, after: bool = False
    ) -> InputError:
        column = token.column + len(token.text) if after else token.column
        came = "the end of the line" if after else (got if got is not None else f"'{token.text}'")
        return InputError(f"{self.source}:{token.line}:{column}", expected, came, remedy)
