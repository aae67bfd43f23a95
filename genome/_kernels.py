"""The grammar machine: expands a genome over a compiled grammar with an explicit stack.

`tests/support/reference_mapper.py` is the same thing as plain recursion, and must give equal results.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]

LABEL, BOUND, CALL, CHOOSE, OPTION, TEST, REPEAT, JUMP, END, WRITE = range(10)
"""The operations; :mod:`genome.program` writes them. Those up to TEST read a gene."""

DONE, OUT_OF_GENES, TOO_LONG = range(3)
"""How an expansion ends."""


@njit(cache=True)
def roomy(array: Ints, size: int) -> Ints:
    """Give the array itself, or a copy of at least twice its room where it holds fewer than ``size`` numbers."""
    if size <= array.size:
        return array
    larger = np.empty(max(size, 2 * array.size), dtype=np.int64)
    larger[: array.size] = array
    return larger


@njit(cache=True)
def chosen(choices: Ints, targets: Ints, row: int, gene: int, short: bool) -> int:
    """Give the address of the alternative that a gene chooses, among all or among the short ones."""
    column = 2 if short else 0
    return int(targets[choices[row, column] + gene % choices[row, column + 1]])


@njit(cache=True)
def expand(  # noqa: C901 - one dispatch loop over ten operations
    code: Ints,
    choices: Ints,
    targets: Ints,
    bound: int,
    words: int,
    genes: Ints,
    start: tuple[int, int, int, int],
    limits: tuple[int, int, int],
) -> tuple[int, int, int, Ints]:
    """Expand one non-terminal.

    Parameters
    ----------
    code, choices, targets, bound
        The compiled grammar, see :class:`genome.program.Program`.
    words
        The number of terminals, so that label i is token ``words + i``.
    genes
        (g,) int64, at least one, each 0 or more; read again from the first after the last.
    start
        The row in ``choices`` of the non-terminal, the depth that it stands at, genes read and labels in use before.
    limits
        The greatest depth of the tree, the most genes to read (those before included), the most tokens to write.

    Returns
    -------
    status : int
        DONE, OUT_OF_GENES or TOO_LONG.
    reads, labels : int
        Genes read and labels in use after.
    tokens : (t,) int64
        What was written.
    """
    argument, depth, reads, labels = start
    max_depth, max_reads, max_tokens = limits
    out = np.empty(256, dtype=np.int64)
    # A call opens a frame: return address, the caller's frame, bound labels (-1 until read). The counter of a
    # repetition lies on top of the frame that it belongs to.
    stack = np.empty(256, dtype=np.int64)
    written = top = base = gene = 0
    operation, pc = CALL, -1
    depth -= 1
    while True:
        token = -1
        if operation == BOUND:
            token = stack[base + 2 + argument]
        if operation <= TEST and token < 0:
            if reads == max_reads:
                return OUT_OF_GENES, reads, labels, out[:written]
            gene = genes[reads % genes.size]
            reads += 1
        if operation == WRITE:
            token = argument
        elif operation <= BOUND:
            if token < 0:
                token = gene % (labels + 1)
                labels = max(labels, token + 1)
            if operation == BOUND:
                stack[base + 2 + argument] = token
            token += words
        elif operation == CALL:
            stack = roomy(stack, top + 2 + bound)
            stack[top] = pc
            stack[top + 1] = base
            stack[top + 2 : top + 2 + bound] = -1
            base = top
            top += 2 + bound
            depth += 1
            pc = chosen(choices, targets, argument, gene, depth >= max_depth - 1)
        elif operation == CHOOSE:
            pc = chosen(choices, targets, argument, gene, depth >= max_depth - 1)
        elif operation == OPTION:
            pc = pc if gene % 2 == 1 else argument
        elif operation == REPEAT:
            stack = roomy(stack, top + 1)
            stack[top] = 0
            top += 1
        elif operation == TEST:
            if gene % (stack[top - 1] + 2) <= stack[top - 1]:
                top -= 1
                pc = argument
            else:
                stack[top - 1] += 1
        elif operation == JUMP:
            pc = argument
        else:  # END
            pc = stack[base]
            top = base
            base = stack[base + 1]
            depth -= 1
            if top == 0:
                return DONE, reads, labels, out[:written]
        if token >= 0:
            if written == max_tokens:
                return TOO_LONG, reads, labels, out[:written]
            out = roomy(out, written + 1)
            out[written] = token
            written += 1
        operation = code[pc, 0]
        argument = code[pc, 1]
        pc += 1
