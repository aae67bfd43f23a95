"""The kernels of whole words: contexts, and development functions.

`tests/support/reference_timed.py` is the same as plain Python, and must give equal results.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numba import njit

# isort: off
from growth.timed._expressions import branched, evaluated, lasted
from growth.timed.tables import (
    CLOSE_CODE, CODE, END, Floats, GROWTH, IGNORED, Ints, KEY, Modules, NONE, NOT_FINITE, OPEN_CODE, ORIGIN, START,
    STOP, Tables,
)  # fmt: skip
# isort: on

STANDS_ON: Final = {"_expressions": "47900cba1578"}
"""What the files whose kernels these call were when these were compiled last: Numba looks at this file alone."""

_GROWTH: Final = 1 << 43
"""Numbers of branches of a lineage: development function."""


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
