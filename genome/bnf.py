"""Reads grammars written in Backus-Naur form; `docs/formats/bnf.md` describes the format.

A production is ``<Name> ::= alternatives`` and goes on until the next ``<Name> ::=``. ``|`` separates alternatives,
``{ }`` repeats, ``[ ]`` makes optional; whatever else stands there is a terminal, quoted or bare.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from genome.errors import InputError
from genome.grammar import (
    ENDLESS,
    Alternatives,
    Grammar,
    Item,
    NonTerminal,
    Option,
    Repeat,
    Sequence,
    Terminal,
    least_depths,
)

_NAME = r"<[A-Za-z_][A-Za-z0-9_.-]*(?:[ ][A-Za-z0-9_.-]+)*>"
_TOKEN = re.compile(
    rf"""
      (?P<space>\s+)
    | (?P<comment>\#[^\n]*)
    | (?P<quoted>'[^'\n]*'|"[^"\n]*")
    | (?P<open_quote>['"])
    | (?P<defines>::=)
    | (?P<name>{_NAME})
    | (?P<meta>[|{{}}\[\]])
    | (?P<bare>(?:(?!{_NAME}|::=)[^\s|{{}}\[\]\#'"])+)
    """,
    re.VERBOSE,
)
_CLOSES = {"{": "}", "[": "]"}
_DEEPEST = 100
"""The most groups that may lie in one another."""


@dataclass(frozen=True, slots=True)
class _Token:
    kind: str
    text: str
    where: str


def parse_bnf(text: str, source: str) -> Grammar:
    """Parse a grammar.

    Parameters
    ----------
    text
        The grammar's text.
    source
        The file's name, for messages.

    Returns
    -------
    Grammar
        Its start symbol is the name of the first production.

    Raises
    ------
    InputError
        With ``file:line:column``, for text that is no grammar, a name defined twice or used without definition, an
        empty alternative, and a non-terminal that no derivation ever ends.
    """
    reader = _Reader(_tokens(text, source), source)
    rules, places = reader.productions()
    for token in reader.used:
        if token.text not in rules:
            known = ", ".join(f"<{name}>" for name in rules)
            raise InputError(token.where, "a name that a production defines", f"<{token.text}>", f"defined are {known}")
    for name, depth in least_depths(rules).items():
        if depth >= ENDLESS:
            raise InputError(
                places[name],
                f"an alternative of <{name}> that ends",
                "only alternatives that lead back to it",
                "add one without non-terminals",
            )
    return Grammar(source, next(iter(rules)), rules)


def _tokens(text: str, source: str) -> list[_Token]:
    tokens: list[_Token] = []
    line, line_start, at = 1, 0, 0
    while at < len(text):
        match = _TOKEN.match(text, at)
        where = f"{source}:{line}:{at - line_start + 1}"
        if match is None:  # every character belongs to some class above
            raise InputError(where, "a token", repr(text[at]))
        kind, word = str(match.lastgroup), match.group()
        at = match.end()
        if kind == "space":
            newlines = word.count("\n")
            if newlines:
                line += newlines
                line_start = match.start() + word.rindex("\n") + 1
        elif kind == "open_quote":
            raise InputError(where, f"a closing {word} on the same line", "none", "put the other kind round a quote")
        elif kind == "quoted" or kind == "name":
            tokens.append(_Token(kind, word[1:-1], where))
        elif kind != "comment":
            tokens.append(_Token(kind, word, where))
    tokens.append(_Token("end", "", f"{source}:{line}:{at - line_start + 1}"))
    return tokens


class _Reader:
    """Recursive descent over the tokens; `used` collects the names that productions refer to."""

    def __init__(self, tokens: list[_Token], source: str) -> None:
        self.tokens = tokens
        self.source = source
        self.at = 0
        self.used: list[_Token] = []

    def productions(self) -> tuple[dict[str, Alternatives], dict[str, str]]:
        rules: dict[str, Alternatives] = {}
        places: dict[str, str] = {}
        if self._now.kind == "end":
            raise InputError(self.source, "a grammar", "a text without productions", "write <Name> ::= ...")
        while self._now.kind != "end":
            name = self._now
            if not self._head:
                raise InputError(name.where, "<Name> ::= ...", _shown(name))
            if name.text in rules:
                first = places[name.text].removeprefix(f"{self.source}:")
                raise InputError(
                    name.where,
                    "one production for each name",
                    f"a second <{name.text}>",
                    f"the first is at {first}; join them with |",
                )
            places[name.text] = name.where
            self.at += 2
            rules[name.text] = self._alternatives(0)
        return rules, places

    @property
    def _now(self) -> _Token:
        return self.tokens[self.at]

    @property
    def _head(self) -> bool:
        """Whether a production begins here."""
        return self._now.kind == "name" and self.tokens[self.at + 1].kind == "defines"

    def _alternatives(self, depth: int) -> Alternatives:
        found = [self._sequence(depth)]
        while self._now.kind == "meta" and self._now.text == "|":
            self.at += 1
            found.append(self._sequence(depth))
        if depth == 0 and self._now.kind == "meta":
            raise InputError(self._now.where, "no closing bracket without its opening one", _shown(self._now), _QUOTE)
        return tuple(found)

    def _sequence(self, depth: int) -> Sequence:
        items: list[Item] = []
        empty = True
        while not (self._now.kind == "end" or self._head or (self._now.kind == "meta" and self._now.text in "|}]")):
            item = self._item(depth)
            empty = False
            if item != Terminal(""):
                items.append(item)
        if empty:
            raise InputError(self._now.where, "a symbol", f"{_shown(self._now)} after an empty alternative", "write ''")
        return tuple(items)

    def _item(self, depth: int) -> Item:
        token = self._now
        self.at += 1
        if token.kind == "name":
            self.used.append(token)
            return NonTerminal(token.text)
        if token.kind == "defines":
            raise InputError(token.where, "a name in angle brackets before ::=", "::= alone", "quote it as a terminal")
        if token.kind != "meta":
            return Terminal(token.text)
        if depth == _DEEPEST:
            raise InputError(token.where, f"at most {_DEEPEST} groups inside one another", "more")
        alternatives = self._alternatives(depth + 1)
        closing = self._now
        if closing.kind != "meta" or closing.text != _CLOSES[token.text]:
            opened = token.where.removeprefix(f"{self.source}:")
            expected = f"{_CLOSES[token.text]} for the {token.text} at {opened}"
            raise InputError(closing.where, expected, _shown(closing), _QUOTE)
        self.at += 1
        return Repeat(alternatives) if token.text == "{" else Option(alternatives)


_QUOTE = "quote a bracket that is a terminal"


def _shown(token: _Token) -> str:
    if token.kind == "end":
        return "the end of the text"
    return f"<{token.text}>" if token.kind == "name" else f"'{token.text}'"
