"""Reading the statements of a ``.tl`` file, each from the pieces of its line."""

from __future__ import annotations

from genome.timed.expression import ONE, ZERO, Expression
from genome.timed.reading import Reader
from genome.timed.system import (
    BRACKETS,
    MARKS,
    Birth,
    Define,
    Development,
    Equiv,
    Formal,
    Production,
    Section,
    Sheet,
)

_DOUBLES = ("&&", "||")
"""Pieces of expressions that are two symbols in a word."""


def read_define(reader: Reader) -> Define:
    """Read what follows ``#define``: a name and an expression."""
    token = reader.name("a name to define")
    return Define(token.text, reader.expression(), token.at)


def read_equiv(reader: Reader) -> Equiv:
    """Read what follows ``equiv``: the symbol that the turtle knows, and the one that it shall take for it."""
    command = _symbol(reader)
    token = reader.next
    return Equiv(command, _symbol(reader), token.at)


def read_ignored(reader: Reader) -> tuple[str, ...]:
    """Read what follows ``ignore``: symbols."""
    symbols = [_symbol(reader)]
    while reader.next.kind != "end":
        symbols.append(_symbol(reader))
    return tuple(symbols)


def read_development(reader: Reader) -> Development:
    """Read what follows ``g``: a symbol, names in parentheses, ``=`` and an expression."""
    token = reader.next
    symbol = _symbol(reader)
    names = read_formals(reader)
    reader.expect("=", f"such as 'g {symbol}(age, end) = age/end'")
    return Development(symbol, names, reader.expression(), token.at)


def read_section(reader: Reader) -> Section:
    """Read what follows ``section``: a name, the angle's name in parentheses, ``=`` and an expression."""
    token = reader.name("the name of a section")
    names = read_formals(reader)
    if len(names) != 1:
        raise reader.error("the name of an angle", f"such as 'section {token.text}(a) = 1 + 0.2*cos(5*a)'", token)
    reader.expect("=")
    return Section(token.text, names, reader.expression(), token.at)


def read_surface(reader: Reader) -> Sheet:
    """Read what follows ``surface``: a name, two names in parentheses, ``=`` and three expressions."""
    token = reader.name("the name of a surface")
    names = read_formals(reader)
    if len(names) != 2:
        raise reader.error("two names", f"such as 'surface {token.text}(u, v) = u, v - 0.5, u*u'", token)
    reader.expect("=")
    place = [reader.expression()]
    while len(place) < 3:
        reader.expect(",", "a surface has three expressions: along heading, left and up")
        place.append(reader.expression())
    return Sheet(token.text, names, tuple(place), token.at)


def read_formals(reader: Reader) -> tuple[str, ...]:
    """Read names in parentheses, or nothing."""
    if not reader.accept("("):
        return ()
    names: list[str] = []
    if reader.accept(")"):
        return ()
    while True:
        token = reader.name("the name of a parameter")
        if token.text in names:
            raise reader.error("each name once", token=token)
        names.append(token.text)
        if reader.accept(")"):
            return tuple(names)
        reader.expect(",")


def read_production(reader: Reader) -> Production:
    """Read ``left < predecessor > right @ end : condition -> successor : chance``; most of it may be missing."""
    at = reader.next.at
    first = _formal(reader)
    left = None
    if reader.accept("<"):
        left, first = first, _formal(reader)
    right = _formal(reader) if reader.accept(">") else None
    end: Expression = reader.expression() if reader.accept("@") else ONE
    condition = reader.expression() if reader.accept(":") else None
    if reader.next.text != "->":
        raise reader.error("'<', '>', '@', ':' or '->'" if condition is None else "an operator or '->'")
    reader.take()
    successor = () if reader.next.text in (":", "") else read_birth_word(reader)
    chance = reader.expression() if reader.accept(":") else None
    return Production(first, end, successor, left, right, condition, chance, at)


def read_birth_word(reader: Reader) -> tuple[Birth, ...]:
    """Read modules with their birth ages, up to the end of the line or a colon."""
    births: list[Birth] = []
    while not (reader.next.kind == "end" or reader.next.text == ":"):
        births.extend(_births(reader))
    if not births:
        raise reader.error("a module")
    return tuple(births)


def _births(reader: Reader) -> list[Birth]:
    """Read a module; of two symbols that are one piece both."""
    token = reader.next
    if token.text in _DOUBLES and token.kind == "mark":
        reader.take()
        line, column = token.at
        first, last = Birth(token.text[0], at=token.at), Birth(token.text[1], at=(line, column + 1))
        return [first, _with_arguments(reader, last)]
    symbol = _symbol(reader)
    birth = Birth(symbol, at=token.at)
    return [birth] if symbol in BRACKETS else [_with_arguments(reader, birth)]


def _with_arguments(reader: Reader, birth: Birth) -> Birth:
    arguments: list[Expression] = []
    if reader.accept("(") and not reader.accept(")"):
        while True:
            arguments.append(reader.expression())
            if reader.accept(")"):
                break
            reader.expect(",")
    age = reader.birth_age() if reader.accept("@") else ZERO
    return Birth(birth.symbol, tuple(arguments), age, birth.at)


def _formal(reader: Reader) -> Formal:
    token = reader.next
    symbol = _symbol(reader)
    if symbol in BRACKETS:
        raise reader.error("a symbol other than a bracket", "brackets are not rewritten", token)
    return Formal(symbol, read_formals(reader), token.at)


def _symbol(reader: Reader) -> str:
    token = reader.next
    if token.kind == "name" or (token.kind == "mark" and token.text in MARKS):
        reader.take()
        return token.text
    raise reader.error(f"a symbol: a name or one of {' '.join(MARKS)}")
