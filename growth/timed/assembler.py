"""Assembling expressions into instructions of the stack machine."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from genome.errors import InputError
from genome.timed import Binary, Call, Expression, Name, Number, Scope, Unary
from genome.timed.expression import CONSTANTS, DEVELOPMENT, DRAWS
from growth.timed import _expressions
from growth.timed.tables import (
    BINARY_CODES,
    FUNCTION_CODES,
    JUMP,
    JUMP_IF_NOT,
    LOAD,
    NONE,
    PUSH,
    STORE,
    TRUTH,
    UNARY_CODES,
)

Meanings = Mapping[str, int | float]
"""What names mean: an int is a slot, a float a value."""

MOST_INSTRUCTIONS: Final = 200_000
MOST_NESTED: Final = 300


@final
@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """A scope with the values of the defines that are seen in it, and the place around it."""

    scope: Scope
    defines: Mapping[str, float]
    outer: Place | None

    def owner(self, symbol: str) -> Place:
        """Give the place that a symbol belongs to, as seen from here."""
        place = self
        while not place.scope.has(symbol) and place.outer is not None:
            place = place.outer
        return place

    def command(self, symbol: str) -> tuple[Place, str]:
        """Give the symbol that the turtle takes one of this place for, and the place that it belongs to."""
        place, command = self, symbol
        while (equiv := place.scope.equiv(command)) is not None:
            place, command = place.owner(equiv.command), equiv.command
        return place, command

    def meanings(self, slots: Mapping[str, int]) -> Meanings:
        """Give what names mean here, where these are slots."""
        return {**CONSTANTS, **self.defines, **slots}


@final
class Assembler:
    """Collects the instructions of expressions.

    Parameters
    ----------
    width
        Slots under this are parameters; those of called development functions come behind.
    """

    def __init__(self, width: int) -> None:
        self.width = width
        self.ops: list[int] = []
        self.args: list[float] = []
        self.spans: list[tuple[int, int]] = []
        self.known: list[float] = []
        self.loads: list[int] = []
        self.sites = 0
        self.room = width + 1
        self._numbers: dict[float, int] = {}
        self._height = 0
        self._kept = width
        self._constant = True

    def constant(self, value: float) -> int:
        """Give the number of an expression that is a constant."""
        if value not in self._numbers:
            self._numbers[value] = self._put(Number(value), {}, None)
        return self._numbers[value]

    def add(self, expression: Expression, meanings: Meanings, place: Place) -> int:
        """Assemble an expression and give its number.

        Raises
        ------
        InputError
            When the system is too large.
        """
        if isinstance(expression, Number):
            return self.constant(expression.value)
        return self._put(expression, meanings, place)

    def row(self, expressions: tuple[Expression, ...], meanings: Meanings, place: Place) -> tuple[int, int]:
        """Assemble expressions under consecutive numbers; give the first, and the one behind the last."""
        begin = len(self.spans)
        for expression in expressions:
            self._put(expression, meanings, place)
        return begin, len(self.spans)

    def value(self, number: int) -> tuple[float, int]:
        """Evaluate an expression that asks for no slot; give its value, and what is wrong with it."""
        spans = np.array([self.spans[number]], dtype=np.int64)
        ops, args = np.array(self.ops, dtype=np.int64), np.array(self.args, dtype=np.float64)
        slots, stack = np.empty(self.room), np.empty(self.room)
        value, trouble = _expressions.evaluated(ops, args, spans, 0, slots, np.uint64(0), stack)
        return float(value), int(trouble)

    def _put(self, expression: Expression, meanings: Meanings, place: Place | None) -> int:
        begin = len(self.ops)
        self._height, self._kept, self._constant = 0, self.width, True
        self._emit(expression, meanings, place, 0)
        self.spans.append((begin, len(self.ops)))
        value, number = math.nan, len(self.spans) - 1
        if self._constant:
            value, trouble = (self.args[-1], 0) if self.ops[begin:] == [PUSH] else self.value(number)
            value = math.nan if trouble else value  # told of when it is evaluated, with module and time
        self.known.append(value)
        self.loads.append(int(self.args[-1]) if self.ops[begin:] == [LOAD] else NONE)
        return number

    def _emit(self, expression: Expression, meanings: Meanings, place: Place | None, depth: int) -> None:
        if depth > MOST_NESTED or len(self.ops) > MOST_INSTRUCTIONS:
            raise InputError("system", "development functions that call each other less", "too many calls")
        if isinstance(expression, Number):
            self._push(expression.value)
        elif isinstance(expression, Name):
            self._name(meanings[expression.name])
        elif isinstance(expression, Unary):
            self._emit(expression.operand, meanings, place, depth + 1)
            self._instruct(UNARY_CODES[expression.operator])
        elif isinstance(expression, Binary):
            self._binary(expression, meanings, place, depth + 1)
        else:
            self._call(expression, meanings, place, depth + 1)

    def _name(self, meaning: float) -> None:
        if isinstance(meaning, int):
            self._constant = False
            self._grow()
            self._instruct(LOAD, meaning)
        else:
            self._push(meaning)

    def _push(self, value: float) -> None:
        self._grow()
        self._instruct(PUSH, value)

    def _binary(self, expression: Binary, meanings: Meanings, place: Place | None, depth: int) -> None:
        if expression.operator in ("&&", "&", "||", "|"):
            self._logical(expression, meanings, place, depth)
            return
        self._emit(expression.left, meanings, place, depth)
        self._emit(expression.right, meanings, place, depth)
        self._take(BINARY_CODES[expression.operator])

    def _logical(self, expression: Binary, meanings: Meanings, place: Place | None, depth: int) -> None:
        """Leave the right operand alone where the left decides."""
        self._emit(expression.left, meanings, place, depth)
        otherwise = self._jump(JUMP_IF_NOT)
        self._height -= 1
        ways: tuple[Expression | None, Expression | None] = (expression.right, None)
        if "|" in expression.operator:
            ways = (None, expression.right)
        ends: list[int] = []
        for way, decided in zip(ways, (1.0, 0.0), strict=True):
            height = self._height
            if way is None:
                self._push(decided)
            else:
                self._emit(way, meanings, place, depth)
                self._instruct(TRUTH)
            if not ends:
                ends.append(self._jump(JUMP))
                self.args[otherwise] = len(self.ops)
                self._height = height
        self.args[ends[0]] = len(self.ops)

    def _call(self, call: Call, meanings: Meanings, place: Place | None, depth: int) -> None:
        if call.function == "if":
            self._if(call, meanings, place, depth)
        elif call.function.startswith(DEVELOPMENT):
            assert place is not None
            self._development(call, meanings, place, depth)
        else:
            for argument in call.arguments:
                self._emit(argument, meanings, place, depth)
            code = FUNCTION_CODES[call.function]
            if call.function in DRAWS:
                self._constant = False
                self.sites += 1
                self._take(code, self.sites)
            elif len(call.arguments) == 2:
                self._take(code)
            else:
                self._instruct(code)

    def _if(self, call: Call, meanings: Meanings, place: Place | None, depth: int) -> None:
        condition, then, otherwise = call.arguments
        self._emit(condition, meanings, place, depth)
        no = self._jump(JUMP_IF_NOT)
        self._height -= 1
        height = self._height
        self._emit(then, meanings, place, depth)
        end = self._jump(JUMP)
        self.args[no] = len(self.ops)
        self._height = height
        self._emit(otherwise, meanings, place, depth)
        self.args[end] = len(self.ops)

    def _development(self, call: Call, meanings: Meanings, place: Place, depth: int) -> None:
        """Put the body of a development function here; its arguments are evaluated once, and kept in slots."""
        symbol = call.function.removeprefix(DEVELOPMENT)
        owner = place.owner(symbol)
        development = owner.scope.development(symbol)
        assert development is not None
        for argument in call.arguments:
            self._emit(argument, meanings, place, depth)
        first = self._kept
        self._kept += len(call.arguments)
        self.room = max(self.room, self._kept + 1)
        for slot in range(self._kept - 1, first - 1, -1):
            self._take(STORE, slot)
        own = owner.meanings({name: first + at for at, name in enumerate(development.names)})
        constant = self._constant
        self._emit(development.body, own, owner, depth)
        self._constant = constant and self._constant

    def _jump(self, op: int) -> int:
        self._instruct(op)
        return len(self.ops) - 1

    def _take(self, op: int, arg: float = 0.0) -> None:
        """Add an instruction that leaves one value less."""
        self._instruct(op, arg)
        self._height -= 1

    def _instruct(self, op: int, arg: float = 0.0) -> None:
        self.ops.append(op)
        self.args.append(float(arg))

    def _grow(self) -> None:
        self._height += 1
        self.room = max(self.room, self._height + 1)
