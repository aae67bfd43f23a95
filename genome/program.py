"""Compiles a grammar to arrays that the kernel in :mod:`genome._kernels` runs.

Each alternative becomes a stretch of instructions ``(operation, argument)``. A choice is a range of addresses in
``targets``: all alternatives first, then the ones allowed when the tree may grow no deeper.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from genome._kernels import BOUND, CALL, CHOOSE, END, JUMP, LABEL, OPTION, REPEAT, TEST, WRITE
from genome.grammar import Alternatives, Grammar, NonTerminal, Option, Sequence, Terminal, least_depths, shortest

Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Labels:
    """How terminals get labels from the genome (Hemberg 2006, section 5.1).

    Attributes
    ----------
    name
        The terminal that reads a label of its own, and the stem that every label is written with.
    bound
        Terminals that share one label within an instance of a production.
    first
        How many labels there are before the first one is read.
    """

    name: str = "Edge"
    bound: tuple[str, ...] = ("EdgeX", "EdgeY", "EdgeZ")
    first: int = 2


@dataclass(frozen=True, slots=True, eq=False)
class Program:
    """A compiled grammar.

    Attributes
    ----------
    code
        (n, 2) int64, operations and their arguments.
    choices
        (c, 4) int64: first address of all alternatives in ``targets``, their number, and the same for the ones that
        are left at the greatest depth. The first rows are the non-terminals, in the grammar's order.
    targets
        (t,) int64, addresses in ``code``.
    letters
        (l,) uint8, the terminals in UTF-8 one after the other, a separator before each, and last the labels' stem.
    spans
        (w + 1, 2) int64, where each begins and ends in ``letters``.
    symbols
        The row in ``choices`` of each non-terminal.
    bound
        How many bound labels an instance of a production has.
    """

    code: Ints
    choices: Ints
    targets: Ints
    letters: NDArray[np.uint8]
    spans: Ints
    symbols: dict[str, int]
    bound: int


def compile_grammar(grammar: Grammar, labels: Labels | None, separator: str) -> Program:
    """Compile a grammar; without ``labels`` every terminal is written as it is."""
    return _Compiler(grammar, labels).program(separator)


class _Compiler:
    def __init__(self, grammar: Grammar, labels: Labels | None) -> None:
        self.grammar = grammar
        self.label = labels.name if labels else None
        self.bound = {name: i for i, name in enumerate(labels.bound)} if labels else {}
        self.depths = least_depths(grammar.rules)
        self.symbols = {name: i for i, name in enumerate(grammar.rules)}
        self.code: list[tuple[int, int]] = []
        self.choices: list[tuple[int, int, int, int]] = [(0, 0, 0, 0)] * len(self.symbols)
        self.targets: list[int] = []
        self.words: dict[str, int] = {}

    def program(self, separator: str) -> Program:
        for name, alternatives in self.grammar.rules.items():
            addresses = []
            for sequence in alternatives:
                addresses.append(len(self.code))
                self._sequence(sequence)
                self._emit(END)
            self.choices[self.symbols[name]] = self._choice(alternatives, addresses)
        written = [f"{separator}{word}".encode() for word in [*self.words, self.label or ""]]
        ends = np.cumsum([0, *map(len, written)], dtype=np.int64)
        return Program(
            code=np.array(self.code, dtype=np.int64).reshape(-1, 2),
            choices=np.array(self.choices, dtype=np.int64).reshape(-1, 4),
            targets=np.array(self.targets, dtype=np.int64),
            letters=np.frombuffer(b"".join(written) or b" ", dtype=np.uint8),
            spans=np.column_stack([ends[:-1], ends[1:]]),
            symbols=self.symbols,
            bound=len(self.bound),
        )

    def _emit(self, operation: int, argument: int = 0) -> int:
        self.code.append((operation, argument))
        return len(self.code) - 1

    def _point_here(self, *instructions: int) -> None:
        """Fill in the argument of jumps written before their target was known."""
        for at in instructions:
            self.code[at] = (self.code[at][0], len(self.code))

    def _choice(self, alternatives: Alternatives, addresses: list[int]) -> tuple[int, int, int, int]:
        short = shortest(alternatives, self.depths)
        first = len(self.targets)
        self.targets.extend(addresses)
        self.targets.extend(addresses[i] for i in short)
        return first, len(addresses), first + len(addresses), len(short)

    def _sequence(self, sequence: Sequence) -> None:
        for item in sequence:
            if isinstance(item, Terminal):
                self._terminal(item.text)
            elif isinstance(item, NonTerminal):
                self._emit(CALL, self.symbols[item.name])
            elif isinstance(item, Option):
                test = self._emit(OPTION)
                self._group(item.alternatives)
                self._point_here(test)
            else:
                self._emit(REPEAT)
                test = self._emit(TEST)
                self._group(item.alternatives)
                self._emit(JUMP, test)
                self._point_here(test)

    def _terminal(self, text: str) -> None:
        if text == self.label:
            self._emit(LABEL)
        elif text in self.bound:
            self._emit(BOUND, self.bound[text])
        else:
            self._emit(WRITE, self.words.setdefault(text, len(self.words)))

    def _group(self, alternatives: Alternatives) -> None:
        """Compile what stands in braces or brackets: a gene chooses where there is more than one alternative."""
        if len(alternatives) == 1:
            self._sequence(alternatives[0])
            return
        row = len(self.choices)
        self.choices.append((0, 0, 0, 0))
        self._emit(CHOOSE, row)
        addresses, jumps = [], []
        for sequence in alternatives:
            addresses.append(len(self.code))
            self._sequence(sequence)
            jumps.append(self._emit(JUMP))
        self._point_here(*jumps)
        self.choices[row] = self._choice(alternatives, addresses)
