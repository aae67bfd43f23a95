"""The kernels of rewriting by events: which production a module takes, and how far a word is rewritten.

Every module is computed by itself, by scalar code, and draws from its own lineage. `tests/support/reference_timed.py`
is the same as plain Python, and must give equal results.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

# isort: off
from growth.timed._expressions import branched, evaluated, lasted, uniform
from growth.timed._births import put
from growth.timed.tables import (
    AGAIN, ASKS, AT, CHANCE, CHILD, CODE, COLUMNS, CONDITION, COUNT, DIES, END, EVENTS, FIRST_BIRTH, FIRST_CHILD,
    FIRST_RULE, FULL, Floats, HEIGHT, HELD, IN_BIRTH_AGE, IN_CHANCE, IN_CONDITION, IN_END, IN_PARAMETER, Ints, KEY,
    LAST_BIRTH, LAST_CHILD, LAST_RULE, LEFT, MARKS, MODULES, Modules, NEXT_CHILD, NONE, NO_CHANCE, ORIGIN,
    PILE_COLUMNS, PLAIN, RIGHT, ROLE, START, STOP, TALLY, Tables,
)  # fmt: skip
# isort: on

STANDS_ON: Final = {"_expressions": "47900cba1578", "_births": "54a1660a8013"}
"""What the files whose kernels these call were when these were compiled last: Numba looks at this file alone."""

_OPTIONS: Final[Any] = {"cache": True, "error_model": "numpy", "_nrt": False}
_lent: Final = njit(**_OPTIONS)
"""For what makes no arrays: to count references to those that it is given takes longer than all else it does."""

_CHOICE: Final = 1 << 40
"""Numbers of branches of a lineage: choice of production."""


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
