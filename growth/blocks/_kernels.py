"""The kernels of block growth: rewriting of words, the turtle, and what stands around a skeleton.

Words are arrays of codes (uint8), places in :data:`genome.lsystem.symbols.ALPHABET`. Cells are three integers of less
than :data:`FARTHEST` in size each; sets of them are open hash tables of packed keys, -1 where free.
`tests/support/reference_blocks.py` is the same as plain Python, and must give equal results.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

Codes = NDArray[np.uint8]
Ints = NDArray[np.int64]
Floats = NDArray[np.float64]
State = NDArray[np.uint64]

TURNS: Final = 7
OPEN: Final = 7
CLOSE: Final = 8
SIBLING: Final = 9
LETTERS: Final = 10
FORWARD: Final = 15
"""Codes: those under TURNS turn, those from LETTERS on are letters."""

NONE: Final = -1
"""No letter, no rule, any context."""

FARTHEST: Final = 2**19
"""Coordinates are smaller than this in size, and so are the sums of two of them with a margin."""

_GOLDEN: Final = np.uint64(0x9E3779B97F4A7C15)
_FIRST: Final = np.uint64(0xBF58476D1CE4E5B9)
_SECOND: Final = np.uint64(0x94D049BB133111EB)


@njit(cache=True)
def uniform(state: State) -> float:
    """Draw from 0 up to, and without, 1, in steps of 2**-53 (SplitMix64: Steele, Lea and Flood 2014)."""
    state[0] += _GOLDEN
    z = state[0]
    z = (z ^ (z >> np.uint64(30))) * _FIRST
    z = (z ^ (z >> np.uint64(27))) * _SECOND
    z ^= z >> np.uint64(31)
    return np.float64(z >> np.uint64(11)) * 2.0**-53


@njit(cache=True)
def right_contexts(word: Codes) -> Ints:
    """Give the next letter on the same branch behind each place, or NONE."""
    after = np.empty(word.size, dtype=np.int64)
    waiting = np.empty(word.size, dtype=np.int64)
    height = 0
    following = np.int64(NONE)
    for at in range(word.size - 1, -1, -1):
        after[at] = following
        code = word[at]
        if code == CLOSE:
            waiting[height] = following
            height += 1
            following = np.int64(NONE)
        elif code == SIBLING:
            following = np.int64(NONE)
        elif code == OPEN:
            height -= 1
            following = waiting[height]
        elif code >= LETTERS:
            following = np.int64(code)
    return after


@njit(cache=True)
def choose(
    word: Codes, groups: Ints, contexts: Ints, spans: Ints, until: Floats, lengths: Ints, state: State
) -> tuple[Ints, int]:
    """Choose a rule, or NONE, for every place of a word.

    Parameters
    ----------
    word
        (n,) codes.
    groups
        (37,) where the groups of rules of each code begin; those with more context stand first.
    contexts
        (g, 2) the left and right letter that each group wants; NONE where any will do.
    spans
        (g + 1,) where the rules of each group begin.
    until
        (r,) the sum of the chances of a group's rules up to and with each; over 1 in the last of those that leave none.
    lengths
        (r,) of the successors.
    state
        (1,) of the random numbers; one is drawn for each operand whose group leaves something to chance.

    Returns
    -------
    chosen
        (n,) rules.
    total
        The length of the next word.
    """
    chosen = np.full(word.size, NONE, dtype=np.int64)
    after = right_contexts(word)
    waiting = np.empty(word.size, dtype=np.int64)
    height = 0
    before = np.int64(NONE)
    total = 0
    for at in range(word.size):
        code = word[at]
        length = 1
        for group in range(groups[code], groups[code + 1]):
            left, right = contexts[group, 0], contexts[group, 1]
            if (left != NONE and left != before) or (right != NONE and right != after[at]):
                continue
            rule, end = spans[group], spans[group + 1]
            if until[rule] <= 1.0:
                drawn = uniform(state)
                while rule < end and until[rule] <= drawn:
                    rule += 1
            if rule < end:
                chosen[at] = rule
                length = lengths[rule]
            break
        total += length
        if code == OPEN:
            waiting[height] = before
            height += 1
        elif code == SIBLING:
            before = waiting[height - 1]
        elif code == CLOSE:
            height -= 1
            before = waiting[height]
        elif code >= LETTERS:
            before = np.int64(code)
    return chosen, total


@njit(cache=True)
def rewrite(word: Codes, chosen: Ints, total: int, successors: Codes, starts: Ints) -> Codes:
    """Write the word of length ``total`` in which each place with a rule has become that rule's successor."""
    new = np.empty(total, dtype=np.uint8)
    size = 0
    for at in range(word.size):
        rule = chosen[at]
        if rule == NONE:
            new[size] = word[at]
            size += 1
        else:
            for place in range(starts[rule], starts[rule + 1]):
                new[size] = successors[place]
                size += 1
    return new


@njit(cache=True)
def key_of(x: int, y: int, z: int) -> int:
    """Pack a cell into one number of 0 or more."""
    return ((x + 2 * FARTHEST) << 42) | ((y + 2 * FARTHEST) << 21) | (z + 2 * FARTHEST)


@njit(cache=True)
def table_for(count: int) -> Ints:
    """Make an empty set with room for so many cells: a power of two, at most half full."""
    size = 16
    while size < 2 * count:
        size *= 2
    return np.full(size, -1, dtype=np.int64)


@njit(cache=True)
def place_of(table: Ints, key: int) -> int:
    """Give where a key stands in a set, or where it would."""
    mask = table.size - 1
    at = int(np.int64((np.uint64(key) * _GOLDEN) >> np.uint64(32))) & mask
    while table[at] != -1 and table[at] != key:
        at = (at + 1) & mask
    return at


@njit(cache=True)
def walk(word: Codes, offsets: Ints, turns: Ints, start: int, most: int) -> tuple[Ints, int]:
    """Let the turtle read a word, from a block at the origin on.

    Parameters
    ----------
    word
        (n,) codes with balanced brackets.
    offsets
        (k, 3) to the neighbours of a cell.
    turns
        (7, k) the heading after each turn, by heading.
    start
        The first heading.
    most
        Blocks; at least 1.

    Returns
    -------
    cells
        (m, 3), each once, in the order in which they were placed.
    count
        Of the blocks, ``most + 1`` where there are more than ``most``; then the turtle stopped.
    """
    steps, deepest, height = 1, 0, 0
    for code in word:
        if code == FORWARD:
            steps += 1
        elif code == OPEN:
            height += 1
            deepest = max(deepest, height)
        elif code == CLOSE:
            height -= 1
    room = min(steps, most)
    cells = np.zeros((room, 3), dtype=np.int64)
    table = table_for(room)
    table[place_of(table, key_of(0, 0, 0))] = key_of(0, 0, 0)
    count = 1
    stack = np.empty((deepest, 4), dtype=np.int64)
    x, y, z = np.int64(0), np.int64(0), np.int64(0)
    heading = np.int64(start)
    height = 0
    for code in word:
        if code < TURNS:
            heading = turns[code, heading]
        elif code == FORWARD:
            x += offsets[heading, 0]
            y += offsets[heading, 1]
            z += offsets[heading, 2]
            key = key_of(x, y, z)
            at = place_of(table, key)
            if table[at] == -1:
                if count == most:
                    return cells, most + 1
                table[at] = key
                cells[count, 0], cells[count, 1], cells[count, 2] = x, y, z
                count += 1
        elif code == OPEN:
            stack[height, 0], stack[height, 1], stack[height, 2], stack[height, 3] = x, y, z, heading
            height += 1
        elif code in (SIBLING, CLOSE):
            top = height - 1
            x, y, z, heading = stack[top, 0], stack[top, 1], stack[top, 2], stack[top, 3]
            if code == CLOSE:
                height -= 1
    return cells[:count].copy(), count


@njit(cache=True)
def distinct(cells: Ints, taken: Ints) -> Ints:
    """Give the cells that are not taken, each once, in order: of (n, 3) and (m, 3) at most (n, 3)."""
    table = table_for(len(cells) + len(taken))
    for i in range(len(taken)):
        key = key_of(taken[i, 0], taken[i, 1], taken[i, 2])
        table[place_of(table, key)] = key
    kept = np.empty_like(cells)
    count = 0
    for i in range(len(cells)):
        key = key_of(cells[i, 0], cells[i, 1], cells[i, 2])
        at = place_of(table, key)
        if table[at] == -1:
            table[at] = key
            kept[count] = cells[i]
            count += 1
    return kept[:count].copy()


@njit(cache=True)
def foundation(cells: Ints, beneath: Ints, level: int) -> Ints:
    """Give the free cells beneath the cells of a level, each once: (b, 3)."""
    table = table_for(len(cells) * (1 + len(beneath)))
    for i in range(len(cells)):
        key = key_of(cells[i, 0], cells[i, 1], cells[i, 2])
        table[place_of(table, key)] = key
    found = np.empty((len(cells) * len(beneath), 3), dtype=np.int64)
    count = 0
    for i in range(len(cells)):
        if cells[i, 2] != level:
            continue
        for j in range(len(beneath)):
            x, y, z = cells[i, 0] + beneath[j, 0], cells[i, 1] + beneath[j, 1], cells[i, 2] + beneath[j, 2]
            key = key_of(x, y, z)
            at = place_of(table, key)
            if table[at] == -1:
                table[at] = key
                found[count, 0], found[count, 1], found[count, 2] = x, y, z
                count += 1
    return found[:count].copy()


@njit(cache=True)
def envelope(internal: Ints, boundary: Ints, offsets: Ints, fewer: int, floor: int) -> Ints:
    """Give the free neighbours of the internal cells that have under ``fewer`` neighbours, each once: (e, 3).

    None lies under ``floor``.
    """
    table = table_for((len(internal) + len(boundary)) * (1 + len(offsets)))
    for i in range(len(internal)):
        key = key_of(internal[i, 0], internal[i, 1], internal[i, 2])
        table[place_of(table, key)] = key
    for i in range(len(boundary)):
        key = key_of(boundary[i, 0], boundary[i, 1], boundary[i, 2])
        table[place_of(table, key)] = key
    few = np.zeros(len(internal), dtype=np.bool_)
    for i in range(len(internal)):
        near = 0
        for j in range(len(offsets)):
            x, y, z = internal[i, 0] + offsets[j, 0], internal[i, 1] + offsets[j, 1], internal[i, 2] + offsets[j, 2]
            near += table[place_of(table, key_of(x, y, z))] != -1
        few[i] = near < fewer
    found = np.empty((few.sum() * len(offsets), 3), dtype=np.int64)
    count = 0
    for i in range(len(internal)):
        if not few[i]:
            continue
        for j in range(len(offsets)):
            x, y, z = internal[i, 0] + offsets[j, 0], internal[i, 1] + offsets[j, 1], internal[i, 2] + offsets[j, 2]
            key = key_of(x, y, z)
            at = place_of(table, key)
            if z >= floor and table[at] == -1:
                table[at] = key
                found[count, 0], found[count, 1], found[count, 2] = x, y, z
                count += 1
    return found[:count].copy()
