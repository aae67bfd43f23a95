"""The kernels of timed growth: the stack machine of expressions, rewriting by events, and development functions.

Every module is computed by itself, by scalar code, and draws from its own lineage: neither the order of modules nor the
times asked for change a bit. `tests/support/reference_timed.py` is the same as plain Python, and must give equal results.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numba import njit

from growth.timed.tables import (
    ABS, ACOS, ADD, ARC_DOMAIN, ASIN, ATAN, BESSEL_DOMAIN, BESSELJ, CEIL, CLOSE_CODE, COS, DIV, DIVISION, EQ, EVENTS, EXP,
    FLOOR, GE, GT, IN_BIRTH_AGE, IN_CHANCE, IN_CONDITION, IN_DEVELOPMENT, IN_END, IN_PARAMETER, JUMP, JUMP_IF_NOT, LE,
    LOAD, LOG, LOG_DOMAIN, LT, MAX, MIN, MOD, MODULES, MUL, NE, NEG, NEGATIVE_AGE, NO_CHANCE, NONE, NORMAL, NOT, NOT_FINITE,
    OPEN_CODE, POW, POWER_DOMAIN, PUSH, RANDOM, ROOT, ROOT_DOMAIN, SIGN, SIN, SPREAD, SQRT, STORE, SUB, TAN, TRUTH, Flags,
    Floats, Ints, Modules, Tables,
)  # fmt: skip

_GOLDEN: Final = np.uint64(0x9E3779B97F4A7C15)
_FIRST: Final = np.uint64(0xBF58476D1CE4E5B9)
_SECOND: Final = np.uint64(0x94D049BB133111EB)

_CHOICE: Final = 1 << 40
_BIRTH: Final = 1 << 41
_LIFE: Final = 1 << 42
_GROWTH: Final = 1 << 43
"""Numbers of branches of a lineage: which production, the terminal age, those that are born, the development function."""

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
def unary(op: int, x: float) -> tuple[float, int]:
    """Carry out an instruction that takes one value."""
    if op == NEG:
        return -x, 0
    if op == NOT:
        return 1.0 if x == 0.0 else 0.0, 0
    if op == TRUTH:
        return 0.0 if x == 0.0 else 1.0, 0
    if op == SIN:
        return math.sin(x), 0
    if op == COS:
        return math.cos(x), 0
    if op == TAN:
        return math.tan(x), 0
    if op in (ASIN, ACOS):
        if not -1.0 <= x <= 1.0:
            return 0.0, ARC_DOMAIN
        return math.asin(x) if op == ASIN else math.acos(x), 0
    if op == ATAN:
        return math.atan(x), 0
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
    if op == EQ:
        return 1.0 if x == y else 0.0, 0
    if op == NE:
        return 1.0 if x != y else 0.0, 0
    if op == LT:
        return 1.0 if x < y else 0.0, 0
    if op == GT:
        return 1.0 if x > y else 0.0, 0
    if op == LE:
        return 1.0 if x <= y else 0.0, 0
    if op == GE:
        return 1.0 if x >= y else 0.0, 0
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


@njit(cache=True)
def evaluated(tables: Tables, expression: int, slots: Floats, key: np.uint64, stack: Floats) -> tuple[float, int]:
    """Evaluate an expression.

    Parameters
    ----------
    tables
        The system.
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
    at, stop = tables.spans[expression, 0], tables.spans[expression, 1]
    while at < stop:
        op, arg = tables.ops[at], tables.args[at]
        at += 1
        trouble = 0
        if op == PUSH:
            top += 1
            stack[top] = arg
        elif op == LOAD:
            top += 1
            stack[top] = slots[int(arg)]
        elif op == STORE:
            slots[int(arg)] = stack[top]
            top -= 1
        elif op == JUMP:
            at = int(arg)
        elif op == JUMP_IF_NOT:
            if stack[top] == 0.0:
                at = int(arg)
            top -= 1
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
def lasted(tables: Tables, code: int, values: Floats, start: int, count: int, key: np.uint64, slots: Floats,
           stack: Floats) -> tuple[float, int]:  # fmt: skip
    """Give the terminal age of a module, infinite where it never dies, and what is wrong with it."""
    expression = tables.ends[code]
    if expression == NONE:
        return math.inf, 0
    value = tables.known[expression]
    if value != value:
        for place in range(count):
            slots[place] = values[start + place]
        value, trouble = evaluated(tables, expression, slots, branched(key, _BIRTH), stack)
        if trouble:
            return 0.0, trouble
    return (value, 0) if value >= 0.0 else (0.0, NEGATIVE_AGE)


@njit(cache=True)
def chosen(tables: Tables, code: int, at: int, count: int, word: Modules, lefts: Ints, rights: Ints,
           moment: np.uint64, slots: Floats, stack: Floats) -> tuple[int, int, int]:  # fmt: skip
    """Choose a production of a module, whose parameters the slots hold; NONE where none matches.

    Productions are asked in their order. Of those that match, each with a chance takes its part of one random number;
    one without takes all that is left.

    Returns
    -------
    production
        Its number; the slots then hold the parameters of its contexts, too.
    trouble, role
        What is wrong, and with what.
    """
    passed, number = 0.0, -1.0
    for production in range(tables.productions[code], tables.productions[code + 1]):
        filled = count
        met = True
        for side in range(2):
            wanted = tables.lefts[production] if side == 0 else tables.rights[production]
            if wanted == NONE:
                continue
            other = lefts[at] if side == 0 else rights[at]
            if other == NONE or word.codes[other] != wanted:
                met = False
                break
            for value in range(word.starts[other], word.starts[other + 1]):
                slots[filled] = word.values[value]
                filled += 1
        if not met:
            continue
        condition = tables.conditions[production]
        if condition != NONE:
            truth, trouble = evaluated(tables, condition, slots, moment, stack)
            if trouble:
                return NONE, trouble, IN_CONDITION
            if truth == 0.0:
                continue
        chance = tables.chances[production]
        if chance == NONE:
            return production, 0, 0
        part, trouble = evaluated(tables, chance, slots, moment, stack)
        if trouble or not 0.0 <= part <= 1.0:
            return NONE, trouble or NO_CHANCE, IN_CHANCE
        if number < 0.0:
            number = uniform(moment, _CHOICE)
        passed += part
        if number < passed:
            return production, 0, 0
    return NONE, 0, 0


@njit(cache=True)
def roomy(modules: int, values: int) -> Modules:
    """Give room for so many modules and parameters."""
    starts = np.empty(modules + 1, dtype=np.int64)
    starts[0] = 0
    return Modules(
        np.empty(modules, dtype=np.int64), starts, np.empty(values, dtype=np.float64), np.empty(modules, dtype=np.float64),
        np.empty(modules, dtype=np.float64), np.empty(modules, dtype=np.uint64), np.empty(modules, dtype=np.int64),
    )  # fmt: skip


@njit(cache=True)
def with_room(modules: Modules, count: int, more: int, values: int) -> Modules:
    """Give the same modules with room for so many more, and so many parameters more."""
    held = modules.starts[count]
    if count + more <= modules.codes.size and held + values <= modules.values.size:
        return modules
    larger = roomy(max(modules.codes.size, 2 * count + more), max(modules.values.size, 2 * held + values))
    larger.codes[:count] = modules.codes[:count]
    larger.starts[: count + 1] = modules.starts[: count + 1]
    larger.values[:held] = modules.values[:held]
    larger.origins[:count] = modules.origins[:count]
    larger.dies[:count] = modules.dies[:count]
    larger.keys[:count] = modules.keys[:count]
    larger.asks[:count] = modules.asks[:count]
    return larger


@njit(cache=True)
def copied(source: Modules, at: int, target: Modules, count: int) -> None:
    """Put one module behind the others of a target that has room for it."""
    start, held = source.starts[at], target.starts[count]
    length = source.starts[at + 1] - start
    for place in range(length):
        target.values[held + place] = source.values[start + place]
    target.codes[count] = source.codes[at]
    target.starts[count + 1] = held + length
    target.origins[count] = source.origins[at]
    target.dies[count] = source.dies[at]
    target.keys[count] = source.keys[at]
    target.asks[count] = source.asks[at]


@njit(cache=True)
def trimmed(modules: Modules, count: int) -> Modules:
    """Give the first modules without the room behind them."""
    return Modules(
        modules.codes[:count].copy(), modules.starts[: count + 1].copy(), modules.values[: modules.starts[count]].copy(),
        modules.origins[:count].copy(), modules.dies[:count].copy(), modules.keys[:count].copy(), modules.asks[:count].copy(),
    )  # fmt: skip


@njit(cache=True)
def born(tables: Tables, birth: int, place: int, instant: float, moment: np.uint64, slots: Floats, target: Modules,
         count: int, own: Floats, stack: Floats) -> tuple[int, int]:  # fmt: skip
    """Put a module that is born behind the others of a target that has room for it.

    Parameters
    ----------
    tables, birth
        The system, and which birth of it.
    place
        The birth's place in its successor, which with the parent's key gives its own.
    instant
        When.
    moment, slots
        The parent's key at its death, and its parameters.
    target, count
        The modules, and how many there are.
    own, stack
        (room,) written.

    Returns
    -------
    trouble, role
        0 and 0, or what is wrong and with what; the module then stands there without age and terminal age.
    """
    code = tables.codes[birth]
    held = target.starts[count]
    target.codes[count], target.asks[count] = code, 0
    target.origins[count] = target.dies[count] = instant
    first, last = tables.arguments[birth, 0], tables.arguments[birth, 1]
    target.starts[count + 1] = held
    for expression in range(first, last):
        value = tables.known[expression]
        if value != value:
            value, trouble = evaluated(tables, expression, slots, moment, stack)
            if trouble:
                return trouble, IN_PARAMETER
        if abs(value) == math.inf:
            return NOT_FINITE, IN_PARAMETER
        target.values[held + expression - first] = value
    target.starts[count + 1] = held + last - first
    age = tables.known[tables.ages[birth]]
    if age != age:
        age, trouble = evaluated(tables, tables.ages[birth], slots, moment, stack)
        if trouble:
            return trouble, IN_BIRTH_AGE
    if not 0.0 <= age < math.inf:
        return NEGATIVE_AGE if age < 0.0 else NOT_FINITE, IN_BIRTH_AGE
    key = branched(moment, _LIFE + place)
    target.keys[count] = key
    target.origins[count] = instant - age
    if tables.calls[code]:
        target.dies[count] = instant - age
        return 0, 0
    end, trouble = lasted(tables, code, target.values, held, last - first, key, own, stack)
    if trouble:
        return trouble, IN_END
    target.dies[count] = max(instant, instant - age + end)
    return 0, 0


@njit(cache=True)
def alone(source: Modules, at: int) -> Modules:
    """Give one module by itself."""
    one = roomy(1, source.starts[at + 1] - source.starts[at])
    copied(source, at, one, 0)
    return one


@njit(cache=True)
def advanced(tables: Tables, word: Modules, limit: float, deep: bool, lefts: Ints, rights: Ints, events: int,
             most_events: int, most_modules: int) -> tuple[Modules, int, int, int]:  # fmt: skip
    """Rewrite the modules that die up to an instant, each by itself, from left to right.

    Parameters
    ----------
    tables
        The system.
    word
        What there is.
    limit
        The instant.
    deep
        Whether those born go on dying up to then; without, each module is asked once.
    lefts, rights
        (m,) int64, the contexts of each module, or NONE; empty where the system asks for none.
    events
        How many births and askings there have been.
    most_events, most_modules
        The budget; that of modules holds with ``deep`` alone.

    Returns
    -------
    word
        What there is then; where something is wrong the module with which it is.
    events
        As given, and what is new.
    trouble, role
        0 and 0, or what is wrong and with what.
    """
    slots, own, stack = np.empty(tables.room), np.empty(tables.room), np.empty(tables.room)
    out, pile = roomy(word.codes.size + 16, word.values.size + 16), roomy(64, 64)
    count = 0
    for at in range(word.codes.size):
        pile = with_room(pile, 0, 1, word.starts[at + 1] - word.starts[at])
        copied(word, at, pile, 0)
        height, fresh = 1, True
        while height > 0:
            height -= 1
            if pile.dies[height] > limit or not (deep or fresh):
                if deep and count >= most_modules:
                    return roomy(0, 0), events, MODULES, 0
                out = with_room(out, count, 1, pile.starts[height + 1] - pile.starts[height])
                copied(pile, height, out, count)
                count += 1
                continue
            fresh = False
            code, instant, start = pile.codes[height], pile.dies[height], pile.starts[height]
            given = pile.starts[height + 1] - start
            for place in range(given):
                slots[place] = pile.values[start + place]
            moment = branched(pile.keys[height], pile.asks[height])
            events += 1
            production, trouble, role = chosen(
                tables, code, at, given, word, lefts, rights, moment, slots, stack
            )
            if trouble:
                return alone(pile, height), events, trouble, role
            if production == NONE:
                pile.asks[height] += 1
                span = math.inf
                if tables.again[code]:
                    span, _ = lasted(tables, code, pile.values, start, given, pile.keys[height], own, stack)
                pile.dies[height] = instant + span if span > 0.0 else math.inf
                height += 1
                continue
            first, last = tables.births[production, 0], tables.births[production, 1]
            events += last - first
            if events > most_events:
                return roomy(0, 0), events, EVENTS, 0
            for birth in range(last - 1, first - 1, -1):
                pile = with_room(pile, height, 1, tables.arguments[birth, 1] - tables.arguments[birth, 0])
                trouble, role = born(
                    tables, birth, birth - first, instant, moment, slots, pile, height, own, stack
                )
                if trouble:
                    return alone(pile, height), events, trouble, role
                height += 1
    return trimmed(out, count), events, 0, 0


@njit(cache=True)
def neighbours(codes: Ints, ignored: Flags) -> tuple[Ints, Ints]:
    """Give the contexts of every module, or NONE.

    Returns
    -------
    lefts
        (m,) int64, the nearest module before it on the way to the root.
    rights
        (m,) int64, the next module on its own branch.
    """
    lefts, rights = np.full(codes.size, NONE, dtype=np.int64), np.full(codes.size, NONE, dtype=np.int64)
    waiting = np.empty(codes.size + 1, dtype=np.int64)
    height, near = 0, np.int64(NONE)
    for at in range(codes.size):
        lefts[at] = near
        if codes[at] == OPEN_CODE:
            waiting[height] = near
            height += 1
        elif codes[at] == CLOSE_CODE:
            height -= 1
            near = waiting[height]
        elif not ignored[codes[at]]:
            near = np.int64(at)
    height, near = 0, np.int64(NONE)
    for at in range(codes.size - 1, -1, -1):
        rights[at] = near
        if codes[at] == CLOSE_CODE:
            waiting[height] = near
            height += 1
            near = np.int64(NONE)
        elif codes[at] == OPEN_CODE:
            height -= 1
            near = waiting[height]
        elif not ignored[codes[at]]:
            near = np.int64(at)
    return lefts, rights


@njit(cache=True)
def developed(tables: Tables, word: Modules, time: float) -> tuple[Floats, Floats, Floats, int, int]:
    """Give ages, what the development functions scale by, and the scaled parameters.

    Returns
    -------
    ages, factors
        (m,) float64; 1 where a symbol has no development function.
    values
        (v,) float64.
    trouble, at
        0 and 0, or what is wrong and with which module.
    """
    ages, factors = np.empty(word.codes.size), np.ones(word.codes.size)
    values = word.values.copy()
    slots, own, stack = np.empty(tables.room), np.empty(tables.room), np.empty(tables.room)
    for at in range(word.codes.size):
        # An event a rounding after the time has happened all the same: ages are not negative.
        ages[at] = max(0.0, time - word.origins[at])
        growth = tables.growths[word.codes[at]]
        if growth == NONE:
            continue
        start, stop = word.starts[at], word.starts[at + 1]
        slots[0] = ages[at]
        slots[1], _ = lasted(tables, word.codes[at], word.values, start, stop - start, word.keys[at], own, stack)
        for place in range(start, stop):
            slots[2 + place - start] = word.values[place]
        factor, trouble = evaluated(tables, growth, slots, branched(word.keys[at], _GROWTH), stack)
        if trouble or abs(factor) == math.inf:
            return ages, factors, values, trouble or NOT_FINITE, at
        factors[at] = factor
        for place in range(start, stop):
            values[place] *= factor
            if not abs(values[place]) < math.inf:
                return ages, factors, values, NOT_FINITE, at
    return ages, factors, values, 0, 0
