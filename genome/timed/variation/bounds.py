"""Between which values the numbers of a system vary."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

from genome.timed.expression import Binary, Name, Number
from genome.timed.system import TimedSystem
from genome.timed.variation.places import Role, literals

DIGITS = 6
"""Numbers are drawn with so many digits, so that files stay legible."""


class Bounds(NamedTuple):
    """The least and the most, and whether only whole numbers are meant."""

    low: float
    high: float
    whole: bool = False

    def within(self, value: float) -> float:
        """Give the nearest number that may stand there, of few digits."""
        if self.whole:
            return float(min(max(round(value), math.ceil(self.low)), math.floor(self.high)))
        return min(max(float(f"{value:.{DIGITS}g}"), self.low), self.high)


def bounds_of(system: TimedSystem, factor: float, varies: Callable[[str], bool]) -> dict[Role, Bounds]:
    """Give the bounds of a file's literals by what they are there for.

    All literals of one role (an argument of one symbol, its birth age, its terminal age, ...; alone or in an
    expression) share bounds: from the smallest of them over the factor to the largest times the factor. Of a parameter
    that counts (some module has ``n - 1`` or ``n + 1`` there) they are whole numbers. Zeros stay zeros, and chances lie
    up to 1.

    Parameters
    ----------
    system
        The file's.
    factor
        1 or more.
    varies
        Whether the productions of a symbol vary.
    """
    seen: dict[Role, list[float]] = {}
    for role, value in literals(system, varies):
        if value > 0.0:
            seen.setdefault(role, []).append(value)
    counts = _counting(system)
    return {role: _around(role, values, factor, counts) for role, values in seen.items()}


def free(role: Role, value: float, known: Mapping[Role, Bounds], factor: float) -> Bounds | None:
    """Give a literal's bounds; ``None`` where it stays as it is.

    One for whose role the file has none was written by the grammar. It is a factor, and lies within ``factor`` of 1;
    one that does not, stays.
    """
    bounds = known.get(role, Bounds(1.0 / factor, factor))
    if value <= 0.0 or bounds.low >= bounds.high or (role not in known and not bounds.low <= value <= bounds.high):
        return None
    return bounds


def _around(role: Role, values: list[float], factor: float, counts: Mapping[tuple[str, int], bool]) -> Bounds:
    low, high = min(values) / factor, max(values) * factor
    if role.what == "chance":
        high = max(min(high, 1.0), *values)
    if role.what == "argument" and (role.symbol, role.slot) in counts and all(one == int(one) for one in values):
        return Bounds(max(1.0, math.ceil(low)), math.floor(high), whole=True)
    return Bounds(low, high)


def _counting(system: TimedSystem) -> dict[tuple[str, int], bool]:
    """Give the parameters that count, by symbol and place."""
    words = [production.successor for production in system.productions]
    return {
        (birth.symbol, index): True
        for word in words
        for birth in word
        for index, argument in enumerate(birth.arguments)
        if isinstance(argument, Binary)
        and argument.operator in ("+", "-")
        and isinstance(argument.left, Name)
        and isinstance(argument.right, Number)
        and argument.right.value == int(argument.right.value)
    }
