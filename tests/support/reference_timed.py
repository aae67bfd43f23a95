"""Timed growth as plain Python: the paper's definitions, module by module, slow and plain.

Expressions are walked as trees; a word is a list of :class:`Cell`. Events are done one instant after the other, whether
or not a system has contexts, so that it shows, too, that the kernels' order does not matter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from genome.timed import Binary, Call, Name, Number, Scope, TimedSystem, Unary
from genome.timed.expression import CONSTANTS

MASK = 2**64 - 1
CLOSE = 2.0**-40


class TroubleError(Exception):
    """What the engine gives as a Failure."""


def branched(key: int, number: int) -> int:
    z = (key + 0x9E3779B97F4A7C15 * (number + 1)) & MASK
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return z ^ (z >> 31)


def uniform(key: int, number: int) -> float:
    return (branched(branched(key, number), 0) >> 11) * 2.0**-53


def evaluate(expression: Any, names: dict[str, float], scope: Scope, defines: dict[int, dict[str, float]]) -> float:
    """Walk a tree; nothing in it may draw at random."""

    def walk(e: Any) -> float:
        return evaluate(e, names, scope, defines)

    if isinstance(expression, Number):
        return expression.value
    if isinstance(expression, Name):
        return names[expression.name]
    if isinstance(expression, Unary):
        value = walk(expression.operand)
        return -value if expression.operator == "-" else float(value == 0.0)
    if isinstance(expression, Binary):
        return _binary(expression, walk)
    return _call(expression, walk, scope, defines)


def _binary(e: Binary, walk) -> float:
    if e.operator in ("&", "&&"):
        return float(walk(e.left) != 0.0 and walk(e.right) != 0.0)
    if e.operator in ("|", "||"):
        return float(walk(e.left) != 0.0 or walk(e.right) != 0.0)
    x, y = walk(e.left), walk(e.right)
    try:
        value = {
            "+": lambda: x + y, "-": lambda: x - y, "*": lambda: x * y, "/": lambda: x / y,
            "%": lambda: math.fmod(x, y), "^": lambda: math.pow(x, y),
            "==": lambda: float(x == y), "!=": lambda: float(x != y), "<": lambda: float(x < y),
            ">": lambda: float(x > y), "<=": lambda: float(x <= y), ">=": lambda: float(x >= y),
        }[e.operator]()  # fmt: skip
    except OverflowError:  # Python's word for a power that a double cannot hold
        return math.inf if x > 0.0 or math.fmod(y, 2.0) == 0.0 else -math.inf
    except (ZeroDivisionError, ValueError) as error:
        raise TroubleError(str(error)) from None
    if math.isnan(value):
        raise TroubleError("not a number")
    return value


def _call(e: Call, walk, scope: Scope, defines) -> float:
    if e.function == "if":
        condition, then, otherwise = e.arguments
        return walk(then) if walk(condition) != 0.0 else walk(otherwise)
    values = [walk(argument) for argument in e.arguments]
    if e.function.startswith("g_"):
        symbol = e.function[2:]
        owner = scope.owner(symbol)
        development = owner.development(symbol)
        named = dict(zip(development.names, values, strict=True))
        return evaluate(development.body, {**CONSTANTS, **defines[id(owner.system)], **named}, owner, defines)
    try:
        value = _function(e.function, values)
    except OverflowError:
        return math.inf
    except (ZeroDivisionError, ValueError) as error:
        raise TroubleError(str(error)) from None
    if math.isnan(value):
        raise TroubleError("not a number")
    return value


def _function(name: str, values: list[float]) -> float:
    if name == "root":
        n, x = values
        if n == 0.0 or (x == 0.0 and n < 0.0):
            raise ZeroDivisionError("root")
        if x < 0.0:
            if n == math.floor(n) and math.fmod(n, 2.0) != 0.0:
                return -math.pow(-x, 1.0 / n)
            raise ValueError("root")
        return math.pow(x, 1.0 / n)
    if name == "besselj":
        import scipy.special

        return float(scipy.special.jv(*values))
    if name in ("floor", "ceil"):
        return values[0] if math.isinf(values[0]) else float(getattr(math, name)(values[0]))
    if name == "sign":
        return float((values[0] > 0.0) - (values[0] < 0.0))
    if name in ("min", "max", "abs"):
        return {"min": min, "max": max, "abs": abs}[name](*values)
    return getattr(math, name)(*values)


@dataclass
class Cell:
    """A module of a word."""

    scope: Scope
    symbol: str
    parameters: list[float]
    origin: float
    dies: float
    key: int
    asks: int = 0


@dataclass
class Reference:
    """Derives a checked system that draws nothing at random but which production it takes."""

    system: TimedSystem
    seed: int = 0
    word: list[Cell] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.defines: dict[int, dict[str, float]] = {}
        self.scopes: dict[int, Scope] = {}
        root = self._enter(self.system, None)
        start = branched(self.seed, 0)
        self.word = self._births(self.system.axiom, root, {}, 0.0, start)

    def _enter(self, system: TimedSystem, outer: Scope | None) -> Scope:
        if id(system) not in self.scopes:
            scope = self.scopes[id(system)] = Scope(system, outer)
            values = dict(self.defines[id(outer.system)]) if outer else {}
            self.defines[id(system)] = values
            for define in system.defines:
                values[define.name] = self._value(define.value, {}, scope)
        return self.scopes[id(system)]

    def _value(self, expression: Any, names: dict[str, float], scope: Scope) -> float:
        known = {**CONSTANTS, **self.defines[id(scope.system)], **names}
        return evaluate(expression, known, scope, self.defines)

    def _end(self, scope: Scope, symbol: str, parameters: list[float]) -> float:
        productions = scope.productions(symbol)
        if not productions:
            return math.inf
        names = dict(zip(productions[0].predecessor.parameters, parameters, strict=True))
        end = self._value(productions[0].end, names, scope)
        if end < 0.0:
            raise TroubleError("negative terminal age")
        return end

    def _births(self, births, scope: Scope, names: dict[str, float], instant: float, moment: int) -> list[Cell]:
        cells = []
        for place, birth in enumerate(births):
            parameters = [self._value(argument, names, scope) for argument in birth.arguments]
            age = self._value(birth.age, names, scope)
            if not 0.0 <= age < math.inf or not all(map(math.isfinite, parameters)):
                raise TroubleError("birth")
            owner = scope.owner(birth.symbol)
            key = branched(moment, (1 << 42) + place)
            inner = owner.inside(birth.symbol)
            if inner is not None:
                own = dict(zip(inner.parameters, parameters, strict=True))
                inside = self._enter(inner, owner)
                cells += self._births(inner.axiom, inside, own, instant - age, branched(key, 0))
                continue
            end = self._end(owner, birth.symbol, parameters)
            cells.append(Cell(owner, birth.symbol, parameters, instant - age, max(instant, instant - age + end), key))
        return cells

    def at(self, time: float) -> list[tuple[str, list[float], float]]:
        """Go on to a time; give symbols, developed parameters and ages."""
        while True:
            instant = min((cell.dies for cell in self.word), default=math.inf)
            if instant > time + time * CLOSE:
                return [self._developed(cell, time) for cell in self.word]
            self._instant(instant + abs(instant) * CLOSE)

    def _instant(self, limit: float) -> None:
        after: list[Cell] = []
        for at, cell in enumerate(self.word):
            after += [cell] if cell.dies > limit else self._rewritten(cell, at)
        self.word = after

    def _rewritten(self, cell: Cell, at: int) -> list[Cell]:
        moment = branched(cell.key, cell.asks)
        passed, number = 0.0, uniform(moment, 1 << 40)
        for production in cell.scope.productions(cell.symbol):
            names = dict(zip(production.predecessor.parameters, cell.parameters, strict=True))
            sides = (production.left, self.left(at)), (production.right, self.right(at))
            if not all(self._joins(formal, other, cell.scope, names) for formal, other in sides):
                continue
            if production.condition is not None and self._value(production.condition, names, cell.scope) == 0.0:
                continue
            if production.chance is not None:
                chance = self._value(production.chance, names, cell.scope)
                if not 0.0 <= chance <= 1.0:
                    raise TroubleError("chance")
                passed += chance
                if number >= passed:
                    continue
            return self._births(production.successor, cell.scope, names, cell.dies, moment)
        span = self._end(cell.scope, cell.symbol, cell.parameters)
        stays = Cell(cell.scope, cell.symbol, cell.parameters, cell.origin, math.inf, cell.key, cell.asks + 1)
        changes = any(p.left or p.right or p.chance is not None for p in cell.scope.productions(cell.symbol))
        if span > 0.0 and changes:
            stays.dies = cell.dies + span
        return [stays]

    def _joins(self, formal, other: Cell | None, scope: Scope, names: dict[str, float]) -> bool:
        if formal is None:
            return True
        if other is None or other.symbol != formal.symbol or other.scope is not scope.owner(formal.symbol):
            return False
        names |= dict(zip(formal.parameters, other.parameters, strict=True))
        return True

    def left(self, at: int) -> Cell | None:
        """The nearest module before, on the way to the root."""
        closed = 0
        for cell in reversed(self.word[:at]):
            if cell.symbol == "]":
                closed += 1
            elif cell.symbol == "[":
                closed = max(0, closed - 1)
            elif not closed and cell.symbol not in self.system.ignored:
                return cell
        return None

    def right(self, at: int) -> Cell | None:
        """The next module on the same branch."""
        opened = 0
        for cell in self.word[at + 1 :]:
            if cell.symbol == "[":
                opened += 1
            elif cell.symbol == "]":
                if not opened:
                    return None
                opened -= 1
            elif not opened and cell.symbol not in self.system.ignored:
                return cell
        return None

    def _developed(self, cell: Cell, time: float) -> tuple[str, list[float], float]:
        age = max(0.0, time - cell.origin)
        development = cell.scope.development(cell.symbol)
        factor = 1.0
        if development is not None:
            slots = cell.scope.slots(development)
            names = {name: cell.parameters[slot] for name, slot in slots.items()}
            names |= {"age": age, "end": self._end(cell.scope, cell.symbol, cell.parameters)}
            factor = self._value(development.body, names, cell.scope)
        values = [factor * value for value in cell.parameters]
        if not all(map(math.isfinite, [factor, *values])):
            raise TroubleError("overflow")
        return cell.symbol, values, age
