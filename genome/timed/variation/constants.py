"""What of a system is constant: defines, terminal ages, birth ages, as far as they are plain arithmetic."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from genome.timed.expression import CONSTANTS, Binary, Expression, Name, Number, Unary
from genome.timed.system import Birth, TimedSystem

Values = Mapping[str, float]


def constant(expression: Expression, values: Values) -> float | None:
    """Evaluate an expression of numbers, names of known values, and ``+ - * / ^``.

    Returns
    -------
    float or None
        Finite; ``None`` where anything else stands in it, or it has no value.
    """
    found = _value(expression, values)
    return found if found is not None and math.isfinite(found) else None


def _value(expression: Expression, values: Values) -> float | None:
    if isinstance(expression, Number):
        return expression.value
    if isinstance(expression, Name):
        return values.get(expression.name, CONSTANTS.get(expression.name))
    if isinstance(expression, Unary) and expression.operator == "-":
        inner = _value(expression.operand, values)
        return None if inner is None else -inner
    if isinstance(expression, Binary):
        left, right = _value(expression.left, values), _value(expression.right, values)
        return None if left is None or right is None else _joined(expression.operator, left, right)
    return None


def _joined(operator: str, left: float, right: float) -> float | None:
    try:
        if operator == "^":
            power: Final = left**right
            return power if isinstance(power, float) else None
        return (
            {"+": left + right, "-": left - right, "*": left * right}.get(operator) if operator != "/" else left / right
        )
    except (ZeroDivisionError, OverflowError):
        return None


def define_values(system: TimedSystem) -> dict[str, float]:
    """Give the values of those defines that are plain arithmetic."""
    values: dict[str, float] = {}
    for define in system.defines:
        value = constant(define.value, values)
        if value is not None:
            values[define.name] = value
    return values


def stillborn(system: TimedSystem) -> tuple[str, ...]:
    """Give the symbols, sorted, that are born somewhere at or over their terminal age, both constant and over 0.

    Their modules have no lifetime (docs/formats/tl.md). A terminal age of 0 is meant, and not told.
    """
    values = define_values(system)
    ends: dict[str, float] = {}
    for production in system.productions:
        end = constant(production.end, values)
        if end is not None and end > 0.0:
            ends[production.predecessor.symbol] = end
    found: dict[str, None] = {}
    for word in (system.axiom, *(production.successor for production in system.productions)):
        found.update(dict.fromkeys(birth.symbol for birth in word if _too_old(birth, ends, values)))
    return tuple(sorted(found))


def _too_old(birth: Birth, ends: Values, values: Values) -> bool:
    if birth.symbol not in ends:
        return False
    age = constant(birth.age, values)
    return age is not None and age >= ends[birth.symbol]
