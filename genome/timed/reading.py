"""Reading expressions: precedence climbing over the pieces of a line."""

from __future__ import annotations

from typing import Final

from genome.errors import InputError
from genome.settings import near
from genome.timed.expression import (
    BINDING,
    DEVELOPMENT,
    FUNCTIONS,
    UNARY,
    Binary,
    Call,
    Expression,
    Name,
    Number,
    Unary,
)
from genome.timed.tokens import Token, lines

MOST_NESTED: Final = 100
"""How deep an expression may be nested; of operators of one kind in a row each counts."""

COMMANDS: Final = "+-^&/|%"
"""Operators that are symbols, too. Behind a birth age that stands in no parentheses, blanks tell them apart."""

_Measured = tuple[Expression, int]
"""An expression with its depth."""


class Reader:
    """A line's pieces and a place among them.

    Parameters
    ----------
    row
        The pieces; the last is of kind ``end``.
    source
        The file's name, for messages.
    """

    def __init__(self, row: list[Token], source: str) -> None:
        self.row = row
        self.source = source
        self.place = 0

    @property
    def next(self) -> Token:
        """The piece that comes next."""
        return self.row[self.place]

    def take(self) -> Token:
        """Give the next piece and go past it; the end stays."""
        token = self.row[self.place]
        self.place = min(self.place + 1, len(self.row) - 1)
        return token

    def accept(self, *texts: str) -> bool:
        """Go past the next piece if it is one of these marks or words."""
        found = self.next.kind != "end" and self.next.text in texts
        if found:
            self.take()
        return found

    def expect(self, text: str, remedy: str = "") -> Token:
        """Go past a mark that must come.

        Raises
        ------
        InputError
            When something else comes.
        """
        if self.next.kind == "end" or self.next.text != text:
            raise self.error(f"'{text}'", remedy)
        return self.take()

    def name(self, what: str) -> Token:
        """Give the name that must come.

        Raises
        ------
        InputError
            When something else comes.
        """
        if self.next.kind != "name":
            raise self.error(what)
        return self.take()

    def error(self, expected: str, remedy: str = "", token: Token | None = None) -> InputError:
        """Give the complaint about the next piece, or about the one given."""
        token = token or self.next
        return InputError(f"{self.source}:{token.at[0]}:{token.at[1]}", expected, token.told, remedy)

    def expression(self) -> Expression:
        """Read an expression as long as it goes on.

        Raises
        ------
        InputError
            When there is none, or it is nested too deep.
        """
        return self._climb(0, 0, bare=False)[0]

    def birth_age(self) -> Expression:
        """Read an expression that symbols may follow.

        Outside of parentheses an operator that is a symbol, too, goes on with it only where no blank stands before:
        ``A @ 3/t`` has the birth age 3/t, ``A @ 0 /(30)`` rolls.

        Raises
        ------
        InputError
            When there is none, and where ``A @ 0+(30)`` leaves open which is meant.
        """
        return self._climb(0, 0, bare=True)[0]

    def _climb(self, least: int, depth: int, *, bare: bool) -> _Measured:
        left, high = self._unary(depth, bare=bare)
        while True:
            token = self.next
            operator = "==" if token.text == "=" else token.text
            binding = BINDING.get(operator, -1) if token.kind == "mark" else -1
            if binding < max(least, 1) or self._is_symbol(token, bare=bare):
                return left, high
            self.take()
            right, other = self._climb(binding + 1, depth + 1, bare=bare)
            left, high = Binary(operator, left, right), max(high, other) + 1
            self._check_depth(high, token)

    def _is_symbol(self, token: Token, *, bare: bool) -> bool:
        """Whether an operator behind a bare birth age is a symbol."""
        if not bare or token.text not in COMMANDS:
            return False
        after = self.row[self.place + 1]
        if not token.apart and after.text == "(" and after.kind == "mark":
            expected = f"a blank before the symbol '{token.text}', or parentheses around the birth age"
            raise self.error(expected, f"such as '@ 0 {token.text}(...)' or '@ (b {token.text} (...))'")
        return token.apart

    def _unary(self, depth: int, *, bare: bool) -> _Measured:
        self._check_depth(depth, self.next)
        token = self.next
        if token.kind == "mark" and token.text in UNARY:
            self.take()
            operand, high = self._unary(depth + 1, bare=bare)
            return Unary(token.text, operand), high + 1
        base, high = self._primary(depth, bare=bare)
        mark = self.next
        if mark.kind == "mark" and mark.text == "^" and not self._is_symbol(mark, bare=bare):
            self.take()
            exponent, other = self._unary(depth + 1, bare=bare)
            return Binary("^", base, exponent), max(high, other) + 1
        return base, high

    def _primary(self, depth: int, *, bare: bool) -> _Measured:
        token = self.next
        if token.kind == "number":
            self.take()
            value = float(token.text)
            if value == float("inf"):
                raise self.error("a number that a double can hold", "the constant of that name is inf", token)
            return Number(value), 0
        if token.kind == "name":
            self.take()
            # Behind a bare birth age a parenthesis that stands apart belongs to nothing before it.
            called = self.next.kind == "mark" and self.next.text == "(" and not (bare and self.next.apart)
            return self._call(token, depth) if called else (Name(token.text, token.at), 0)
        if token.kind == "mark" and token.text == "(":
            self.take()
            inner, high = self._climb(0, depth + 1, bare=False)
            self.expect(")")
            return inner, high + 1
        raise self.error("a number, a name, a function or '('")

    def _call(self, token: Token, depth: int) -> _Measured:
        function = token.text
        of_symbol = function.startswith(DEVELOPMENT) and len(function) > len(DEVELOPMENT)
        if function not in FUNCTIONS and not of_symbol:
            raise self.error("a function that there is", near(function, list(FUNCTIONS)), token)
        self.take()
        arguments: list[Expression] = []
        high = 0
        if not self.accept(")"):
            while True:
                argument, own = self._climb(0, depth + 1, bare=False)
                arguments.append(argument)
                high = max(high, own)
                if self.accept(")"):
                    break
                self.expect(",")
        if not of_symbol and len(arguments) != FUNCTIONS[function]:
            where = f"{self.source}:{token.at[0]}:{token.at[1]}"
            raise InputError(where, counted(FUNCTIONS[function], "argument", f"{function}()"), str(len(arguments)))
        return Call(function, tuple(arguments), token.at), high + 1

    def _check_depth(self, depth: int, token: Token) -> None:
        if depth > MOST_NESTED:
            expected = f"an expression nested at most {MOST_NESTED} deep"
            raise self.error(expected, "each operator of a sum counts; name a part of it by #define", token)


def counted(count: int, what: str, owner: str) -> str:
    """Say how many of something there are of an owner."""
    return f"{count} {what}{'' if count == 1 else 's'} of {owner}"


def parse_expression(text: str, source: str = "expression") -> Expression:
    """Parse the text of one expression.

    Raises
    ------
    InputError
        With ``source:line:column``, for anything else.
    """
    rows = list(lines(text, source))
    if len(rows) != 1:
        raise InputError(source, "one expression", f"{len(rows)} lines")
    reader = Reader(rows[0], source)
    expression = reader.expression()
    if reader.next.kind != "end":
        raise reader.error("an operator or the end of the expression")
    return expression
