"""The grammar machine: expands a genome over a compiled grammar with an explicit stack.

`tests/support/reference_mapper.py` is the same thing as plain recursion, and must give equal results. Parts of the
machine are inlined where they are called: a call that hands over arrays takes longer than what they do.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Bytes = NDArray[np.uint8]

LABEL, BOUND, CALL, CHOOSE, OPTION, TEST, REPEAT, JUMP, END, WRITE = range(10)
"""The operations; :mod:`genome.program` writes them. Those up to TEST read a gene."""

DIGITS = 20
"""Room for any label's number."""

DONE, OUT_OF_GENES, TOO_LONG, NEGATIVE = range(4)
"""How an expansion ends."""


@njit(cache=True)
def larger(array: NDArray[Any], size: int) -> NDArray[Any]:
    """Give a copy with room for twice ``size`` numbers."""
    copy = np.empty(2 * size, dtype=array.dtype)
    copy[: array.size] = array
    return copy


@njit(cache=True)
def chosen(choices: Ints, targets: Ints, row: int, gene: int, short: bool) -> int:
    """Give the address of the alternative that a gene chooses, among all or among the short ones."""
    column = 2 if short else 0
    return int(targets[choices[row, column] + gene % choices[row, column + 1]])


@njit(cache=True)
def put(out: Bytes, size: int, letters: Bytes, first: int, end: int) -> int:
    """Write some of the letters into ``out`` from ``size`` on, and give its new size."""
    for i in range(first, end):
        out[size + i - first] = letters[i]
    return size + end - first


@njit(cache=True)
def put_number(out: Bytes, size: int, number: int) -> int:
    """Write a number of 0 or more into ``out`` from ``size`` on, and give its new size."""
    digits = 1
    power = 10
    while digits < 19 and number >= power:
        digits += 1
        power *= 10
    for i in range(size + digits - 1, size - 1, -1):
        out[i] = 48 + number % 10
        number //= 10
    return size + digits


@njit(cache=True, inline="always")
def opened(stack: Ints, top: int, address: int, base: int, bound: int) -> Ints:
    """Open a frame on top of the stack: return address, the caller's frame, bound labels (-1 until read)."""
    if top + 2 + bound > stack.size:
        stack = larger(stack, top + 2 + bound)
    stack[top] = address
    stack[top + 1] = base
    for i in range(top + 2, top + 2 + bound):
        stack[i] = -1
    return stack


@njit(cache=True, inline="always")
def put_token(out: Bytes, size: int, letters: Bytes, first: int, end: int, number: int) -> tuple[Bytes, int]:
    """Write a word, and a label's number if it is 0 or more; give ``out``, larger where need be, and its new size."""
    needed = size + end - first + DIGITS
    if needed > out.size:
        out = larger(out, needed)
    size = put(out, size, letters, first, end)
    if number >= 0:
        size = put_number(out, size, number)
    return out, size


@njit(cache=True, inline="always")
def repeated(stack: Ints, top: int, gene: int) -> bool:
    """Tell whether a repetition goes on, and count it; it ends when gene mod (count + 2) is at most the count."""
    if gene % (stack[top - 1] + 2) <= stack[top - 1]:
        return False
    stack[top - 1] += 1
    return True


@njit(cache=True, inline="always")
def pushed(stack: Ints, top: int) -> tuple[Ints, int]:
    """Lay the counter of a repetition on the stack; give the stack, larger where need be, and its new top."""
    if top == stack.size:
        stack = larger(stack, top + 1)
    stack[top] = 0
    return stack, top + 1


@njit(cache=True, inline="always")
def labelled(operation: int, number: int, gene: int, labels: int) -> tuple[int, int]:
    """Give the number of the label that is written (-1: none), and how many labels are in use then."""
    if operation <= BOUND and number < 0:
        number = gene % (labels + 1)
        labels = max(labels, number + 1)
    return number, labels


@njit(cache=True, inline="always")
def leaps(operation: int, gene: int, stack: Ints, top: int) -> bool:
    """Tell whether OPTION, TEST or JUMP leads on to its target; a TEST that does not counts the repetition."""
    if operation == OPTION:
        return gene % 2 != 1
    return operation == JUMP or not repeated(stack, top, gene)


@njit(cache=True)
def expand(
    code: Ints,
    choices: Ints,
    targets: Ints,
    letters: Bytes,
    spans: Ints,
    genes: Ints,
    start: tuple[int, int, int, int],
    limits: tuple[int, int, int, int],
) -> tuple[int, int, int, int, Bytes]:
    """Expand one non-terminal.

    Parameters
    ----------
    code, choices, targets, letters, spans
        The compiled grammar, see :class:`genome.program.Program`.
    genes
        (g,) int64, at least one; read again from the first after the last.
    start
        The row in ``choices`` of the non-terminal, the depth that it stands at, genes read and labels in use before.
    limits
        The number of bound labels, the greatest depth of the tree, the most genes to read (those before included), the
        most tokens to write.

    Returns
    -------
    status : int
        DONE, OUT_OF_GENES, TOO_LONG, or NEGATIVE where some gene is.
    reads, labels, written : int
        Genes read and labels in use after; tokens written.
    text : (t,) uint8
        What was written, a separator before each token.
    """
    argument, depth, reads, labels = start
    bound, max_depth, max_reads, max_tokens = limits
    out = np.empty(1024, dtype=np.uint8)
    if genes.min() < 0:
        return NEGATIVE, reads, labels, 0, out[:0]
    # The counter of a repetition lies on top of the frame that it belongs to.
    stack = np.empty(256, dtype=np.int64)
    size = written = top = base = gene = 0
    operation, pc, at = CALL, -1, reads % genes.size
    depth -= 1
    while True:
        number = stack[base + 2 + argument] if operation == BOUND else -1
        if operation <= TEST and number < 0:
            if reads == max_reads:
                return OUT_OF_GENES, reads, labels, written, out[:0]
            gene = genes[at]
            reads += 1
            at = at + 1 if at + 1 < genes.size else 0
        if operation == WRITE or operation <= BOUND:
            if written == max_tokens:
                return TOO_LONG, reads, labels, written, out[:0]
            written += 1
            word = argument if operation == WRITE else spans.shape[0] - 1
            number, labels = labelled(operation, number, gene, labels)
            if operation == BOUND:
                stack[base + 2 + argument] = number
            out, size = put_token(out, size, letters, spans[word, 0], spans[word, 1], number)
        elif operation in (CALL, CHOOSE):
            if operation == CALL:
                stack = opened(stack, top, pc, base, bound)
                base, top, depth = top, top + 2 + bound, depth + 1
            pc = chosen(choices, targets, argument, gene, depth >= max_depth - 1)
        elif operation == REPEAT:
            stack, top = pushed(stack, top)
        elif operation in (OPTION, TEST, JUMP):
            if leaps(operation, gene, stack, top):
                pc, top = argument, top - 1 if operation == TEST else top
        else:  # END
            pc, top, base, depth = stack[base], base, stack[base + 1], depth - 1
            if top == 0:
                return DONE, reads, labels, written, out[:size]
        operation, argument = code[pc, 0], code[pc, 1]
        pc += 1


@njit(cache=True)
def ruled_labels(text: Bytes, stem: Bytes, labels: int) -> NDArray[np.bool_]:
    """Tell which labels some rule of a rule file rewrites.

    Parameters
    ----------
    text
        (t,) uint8, tokens with blanks between them, ``;`` ending each line.
    stem
        (s,) uint8, what a label begins with.
    labels
        How many labels there are.

    Returns
    -------
    (labels,) bool
        Those before an arrow on a line, contexts left out: in a list each, between ``<`` and ``>`` the middle one.
    """
    ruled = np.zeros(labels, dtype=np.bool_)
    heads = np.empty(text.size // 2 + 1, dtype=np.int64)
    found = 0
    state = 0  # 1 in a context on the right, 2 behind the arrow
    end = -1
    while end < text.size:
        first = end + 1
        end = first
        while end < text.size and text[end] != 32:
            end += 1
        length = end - first
        one = text[first] if length == 1 else 0
        if one == 59:  # ;
            found, state = 0, 0
        elif state == 2:
            continue
        elif one == 60:  # <
            found, state = 0, 0
        elif one == 62:  # >
            state = 1
        elif length == 2 and text[first] == 45 and text[first + 1] == 62:  # ->
            for i in range(found):
                ruled[heads[i]] = True
            state = 2
        elif state == 0 and length > stem.size and (text[first : first + stem.size] == stem).all():
            label = 0
            for i in range(first + stem.size, end):
                digit = int(text[i]) - 48
                label = label * 10 + digit if 0 <= digit <= 9 and label < labels else labels
            if label < labels:
                heads[found] = label
                found += 1
    return ruled


@njit(cache=True)
def rule_file(text: Bytes, rules: Bytes) -> Bytes:
    """Lay out a sentence as lines, each ended by a line feed, empty ones left out.

    Parameters
    ----------
    text
        (t,) uint8, tokens with blanks between them, ``;`` ending each line.
    rules
        (r,) uint8, lines to stand behind the last line with an arrow, or else behind the first.

    Returns
    -------
    (n,) uint8
    """
    out = np.empty(text.size + rules.size + 1, dtype=np.uint8)
    size = line = place = 0  # `line` is where the present one begins, `place` where the rules go
    arrow = False
    end = -1
    while end < text.size:
        first = end + 1
        end = first
        while end < text.size and text[end] != 32:
            end += 1
        ends_line = end - first == 1 and text[first] == 59
        if not ends_line and end > first:
            arrow = arrow or (end - first == 2 and text[first] == 45 and text[first + 1] == 62)
            if size > line:
                out[size] = 32
                size += 1
            out[size : size + end - first] = text[first:end]
            size += end - first
        if (ends_line or end >= text.size) and size > line:
            out[size] = 10
            size += 1
            if arrow or line == 0:
                place = size
            line = size
            arrow = False
    out[place + rules.size : size + rules.size] = out[place:size].copy()
    out[place : place + rules.size] = rules
    return out[: size + rules.size]


@njit(cache=True)
def expand_with_repair(
    code: Ints,
    choices: Ints,
    targets: Ints,
    letters: Bytes,
    spans: Ints,
    genes: Ints,
    start: tuple[int, int, int, int],
    limits: tuple[int, int, int, int],
    repair: tuple[int, int],
) -> tuple[int, int, Bytes, Ints]:
    """Expand the start symbol, and then a rule for each label that has none.

    Parameters
    ----------
    code, choices, targets, letters, spans, genes, start, limits
        As for :func:`expand`; the separator is one blank.
    repair
        The row in ``choices`` of the non-terminal that repair expands, and the depth that it stands at.

    Returns
    -------
    status, reads : int
        As from :func:`expand`.
    text : (t,) uint8
        The sentence laid out as a rule file, with the rules that were added.
    repaired : (n,) int64
        Their labels; where the status is not DONE, the last is the one that was being repaired, if any.
    """
    status, reads, labels, written, text = expand(code, choices, targets, letters, spans, genes, start, limits)
    rules = np.empty(256, dtype=np.uint8)
    repaired = np.empty(16, dtype=np.int64)
    size = count = 0
    if status != DONE:
        return status, reads, text, repaired[:0]
    symbol, depth = repair
    bound, max_depth, max_reads, max_tokens = limits
    stem = spans.shape[0] - 1
    ruled = ruled_labels(text[1:], letters[spans[stem, 0] + 1 : spans[stem, 1]], labels)
    arrow = np.array([32, 45, 62], dtype=np.uint8)
    newline = np.array([10], dtype=np.uint8)
    label = 0
    while label < labels:  # a repair may bring new labels, which come after all the others
        if label >= ruled.size or not ruled[label]:
            if count == repaired.size:
                repaired = larger(repaired, count + 1)
            repaired[count] = label
            count += 1
            status, reads, labels, tokens, successor = expand(
                code,
                choices,
                targets,
                letters,
                spans,
                genes,
                (symbol, depth, reads, labels),
                (bound, max_depth, max_reads, max_tokens - written),
            )
            if status != DONE:
                return status, reads, text, repaired[:count]
            written += tokens
            needed = size + spans[stem, 1] - spans[stem, 0] + DIGITS + successor.size + 4
            if needed > rules.size:
                rules = larger(rules, needed)
            size = put(rules, size, letters, spans[stem, 0] + 1, spans[stem, 1])
            size = put(rules, put_number(rules, size, label), arrow, 0, 3)
            size = put(rules, size, successor, 0, successor.size)
            size = put(rules, size, newline, 0, 1)
        label += 1
    return status, reads, rule_file(text[1:], rules[:size]), repaired[:count]
