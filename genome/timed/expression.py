"""Expressions of timed L-systems: trees of numbers, names, operators and functions, and how they are written.

Operators have the precedence of C, with ``^`` as power, right to left, above unary minus and multiplication
(McCormack, section 3.1): ``-2^2`` is -4 and ``2*3^2`` is 18. Relations and logical operators give 1 or 0. Trees are
values: two that are equal mean the same, wherever they were read.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, final

Place = tuple[int, int]
"""Line and column in a file, both counted from one."""

NOWHERE: Final[Place] = (0, 0)
"""The place of what was not read from a file."""

BINDING: Final[Mapping[str, int]] = {
    "||": 1, "&&": 2, "|": 3, "&": 4, "==": 5, "!=": 5, "<": 6, ">": 6, "<=": 6, ">=": 6,
    "+": 7, "-": 7, "*": 8, "/": 8, "%": 8,
}  # fmt: skip
"""How strongly the operators between two operands bind; all of them from left to right."""

UNARY_BINDING: Final = 9
POWER_BINDING: Final = 10

UNARY: Final = ("-", "!")

FUNCTIONS: Final[Mapping[str, int]] = {
    "sin": 1, "cos": 1, "tan": 1, "asin": 1, "acos": 1, "atan": 1, "sqrt": 1, "exp": 1, "log": 1, "abs": 1, "sign": 1,
    "floor": 1, "ceil": 1, "root": 2, "min": 2, "max": 2, "random": 2, "normal": 2, "besselj": 2, "if": 3,
}  # fmt: skip
"""The functions and how many arguments each takes; ``root(n, x)`` is the n-th root. Angles are in radians."""

DRAWS: Final = ("random", "normal")
"""The functions that draw at random."""

CONSTANTS: Final[Mapping[str, float]] = {
    "pi": 3.141592653589793,
    "inf": float("inf"),
    "TRUE": 1.0,
    "FALSE": 0.0,
    "true": 1.0,
    "false": 0.0,
}
"""Names that have a value in every file."""

DEVELOPMENT: Final = "g_"
"""What stands before a symbol in a call of its development function."""


@final
@dataclass(frozen=True, slots=True)
class Number:
    """A number, finite and not negative."""

    value: float


@final
@dataclass(frozen=True, slots=True)
class Name:
    """A parameter, a define, a constant, or in a development function ``age`` or ``end``."""

    name: str
    at: Place = field(default=NOWHERE, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class Unary:
    """``-`` or ``!`` before an operand."""

    operator: str
    operand: Expression


@final
@dataclass(frozen=True, slots=True)
class Binary:
    """An operator of :data:`BINDING`, or ``^``, between two operands."""

    operator: str
    left: Expression
    right: Expression


@final
@dataclass(frozen=True, slots=True)
class Call:
    """A function of :data:`FUNCTIONS`, or the development function ``g_symbol``, with its arguments."""

    function: str
    arguments: tuple[Expression, ...]
    at: Place = field(default=NOWHERE, compare=False, repr=False)


Expression = Number | Name | Unary | Binary | Call

ZERO: Final = Number(0.0)
ONE: Final = Number(1.0)


def parts(expression: Expression) -> Iterator[Expression]:
    """Give an expression and all that it is made of, each before its own parts, from left to right."""
    yield expression
    if isinstance(expression, Unary):
        yield from parts(expression.operand)
    elif isinstance(expression, Binary):
        yield from parts(expression.left)
        yield from parts(expression.right)
    elif isinstance(expression, Call):
        for argument in expression.arguments:
            yield from parts(argument)


def draws(expression: Expression) -> bool:
    """Whether an expression draws at random; calls of development functions are not looked into."""
    return any(isinstance(part, Call) and part.function in DRAWS for part in parts(expression))


def substituted(expression: Expression, values: Mapping[str, Expression]) -> Expression:
    """Put expressions in the place of names."""
    if isinstance(expression, Name):
        return values.get(expression.name, expression)
    if isinstance(expression, Unary):
        return Unary(expression.operator, substituted(expression.operand, values))
    if isinstance(expression, Binary):
        left, right = substituted(expression.left, values), substituted(expression.right, values)
        return Binary(expression.operator, left, right)
    if isinstance(expression, Call):
        arguments = tuple(substituted(argument, values) for argument in expression.arguments)
        return Call(expression.function, arguments, expression.at)
    return expression


def format_expression(expression: Expression) -> str:
    """Write an expression with no more parentheses than it needs; read again, it is the same tree."""
    return _written(expression)[0]


def format_number(value: float) -> str:
    """Write a number that is not negative so that it is read as the same; whole ones without a point."""
    return str(int(value)) if value == int(value) and value < 1e15 else repr(value)


def _written(expression: Expression) -> tuple[str, int]:
    """Give the text, and how strongly its outermost operator binds."""
    if isinstance(expression, Number):
        return format_number(expression.value), POWER_BINDING + 1
    if isinstance(expression, Name):
        return expression.name, POWER_BINDING + 1
    if isinstance(expression, Call):
        inside = ", ".join(format_expression(argument) for argument in expression.arguments)
        return f"{expression.function}({inside})", POWER_BINDING + 1
    if isinstance(expression, Unary):
        return expression.operator + _enclosed(expression.operand, UNARY_BINDING), UNARY_BINDING
    if expression.operator == "^":
        left, right = _enclosed(expression.left, POWER_BINDING + 1), _enclosed(expression.right, UNARY_BINDING)
        return f"{left}^{right}", POWER_BINDING
    binding = BINDING[expression.operator]
    left, right = _enclosed(expression.left, binding), _enclosed(expression.right, binding + 1)
    return f"{left} {expression.operator} {right}", binding


def _enclosed(expression: Expression, least: int) -> str:
    text, binding = _written(expression)
    return text if binding >= least else f"({text})"
