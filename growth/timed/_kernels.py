"""The kernels of timed growth: the stack machine of expressions, rewriting by events, and development functions.

Every module is computed by itself, by scalar code, and draws from its own lineage: neither the order of modules nor
the times asked for change a bit. `tests/support/reference_timed.py` is the same as plain Python, and must give equal
results.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

# isort: off
from growth.timed.tables import (
    ABS, ADD, AGAIN, ARC_DOMAIN, ASIN, ASKS, AT, ATAN, BESSEL_DOMAIN, BIRTH_AGE, BORN, CALLS, CHANCE, CHILD,
    CLOSE_CODE, CODE, COLUMNS, CONDITION, COS, COUNT, DIES, DIV, DIVISION, END, EQ, EVENTS, EXP, FIRST_ARGUMENT,
    FIRST_BIRTH, FIRST_CHILD, FIRST_RULE, FLOOR, FULL, Floats, GE, GROWTH, GT, HEIGHT, HELD, IGNORED, IN_BIRTH_AGE,
    IN_CHANCE, IN_CONDITION, IN_END, IN_PARAMETER, Ints, JUMP, JUMP_IF_NOT, KEY, LAST_ARGUMENT, LAST_BIRTH,
    LAST_CHILD, LAST_RULE, LE, LEFT, LOAD, LOG, LOG_DOMAIN, LT, MARKS, MAX, MIN, MOD, MODULES, MUL, Modules, NE, NEG,
    NEGATIVE_AGE, NEXT_CHILD, NONE, NOT, NOT_FINITE, NO_CHANCE, OPEN_CODE, ORIGIN, PILE_COLUMNS, PLAIN, POW,
    POWER_DOMAIN, PUSH, RANDOM, RIGHT, ROLE, ROOT, ROOT_DOMAIN, SETTLED, SIGN, SIN, SPREAD, SQRT, START, STOP, STORE,
    SUB, TALLY, TAN, TRUTH, Tables,
)  # fmt: skip
# isort: on

_OPTIONS: Final[Any] = {"cache": True, "error_model": "numpy", "_nrt": False}
_lent: Final = njit(**_OPTIONS)
"""For what makes no arrays: to count references to those that it is given takes longer than all else it does."""

_GOLDEN: Final = np.uint64(0x9E3779B97F4A7C15)
_FIRST: Final = np.uint64(0xBF58476D1CE4E5B9)
_SECOND: Final = np.uint64(0x94D049BB133111EB)

_CHOICE: Final = 1 << 40
_BIRTH: Final = 1 << 41
_LIFE: Final = 1 << 42
_GROWTH: Final = 1 << 43
"""Numbers of branches of a lineage: choice of production, terminal age, those that are born, development function."""

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


@_lent
def joined(wanted: int, other: int, whole: Ints, values: Floats, slots: Floats, filled: int) -> int:
    """Put the parameters of a context behind those before it; give how many there are, NONE where it does not fit."""
    if wanted == NONE:
        return filled
    if other == NONE or whole[other, CODE] != wanted:
        return NONE
    for value in range(whole[other, START], whole[other, STOP]):
        slots[filled] = values[value]
        filled += 1
    return filled


@_lent
def chosen(ops: Ints, args: Floats, spans: Ints, rules: Ints, first: int, last: int, left: int, right: int, count: int,
           whole: Ints, values: Floats, moment: np.uint64, slots: Floats,
           stack: Floats) -> tuple[int, int, int]:  # fmt: skip
    """Choose a production of a module, whose parameters the slots hold; NONE where none matches.

    Productions are asked in their order. Of those that match, each with a chance takes its part of one random number;
    one without takes all that is left.

    Parameters
    ----------
    ops, args, spans, rules
        As of :class:`~growth.timed.tables.Tables`.
    first, last
        The productions of its symbol.
    left, right
        Its contexts in the word, or NONE.
    count
        How many parameters it has.
    whole, values
        The word.
    moment
        Its key at this instant.
    slots, stack
        (room,) of slots and stack.

    Returns
    -------
    production
        Its number; the slots then hold the parameters of its contexts, too.
    trouble, role
        What is wrong, and with what.
    """
    passed, number = 0.0, -1.0
    for production in range(first, last):
        filled = joined(rules[production, LEFT], left, whole, values, slots, count)
        if filled != NONE:
            filled = joined(rules[production, RIGHT], right, whole, values, slots, filled)
        if filled == NONE:
            continue
        if rules[production, CONDITION] != NONE:
            truth, trouble = evaluated(ops, args, spans, rules[production, CONDITION], slots, moment, stack)
            if trouble:
                return NONE, trouble, IN_CONDITION
            if truth == 0.0:
                continue
        if rules[production, CHANCE] == NONE:
            return production, 0, 0
        part, trouble = evaluated(ops, args, spans, rules[production, CHANCE], slots, moment, stack)
        if trouble or not 0.0 <= part <= 1.0:
            return NONE, trouble or NO_CHANCE, IN_CHANCE
        if number < 0.0:
            number = uniform(moment, _CHOICE)
        passed += part
        if number < passed:
            return production, 0, 0
    return NONE, 0, 0


@njit(cache=True)
def longer(rows: NDArray[Any]) -> NDArray[Any]:
    """Give the same rows with room for four times as many."""
    more = np.empty((4 * rows.shape[0], rows.shape[1]), dtype=rows.dtype)
    more[: rows.shape[0]] = rows
    return more


@njit(cache=True)
def extended(values: Floats) -> Floats:
    """Give the same values with room for four times as many."""
    more = np.empty(4 * values.size, dtype=np.float64)
    more[: values.size] = values
    return more


@_lent
def settled(known: Floats, loads: Ints, symbols: Ints, births: Ints, first: int, birth: int, last: int, instant: float,
            moment: np.uint64, limit: float, slots: Floats, whole: Ints, reals: Floats, values: Floats, marks: Ints,
            room: int) -> int:  # fmt: skip
    """Put children behind the others as long as nothing has to be computed for them; give the first that is left.

    That is a child with an expression that is neither constant nor a parameter, one that dies up to the limit, or one
    for which there is no room. Parameters as of :func:`put`.
    """
    count, held = marks[COUNT], marks[HELD]
    while birth < last and births[birth, SETTLED] and count < whole.shape[0] and held + room <= values.size:
        code, age = births[birth, BORN], known[births[birth, BIRTH_AGE]]
        end = symbols[code, END]
        origin = instant - age
        dies = math.inf if end == NONE else max(instant, origin + known[end])
        if dies <= limit:
            break
        whole[count, CODE], whole[count, ASKS], whole[count, START] = code, 0, held
        whole[count, KEY] = np.int64(branched(moment, _LIFE + birth - first))
        reals[count, ORIGIN], reals[count, DIES] = origin, dies
        for expression in range(births[birth, FIRST_ARGUMENT], births[birth, LAST_ARGUMENT]):
            load = loads[expression]
            values[held] = known[expression] if load == NONE else slots[load]
            held += 1
        whole[count, STOP] = held
        count, birth = count + 1, birth + 1
    marks[COUNT], marks[HELD] = count, held
    return birth


@_lent
def born(ops: Ints, args: Floats, spans: Ints, known: Floats, symbols: Ints, births: Ints, birth: int, key: np.uint64,
         instant: float, moment: np.uint64, whole: Ints, reals: Floats, values: Floats, marks: Ints, slots: Floats,
         own: Floats, stack: Floats) -> int:  # fmt: skip
    """Put a child behind the others without counting it.

    Parameters
    ----------
    ops, args, spans, known, symbols, births, birth
        As of :class:`~growth.timed.tables.Tables`, and which birth.
    key
        The child's.
    instant, moment
        When it is born, and its parent's key then.
    whole, reals, values, marks
        As of :func:`put`.
    slots
        (room,) the parameters of the parent, and of its contexts.
    own, stack
        (room,) written.

    Returns
    -------
    trouble
        0, or what is wrong, and the marks with what.
    """
    code, count, held = births[birth, BORN], marks[COUNT], marks[HELD]
    whole[count, CODE], whole[count, ASKS], whole[count, KEY] = code, 0, np.int64(key)
    whole[count, START] = whole[count, STOP] = held
    reals[count, ORIGIN] = reals[count, DIES] = instant
    stop = held
    marks[ROLE] = IN_PARAMETER
    for expression in range(births[birth, FIRST_ARGUMENT], births[birth, LAST_ARGUMENT]):
        value, trouble = evaluated(ops, args, spans, expression, slots, moment, stack)
        if trouble or abs(value) == math.inf:
            return trouble or NOT_FINITE
        values[stop] = value
        stop += 1
    whole[count, STOP] = stop
    marks[ROLE] = IN_BIRTH_AGE
    age, trouble = evaluated(ops, args, spans, births[birth, BIRTH_AGE], slots, moment, stack)
    if trouble or not 0.0 <= age < math.inf:
        return trouble or (NEGATIVE_AGE if age < 0.0 else NOT_FINITE)
    marks[ROLE] = IN_END
    reals[count, ORIGIN] = reals[count, DIES] = instant - age
    if not symbols[code, CALLS]:
        lifetime, trouble = lasted(ops, args, spans, known, symbols[code, END], values[held:stop], key, own, stack)
        if trouble:
            return trouble
        reals[count, DIES] = max(instant, instant - age + lifetime)
    return 0


@_lent
def put(ops: Ints, args: Floats, spans: Ints, known: Floats, loads: Ints, symbols: Ints, births: Ints, top: int,
        pile: Ints, times: Floats, whole: Ints, reals: Floats, values: Floats, marks: Ints, limit: float, room: int,
        slots: Floats, own: Floats, stack: Floats) -> int:  # fmt: skip
    """Put the children of the module on top of a pile behind the others, from left to right.

    Parameters
    ----------
    ops, args, spans, known, loads, symbols, births
        As of :class:`~growth.timed.tables.Tables`.
    top, pile, times
        The pile; its top has decided what becomes of it, and how far that is done.
    whole, reals, values
        The modules that stay.
    marks
        How many of these there are, and parameters.
    limit
        Children who die up to this instant do not stay: the first of them goes on the pile.
    room
        The most parameters of a module.
    slots
        (room,) the parameters of the module on top, and of its contexts.
    own, stack
        (room,) written.

    Returns
    -------
    trouble
        0 when all children stand there, CHILD when one is to go on the pile, FULL when there is no room. Else what is
        wrong with a child, and the marks with what of it. Such a child stands behind the others, not counted.
    """
    instant, first, last = times[top, DIES], pile[top, FIRST_CHILD], pile[top, LAST_CHILD]
    moment = branched(np.uint64(pile[top, KEY]), pile[top, ASKS])
    birth = pile[top, NEXT_CHILD]
    while True:
        birth = settled(known, loads, symbols, births, first, birth, last, instant, moment, limit, slots, whole, reals,
                        values, marks, room)  # fmt: skip
        pile[top, NEXT_CHILD] = birth
        if birth == last:
            return 0
        if marks[COUNT] == whole.shape[0] or marks[HELD] + room > values.size:
            return FULL
        key = branched(moment, _LIFE + birth - first)
        trouble = born(ops, args, spans, known, symbols, births, birth, key, instant, moment, whole, reals, values,
                       marks, slots, own, stack)  # fmt: skip
        if trouble:
            return trouble
        birth += 1
        pile[top, NEXT_CHILD] = birth
        if reals[marks[COUNT], DIES] <= limit:
            return CHILD
        marks[HELD] = whole[marks[COUNT], STOP]
        marks[COUNT] += 1


@_lent
def decided(ops: Ints, args: Floats, spans: Ints, known: Floats, symbols: Ints, rules: Ints, sides: Ints, at: int,
            given: Ints, numbers: Floats, top: int, pile: Ints, times: Floats, marks: Ints, slots: Floats, own: Floats,
            stack: Floats) -> int:  # fmt: skip
    """Decide what becomes of the module on top of a pile, which dies now, and whose parameters the slots hold.

    Parameters
    ----------
    ops, args, spans, known, symbols, rules
        As of :class:`~growth.timed.tables.Tables`.
    sides, at, given, numbers
        The contexts of the word's modules, which of them this is or comes from, and the word.
    top, pile, times
        The pile.
    marks
        Events are counted here.
    slots, own, stack
        (room,) slots, and two that are written.

    Returns
    -------
    trouble
        0; the pile says which children are to come, or, with none of them, when the module is asked again. Else what
        is wrong with the module, and the marks with what of it.
    """
    code, start, stop = pile[top, CODE], pile[top, START], pile[top, STOP]
    key = np.uint64(pile[top, KEY])
    production = symbols[code, FIRST_RULE]
    marks[TALLY] += 1
    if not symbols[code, PLAIN]:
        left, right = (sides[at, 0], sides[at, 1]) if sides.shape[0] else (NONE, NONE)
        production, trouble, role = chosen(
            ops, args, spans, rules, symbols[code, FIRST_RULE], symbols[code, LAST_RULE], left, right, stop - start,
            given, numbers, branched(key, pile[top, ASKS]), slots, stack,
        )  # fmt: skip
        if trouble:
            marks[ROLE] = role
            return trouble
    if production != NONE:
        first, last = rules[production, FIRST_BIRTH], rules[production, LAST_BIRTH]
        pile[top, FIRST_CHILD], pile[top, NEXT_CHILD], pile[top, LAST_CHILD] = first, first, last
        marks[TALLY] += last - first
        return 0
    span = math.inf
    if symbols[code, AGAIN]:
        span, _ = lasted(ops, args, spans, known, symbols[code, END], slots[: stop - start], key, own, stack)
    # Without time passing nothing would ever be otherwise.
    times[top, DIES] = times[top, DIES] + span if span > 0.0 else math.inf
    pile[top, ASKS] += 1
    return 0


@_lent
def moved(source: Ints, lives: Floats, numbers: Floats, at: int, target: Ints, times: Floats, values: Floats, row: int,
          held: int) -> int:  # fmt: skip
    """Write a module into a row of others, its parameters from a place on; give the place behind them."""
    stop = held
    for place in range(source[at, START], source[at, STOP]):
        values[stop] = numbers[place]
        stop += 1
    target[row, CODE], target[row, ASKS], target[row, KEY] = source[at, CODE], source[at, ASKS], source[at, KEY]
    target[row, START], target[row, STOP] = held, stop
    times[row, ORIGIN], times[row, DIES] = lives[at, ORIGIN], lives[at, DIES]
    return stop


@_lent
def kept(given: Ints, lives: Floats, numbers: Floats, whole: Ints, reals: Floats, values: Floats, marks: Ints,
         limit: float, room: int) -> int:  # fmt: skip
    """Copy modules of a word behind the others, up to the next that dies; tell whether there was no room for all."""
    at, count, held = marks[AT], marks[COUNT], marks[HELD]
    full = False
    while at < given.shape[0] and lives[at, DIES] > limit:
        full = count == whole.shape[0] or held + room > values.size
        if full:
            break
        begin, end = given[at, START], given[at, STOP]
        whole[count, CODE], whole[count, ASKS], whole[count, KEY] = given[at, CODE], given[at, ASKS], given[at, KEY]
        whole[count, START] = held
        reals[count, ORIGIN], reals[count, DIES] = lives[at, ORIGIN], lives[at, DIES]
        for place in range(begin, end):
            values[held] = numbers[place]
            held += 1
        whole[count, STOP] = held
        count, at = count + 1, at + 1
    marks[AT], marks[COUNT], marks[HELD] = at, count, held
    return FULL if full else 0


@_lent
def run(ops: Ints, args: Floats, spans: Ints, known: Floats, loads: Ints, symbols: Ints, rules: Ints, births: Ints,
        given: Ints, lives: Floats, numbers: Floats, sides: Ints, whole: Ints, reals: Floats, values: Floats,
        pile: Ints, times: Floats, pairs: Floats, marks: Ints, limit: float, deep: bool, most: int, room: int,
        slots: Floats, own: Floats, stack: Floats) -> int:  # fmt: skip
    """Rewrite as far as there is room; parameters as of :func:`put`, :func:`decided` and :func:`advanced`.

    The pile holds a module that dies, above it the child that dies with which its successor has been left, and so on.

    Returns
    -------
    trouble
        0 when all is done, FULL when there is no room; what is wrong, with what the marks say of what; or EVENTS.
    """
    while True:
        if not marks[HEIGHT]:
            if kept(given, lives, numbers, whole, reals, values, marks, limit, room) == FULL:
                return FULL
            if marks[AT] == given.shape[0]:
                return 0
            moved(given, lives, numbers, marks[AT], pile, times, pairs, 0, 0)
            pile[0, NEXT_CHILD] = NONE
            marks[HEIGHT] = 1
            marks[AT] += 1
        top = marks[HEIGHT] - 1
        for place in range(pile[top, START], pile[top, STOP]):
            slots[place - pile[top, START]] = pairs[place]
        if pile[top, NEXT_CHILD] == NONE:
            if marks[COUNT] == whole.shape[0] or marks[HELD] + room > values.size:
                return FULL
            trouble = decided(ops, args, spans, known, symbols, rules, sides, marks[AT] - 1, given, numbers, top, pile,
                              times, marks, slots, own, stack)  # fmt: skip
            if trouble or marks[TALLY] > most:
                return trouble or EVENTS
            if pile[top, NEXT_CHILD] == NONE:
                if times[top, DIES] > limit or not deep:
                    held = moved(pile, times, pairs, top, whole, reals, values, marks[COUNT], marks[HELD])
                    marks[COUNT], marks[HELD], marks[HEIGHT] = marks[COUNT] + 1, held, top
                continue
        if top + 2 > pile.shape[0] or pile[top, STOP] + room > pairs.size:
            return FULL
        trouble = put(ops, args, spans, known, loads, symbols, births, top, pile, times, whole, reals, values, marks,
                      limit if deep else -math.inf, room, slots, own, stack)  # fmt: skip
        if trouble == CHILD:
            # The last child takes its parent's place, so that what goes round for long does not pile up.
            ended = pile[top, NEXT_CHILD] == pile[top, LAST_CHILD]
            row, start = (top, pile[top, START]) if ended else (top + 1, pile[top, STOP])
            moved(whole, reals, values, marks[COUNT], pile, times, pairs, row, start)
            pile[row, NEXT_CHILD] = NONE
            marks[HEIGHT] = row + 1
        elif trouble:
            return trouble
        else:
            marks[HEIGHT] = top


@njit(cache=True)
def alone(whole: Ints, reals: Floats, values: Floats, at: int) -> Modules:
    """Give one module by itself; none where there is none."""
    one, own = np.zeros((min(at + 1, 1), COLUMNS), np.int64), np.empty(0)
    if at >= 0:
        own = values[whole[at, START] : whole[at, STOP]].copy()
        one[0] = whole[at, :COLUMNS]
        one[0, START], one[0, STOP] = 0, own.size
    return Modules(one, reals[at : at + one.shape[0]].copy(), own)


@njit(cache=True)
def advanced(tables: Tables, word: Modules, limit: float, deep: bool, sides: Ints, events: int, most_events: int,
             most_modules: int) -> tuple[Modules, int, int, int]:  # fmt: skip
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
    sides
        (m, 2) int64, the contexts of each module, or NONE; (0, 2) where the system asks for none.
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
    count, room = word.whole.shape[0], max(tables.most_values, 1)
    slots, own, stack = np.empty(tables.room), np.empty(tables.room), np.empty(tables.room)
    whole, reals = np.empty((count + 64, COLUMNS), np.int64), np.empty((count + 64, 2))
    values, pairs = np.empty(word.values.size + 64 * room), np.empty(64 * room)
    pile, times = np.empty((64, PILE_COLUMNS), np.int64), np.empty((64, 2))
    marks = np.zeros(MARKS, np.int64)
    marks[TALLY] = events
    while True:
        trouble = run(
            tables.ops, tables.args, tables.spans, tables.known, tables.loads, tables.symbols, tables.rules,
            tables.births, word.whole, word.reals, word.values, sides, whole, reals, values, pile, times, pairs, marks,
            limit, deep, most_events, room, slots, own, stack,
        )  # fmt: skip
        count = marks[COUNT]
        if trouble != FULL or (deep and count > most_modules):
            break
        if count == whole.shape[0]:
            whole, reals = longer(whole), longer(reals)
        if marks[HELD] + room > values.size:
            values = extended(values)
        if marks[HEIGHT] + 1 > pile.shape[0]:
            pile, times = longer(pile), longer(times)
        if marks[HEIGHT] and pile[marks[HEIGHT] - 1, STOP] + room > pairs.size:
            pairs = extended(pairs)
    if deep and count > most_modules and trouble in (0, FULL):
        trouble = MODULES
    if trouble == 0:
        return Modules(whole[:count], reals[:count], values[: marks[HELD]]), marks[TALLY], 0, 0
    of_child = marks[ROLE] in (IN_PARAMETER, IN_BIRTH_AGE, IN_END)
    failed = alone(whole, reals, values, count) if of_child else alone(pile, times, pairs, marks[HEIGHT] - 1)
    return failed, marks[TALLY], trouble, marks[ROLE]


@njit(cache=True)
def neighbours(whole: Ints, symbols: Ints) -> Ints:
    """Give the contexts of every module, or NONE.

    Returns
    -------
    sides
        (m, 2) int64: the nearest module before it on the way to the root, and the next on its own branch.
    """
    count = whole.shape[0]
    sides = np.full((count, 2), NONE, dtype=np.int64)
    waiting = np.empty(count + 1, dtype=np.int64)
    for side in range(2):
        height, near = 0, NONE
        opens, closes = (OPEN_CODE, CLOSE_CODE) if side == 0 else (CLOSE_CODE, OPEN_CODE)
        for step in range(count):
            at = step if side == 0 else count - 1 - step
            code = whole[at, CODE]
            sides[at, side] = near
            if code == opens:
                waiting[height] = near
                height += 1
                near = near if side == 0 else NONE
            elif code == closes:
                height -= 1
                near = waiting[height]
            elif not symbols[code, IGNORED]:
                near = at
    return sides


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
    ops, args, spans, known, symbols = tables.ops, tables.args, tables.spans, tables.known, tables.symbols
    whole, reals, numbers = word.whole, word.reals, word.values
    ages, factors, values = np.empty(whole.shape[0]), np.ones(whole.shape[0]), numbers.copy()
    slots, own, stack = np.empty(tables.room), np.empty(tables.room), np.empty(tables.room)
    for at in range(whole.shape[0]):
        # An event a rounding after the time has happened all the same: ages are not negative.
        ages[at] = max(0.0, time - reals[at, ORIGIN])
        code, start, stop, key = whole[at, CODE], whole[at, START], whole[at, STOP], np.uint64(whole[at, KEY])
        if symbols[code, GROWTH] == NONE:
            continue
        slots[0] = ages[at]
        slots[1], _ = lasted(ops, args, spans, known, symbols[code, END], numbers[start:stop], key, own, stack)
        for place in range(start, stop):
            slots[2 + place - start] = numbers[place]
        factor, trouble = evaluated(ops, args, spans, symbols[code, GROWTH], slots, branched(key, _GROWTH), stack)
        if trouble or abs(factor) == math.inf:
            return ages, factors, values, trouble or NOT_FINITE, at
        factors[at] = factor
        for place in range(start, stop):
            values[place] *= factor
            if not abs(values[place]) < math.inf:
                return ages, factors, values, NOT_FINITE, at
    return ages, factors, values, 0, 0
