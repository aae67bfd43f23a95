"""The kernels of births: children are put behind the modules that there are.

`tests/support/reference_timed.py` is the same as plain Python, and must give equal results.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from numba import njit

# isort: off
from growth.timed._expressions import branched, evaluated, lasted
from growth.timed.tables import (
    ASKS, BIRTH_AGE, BORN, CALLS, CHILD, CODE, COUNT, DIES, END, FIRST_ARGUMENT, FIRST_CHILD, FULL, Floats, HELD,
    IN_BIRTH_AGE, IN_END, IN_PARAMETER, Ints, KEY, LAST_ARGUMENT, LAST_CHILD, NEGATIVE_AGE, NEXT_CHILD, NONE,
    NOT_FINITE, ORIGIN, ROLE, SETTLED, START, STOP,
)  # fmt: skip
# isort: on

STANDS_ON: Final = {"_expressions": "47900cba1578"}
"""What the files whose kernels these call were when these were compiled last: Numba looks at this file alone."""

_OPTIONS: Final[Any] = {"cache": True, "error_model": "numpy", "_nrt": False}
_lent: Final = njit(**_OPTIONS)
"""For what makes no arrays: to count references to those that it is given takes longer than all else it does."""

_LIFE: Final = 1 << 42
"""Numbers of branches of a lineage: those that are born."""


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
