"""The kernels of expressions: the stack machine, what it draws at random, terminal ages.

Numbers drawn are functions of a lineage and of the place in the system, so that neither the order of modules nor the
times asked for change a bit. `tests/support/reference_timed.py` is the same as plain Python, and must give equal
results.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from numba import njit

# isort: off
from growth.timed.tables import (
    ABS, ADD, ARC_DOMAIN, ASIN, ATAN, BESSEL_DOMAIN, COS, DIV, DIVISION, EQ, EXP, FLOOR, Floats, GE, GT, Ints, JUMP,
    JUMP_IF_NOT, LE, LOAD, LOG, LOG_DOMAIN, LT, MAX, MIN, MOD, MUL, NE, NEG, NEGATIVE_AGE, NONE, NOT, NOT_FINITE,
    POW, POWER_DOMAIN, PUSH, RANDOM, ROOT, ROOT_DOMAIN, SIGN, SIN, SPREAD, SQRT, STORE, SUB, TAN, TRUTH,
)  # fmt: skip
# isort: on

_OPTIONS: Final[Any] = {"cache": True, "error_model": "numpy", "_nrt": False}
_lent: Final = njit(**_OPTIONS)
"""For what makes no arrays: to count references to those that it is given takes longer than all else it does."""

_GOLDEN: Final = np.uint64(0x9E3779B97F4A7C15)
_FIRST: Final = np.uint64(0xBF58476D1CE4E5B9)
_SECOND: Final = np.uint64(0x94D049BB133111EB)

_BIRTH: Final = 1 << 41
"""Numbers of branches of a lineage: terminal age."""

_FARTHEST: Final = 1e5
"""Bessel functions are computed of numbers and orders up to this."""


@njit(cache=True)
def branched(key: np.uint64, number: int) -> np.uint64:
    """Give the key of a branch of a lineage (the finaliser of SplitMix64: Steele, Lea and Flood 2014)."""
    z = key + _GOLDEN * (np.uint64(number) + np.uint64(1))
    z = (z ^ (z >> np.uint64(30))) * _FIRST
    z = (z ^ (z >> np.uint64(27))) * _SECOND
    return z ^ (z >> np.uint64(31))


@njit(cache=True)
def uniform(key: np.uint64, number: int) -> float:
    """Draw from 0 up to, and without, 1, in steps of 2**-53."""
    return np.float64(branched(branched(key, number), 0) >> np.uint64(11)) * 2.0**-53


@njit(cache=True)
def bessel(order: float, x: float) -> tuple[float, int]:
    """Give the Bessel function of the first kind of a whole order.

    Bessel's integral by the trapezoidal rule, which for a periodic integrand errs by J(points - order) only: nothing,
    from some points more than the number and the order on.
    """
    if order != math.floor(order) or abs(order) > _FARTHEST or not abs(x) <= _FARTHEST:
        return 0.0, BESSEL_DOMAIN
    points = int(abs(order) + abs(x) + 8.0 * (abs(order) + abs(x)) ** (1.0 / 3.0)) + 40
    total = 0.0
    for k in range(points):
        angle = 2.0 * math.pi * k / points
        total += math.cos(order * angle - x * math.sin(angle))
    return total / points, 0


@njit(cache=True)
def power(x: float, y: float) -> tuple[float, int]:
    """Give a power."""
    if x == 0.0 and y < 0.0:
        return 0.0, DIVISION
    if x < 0.0 and y != math.floor(y):
        return 0.0, POWER_DOMAIN
    return x**y, 0


@njit(cache=True)
def root(n: float, x: float) -> tuple[float, int]:
    """Give the n-th root; odd ones of negative numbers are negative."""
    if n == 0.0 or (x == 0.0 and n < 0.0):
        return 0.0, DIVISION
    if x >= 0.0:
        return x ** (1.0 / n), 0
    if n == math.floor(n) and np.fmod(n, 2.0) != 0.0:
        return -((-x) ** (1.0 / n)), 0
    return 0.0, ROOT_DOMAIN


@njit(cache=True)
def angular(op: int, x: float) -> tuple[float, int]:
    """Carry out an instruction from SIN to ATAN."""
    if op == SIN:
        return math.sin(x), 0
    if op == COS:
        return math.cos(x), 0
    if op == TAN:
        return math.tan(x), 0
    if op == ATAN:
        return math.atan(x), 0
    if not -1.0 <= x <= 1.0:
        return 0.0, ARC_DOMAIN
    return math.asin(x) if op == ASIN else math.acos(x), 0


@njit(cache=True)
def unary(op: int, x: float) -> tuple[float, int]:
    """Carry out an instruction that takes one value."""
    if op == NEG:
        return -x, 0
    if op == NOT:
        return 1.0 if x == 0.0 else 0.0, 0
    if op == TRUTH:
        return 0.0 if x == 0.0 else 1.0, 0
    if op <= ATAN:
        return angular(op, x)
    if op == SQRT:
        return (math.sqrt(x), 0) if x >= 0.0 else (0.0, ROOT_DOMAIN)
    if op == EXP:
        return math.exp(x), 0
    if op == LOG:
        return (math.log(x), 0) if x > 0.0 else (0.0, LOG_DOMAIN)
    if op == ABS:
        return abs(x), 0
    if op == SIGN:
        return 1.0 if x > 0.0 else (-1.0 if x < 0.0 else 0.0), 0
    if not abs(x) < 2.0**52:  # whole already, or infinite
        return x, 0
    return np.float64(math.floor(x)) if op == FLOOR else np.float64(math.ceil(x)), 0


@njit(cache=True)
def compared(op: int, x: float, y: float) -> bool:
    """Compare two values."""
    if op == EQ:
        return x == y
    if op == NE:
        return x != y
    if op == LT:
        return x < y
    if op == GT:
        return x > y
    return x <= y if op == LE else x >= y


@njit(cache=True)
def binary(op: int, x: float, y: float) -> tuple[float, int]:
    """Carry out an instruction that takes two values."""
    if op == ADD:
        return x + y, 0
    if op == SUB:
        return x - y, 0
    if op == MUL:
        return x * y, 0
    if op == DIV:
        return (x / y, 0) if y != 0.0 else (0.0, DIVISION)
    if op == MOD:
        return (np.fmod(x, y), 0) if y != 0.0 else (0.0, DIVISION)
    if op == POW:
        return power(x, y)
    if EQ <= op <= GE:
        return 1.0 if compared(op, x, y) else 0.0, 0
    if op == MIN:
        return min(x, y), 0
    if op == MAX:
        return max(x, y), 0
    return root(x, y) if op == ROOT else bessel(x, y)


@njit(cache=True)
def drawn(op: int, x: float, y: float, key: np.uint64, site: int) -> tuple[float, int]:
    """Draw evenly from x to y, or from the normal distribution of mean x and spread y (Box and Muller 1958)."""
    if op == RANDOM:
        return x + (y - x) * uniform(key, 2 * site), 0
    if y < 0.0:
        return 0.0, SPREAD
    radius = math.sqrt(-2.0 * math.log(1.0 - uniform(key, 2 * site)))
    return x + y * radius * math.cos(2.0 * math.pi * uniform(key, 2 * site + 1)), 0


@_lent
def evaluated(ops: Ints, args: Floats, spans: Ints, expression: int, slots: Floats, key: np.uint64,
              stack: Floats) -> tuple[float, int]:  # fmt: skip
    """Evaluate an expression.

    Parameters
    ----------
    ops, args, spans
        As of :class:`~growth.timed.tables.Tables`.
    expression
        Its number.
    slots
        (room,) the parameters; places behind them are written.
    key
        What is drawn at random is a function of it and of the place in the system.
    stack
        (room,) written.

    Returns
    -------
    value
        0 where something is wrong; it may be infinite.
    trouble
        0, or what is wrong.
    """
    top = -1
    at, stop = spans[expression, 0], spans[expression, 1]
    while at < stop:
        op, arg = ops[at], args[at]
        at += 1
        trouble = 0
        if op <= LOAD:
            top += 1
            stack[top] = arg if op == PUSH else slots[int(arg)]
        elif op <= JUMP_IF_NOT:
            if op == STORE:
                slots[int(arg)] = stack[top]
            elif op == JUMP or stack[top] == 0.0:
                at = int(arg)
            top -= op != JUMP
        elif op < ADD:
            stack[top], trouble = unary(op, stack[top])
        else:
            top -= 1
            if op < RANDOM:
                stack[top], trouble = binary(op, stack[top], stack[top + 1])
            else:
                stack[top], trouble = drawn(op, stack[top], stack[top + 1], key, int(arg))
        if trouble:
            return 0.0, trouble
        if top >= 0 and stack[top] != stack[top]:
            return 0.0, NOT_FINITE
    return stack[top], 0


@njit(cache=True)
def sampled(ops: Ints, args: Floats, spans: Ints, expression: int, given: Floats, room: int) -> tuple[Floats, int, int]:
    """Evaluate an expression that draws nothing for each of n rows of values of its slots, (n, k).

    Returns
    -------
    values
        (n,) float64.
    trouble, at
        0 and 0, or what is wrong and with which row; values behind it are not written.
    """
    values, slots, stack = np.zeros(given.shape[0]), np.empty(room), np.empty(room)
    for at in range(given.shape[0]):
        slots[: given.shape[1]] = given[at]
        value, trouble = evaluated(ops, args, spans, expression, slots, np.uint64(0), stack)
        if trouble or abs(value) == math.inf:
            return values, trouble or NOT_FINITE, at
        values[at] = value
    return values, 0, 0


@_lent
def lasted(ops: Ints, args: Floats, spans: Ints, known: Floats, end: int, given: Floats, key: np.uint64,
           slots: Floats, stack: Floats) -> tuple[float, int]:  # fmt: skip
    """Give the terminal age of a module, infinite where it never dies, and what is wrong with it.

    Parameters
    ----------
    ops, args, spans, known
        As of :class:`~growth.timed.tables.Tables`.
    end
        The expression, or NONE.
    given, key
        The module's parameters and key.
    slots, stack
        (room,) written.
    """
    if end == NONE:
        return math.inf, 0
    value = known[end]
    if value != value:
        for place in range(given.size):
            slots[place] = given[place]
        value, trouble = evaluated(ops, args, spans, end, slots, branched(key, _BIRTH), stack)
        if trouble:
            return 0.0, trouble
    return (value, 0) if value >= 0.0 else (0.0, NEGATIVE_AGE)
