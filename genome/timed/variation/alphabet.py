"""The grammar of a system's own alphabet: what its productions could as well be.

Its sentences are successors, modules and conditions, in the words of the file that they vary: the file's symbols with
as many parameters as there, and of each parameter the expressions that the file has for it, where the names in them
are known. So an angle stays an angle, and what counts down goes on to count down.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from genome.timed.expression import CONSTANTS, Binary, Expression, Name, Number, format_expression, parts
from genome.timed.system import BRACKETS, Birth, TimedSystem

TURNS: Final = "+-^&/\\"
"""Turtle commands whose parameter is an angle."""

HEAD: Final = """# What productions are written in: <Successor.X>, <Module.X>, <Condition.X> for productions of X; those
# without a symbol would be for every other. docs/timed-evolution.md says more.
"""

_MARKS: Final = {
    "+": "plus", "-": "minus", "^": "caret", "&": "and", "/": "slash", "\\": "backslash", "[": "open", "]": "close",
    "!": "bang", "|": "bar", "$": "dollar", "{": "brace", "}": "endbrace", "~": "tilde", "'": "quote",
}  # fmt: skip


def spelt(symbol: str) -> str:
    """Give a symbol as names of non-terminals have it: marks as no name can be, such as ``-plus``."""
    return f"-{_MARKS[symbol]}" if symbol in _MARKS else symbol


def own_grammar(system: TimedSystem, symbols: Sequence[str]) -> str:
    """Write the grammar of a system's own alphabet, as the text of a ``.bnf`` file.

    Parameters
    ----------
    system
        The file's; what is inside systems inside it is not looked at.
    symbols
        Those whose productions vary.

    Returns
    -------
    str
        Empty where no symbol varies.
    """
    births = _births(system)
    lines = [line for symbol in symbols for line in _of_symbol(system, symbol, births)]
    if not lines:
        return ""
    factors = "<Factor> ::= 0.5 | 0.7 | 0.9 | 1.1 | 1.4 | 2"
    shares = "<Share> ::= 0.25 | 0.5 | 0.75"
    return HEAD + "\n".join([*lines, factors, shares]) + "\n"


def _births(system: TimedSystem) -> list[Birth]:
    words = (system.axiom, *(production.successor for production in system.productions))
    return [birth for word in words for birth in word if birth.symbol not in BRACKETS]


def _of_symbol(system: TimedSystem, symbol: str, births: Sequence[Birth]) -> Iterator[str]:
    first = next(one for one in system.productions if one.predecessor.symbol == symbol)
    own = first.predecessor.parameters
    names = (*own, *(define.name for define in system.defines), *CONSTANTS)
    name = spelt(symbol)
    yield f"<Successor.{name}> ::= <Item.{name}> {{ <Item.{name}> }} {{ <Item.{name}> }}"
    yield f'<Item.{name}> ::= <Module.{name}> | <Module.{name}> | <Module.{name}> | "[" <Successor.{name}> "]"'
    heads = list(dict.fromkeys((birth.symbol, len(birth.arguments)) for birth in births))
    yield f"<Module.{name}> ::= " + " | ".join(_head(head, name, births, names) for head in heads)
    for head, count in heads:
        for index in range(count):
            given = [
                birth.arguments[index] for birth in births if (birth.symbol, len(birth.arguments)) == (head, count)
            ]
            choices = _argument(system, head, given, names, own)
            yield f"<Argument.{spelt(head)}.{count}.{index}.{name}> ::= " + " | ".join(choices)
    yield f"<Condition.{name}> ::= " + " | ".join(_conditions(system, names, own))


def _head(head: tuple[str, int], name: str, births: Sequence[Birth], names: Sequence[str]) -> str:
    """Write a module, and again for each birth age other than 0 that the file has for it."""
    symbol, count = head
    text = _quoted(symbol)
    if count:
        inside = ' "," '.join(f"<Argument.{spelt(symbol)}.{count}.{index}.{name}>" for index in range(count))
        text += f' "(" {inside} ")"'
    ages = [birth.age for birth in births if (birth.symbol, len(birth.arguments)) == head and _known(birth.age, names)]
    late = list(dict.fromkeys(format_expression(age) for age in ages if age != Number(0.0)))
    return " | ".join([text, *(f'{text} "@" {_quoted(f"({age})")}' for age in late)])


def _argument(
    system: TimedSystem, head: str, given: Sequence[Expression], names: Sequence[str], own: Sequence[str]
) -> list[str]:
    """Write what an argument can be: as the file has it somewhere, or that by a factor unless it counts."""
    known = list(dict.fromkeys(one for one in given if _known(one, names)))
    if not known:
        if head in TURNS:
            return [_quoted("pi/8" if system.radians else "22.5")]
        return [_quoted(one) for one in (*own, "1")]
    found = []
    for one in known:
        text = format_expression(one)
        found.append(_quoted(text))
        named = any(isinstance(part, Name) and part.name in own for part in parts(one))
        counts = isinstance(one, Binary) and one.operator in ("+", "-")
        if named and not counts:
            found.append(f'{_quoted(f"({text})")} "*" <Factor>')
    return found


def _conditions(system: TimedSystem, names: Sequence[str], own: Sequence[str]) -> list[str]:
    given = [one.condition for one in system.productions if one.condition is not None]
    found = [_quoted(format_expression(one)) for one in dict.fromkeys(given) if _known(one, names)]
    found += [_quoted(f"{name} > {least}") for name in own for least in (1, 2)]
    return [*dict.fromkeys(found), '"random(0, 1) <" <Share>']


def _known(expression: Expression, names: Sequence[str]) -> bool:
    return all(part.name in names for part in parts(expression) if isinstance(part, Name))


def _quoted(text: str) -> str:
    return f'"{text}"'
