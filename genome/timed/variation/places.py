"""Where numbers stand in a system, and how they are exchanged for others."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

from genome.timed.expression import Binary, Call, Expression, Number, Unary, parts
from genome.timed.system import BRACKETS, Birth, Production, TimedSystem


class Role(NamedTuple):
    """What a literal is there for.

    Attributes
    ----------
    what
        ``argument``, ``age`` (of a birth), ``end`` (the terminal age), ``condition``, or ``chance``.
    symbol
        Of which module.
    slot
        Of which of its parameters; 0 for the others.
    alone
        Whether it is the whole expression, and not a part of one.
    """

    what: str
    symbol: str
    slot: int
    alone: bool


Change = Callable[[Role, float], float]


def literals(system: TimedSystem, varies: Callable[[str], bool]) -> Iterator[tuple[Role, float]]:
    """Give the numbers of axiom and productions, in the order of :func:`with_literals`.

    Parameters
    ----------
    system
        The system; those inside it are left as they are.
    varies
        Whether the productions of a symbol are looked at.
    """
    found: list[tuple[Role, float]] = []

    def look(role: Role, value: float) -> float:
        found.append((role, value))
        return value

    with_literals(system, varies, look)
    return iter(found)


def with_literals(system: TimedSystem, varies: Callable[[str], bool], change: Change) -> TimedSystem:
    """Give a system with other numbers.

    A terminal age is asked for once for each symbol: it is the same in all its productions.
    """
    axiom = _word(system.axiom, change)
    ends: dict[str, list[float]] = {}
    productions = tuple(
        _production(one, ends, change) if varies(one.predecessor.symbol) else one for one in system.productions
    )
    return replace(system, axiom=axiom, productions=productions)


def _production(production: Production, ends: dict[str, list[float]], change: Change) -> Production:
    symbol = production.predecessor.symbol
    if symbol not in ends:
        end = _changed(production.end, Role("end", symbol, 0, alone=True), change)
        ends[symbol] = [part.value for part in parts(end) if isinstance(part, Number)]
    else:
        # The terminal ages of a symbol differ in the names of parameters at most.
        given = iter(ends[symbol])
        end = _changed(production.end, Role("end", symbol, 0, alone=True), lambda _, value: next(given, value))
    asked = [
        None if one is None else _changed(one, Role(what, symbol, 0, alone=True), change)
        for what, one in (("condition", production.condition), ("chance", production.chance))
    ]
    successor = _word(production.successor, change)
    return replace(production, end=end, condition=asked[0], chance=asked[1], successor=successor)


def _word(word: tuple[Birth, ...], change: Change) -> tuple[Birth, ...]:
    return tuple(birth if birth.symbol in BRACKETS else _birth(birth, change) for birth in word)


def _birth(birth: Birth, change: Change) -> Birth:
    arguments = tuple(
        _changed(one, Role("argument", birth.symbol, index, alone=True), change)
        for index, one in enumerate(birth.arguments)
    )
    return replace(
        birth, arguments=arguments, age=_changed(birth.age, Role("age", birth.symbol, 0, alone=True), change)
    )


def _changed(expression: Expression, role: Role, change: Change) -> Expression:
    if isinstance(expression, Number):
        return Number(change(role, expression.value))
    if isinstance(expression, Unary):
        # A sign belongs to the number behind it.
        inner = role if expression.operator == "-" else role._replace(alone=False)
        return Unary(expression.operator, _changed(expression.operand, inner, change))
    part = role._replace(alone=False)
    if isinstance(expression, Binary):
        left = _changed(expression.left, part, change)
        return Binary(expression.operator, left, _changed(expression.right, part, change))
    if isinstance(expression, Call):
        arguments = tuple(_changed(one, part, change) for one in expression.arguments)
        return Call(expression.function, arguments, expression.at)
    return expression
