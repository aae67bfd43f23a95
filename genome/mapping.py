"""Grammatical evolution: maps a genome of integers to a sentence of any grammar.

The rules are those of Hemberg 2006, sections 5.1 and 5.2, and `docs/papers/grammatical-evolution.md` says how they
are read: every choice of a production costs a gene, even where there is only one; ``{ }`` and ``[ ]`` ask the genome
whether to go on; labels are read as they are written.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from genome import _kernels
from genome.errors import InputError
from genome.grammar import Grammar
from genome.program import Labels, compile_grammar

UNLIMITED = 1 << 40


@dataclass(frozen=True, slots=True)
class Unmapped:
    """A genome that maps to nothing; ``reason`` says why."""

    reason: str


NO_GENES = Unmapped("the genome has no genes")


@dataclass(frozen=True, slots=True)
class Derivation:
    """A sentence, and where its reading stopped.

    Attributes
    ----------
    text
        What was written, its tokens joined by the separator.
    tokens
        How many they are.
    genes_read
        How many genes were read, those read again included.
    labels
        How many labels are in use.
    """

    text: str
    tokens: int
    genes_read: int
    labels: int


class Mapper:
    """A grammar, made ready to map genomes.

    Parameters
    ----------
    grammar
        What to write sentences of.
    labels
        Which terminals read labels; without, every terminal is written as it is.
    max_depth
        The depth of the derivation tree that only short productions may reach; the start symbol is at depth 0.
        Without, the tree may grow as deep as the genome takes it.
    wraps
        How often the genome may be read again from its first gene.
    max_tokens
        The most tokens that a sentence may have.
    separator
        What stands between two tokens of the text.
    """

    def __init__(
        self,
        grammar: Grammar,
        labels: Labels | None = None,
        max_depth: int | None = None,
        wraps: int = 3,
        max_tokens: int = 100_000,
        separator: str = " ",
    ) -> None:
        self.grammar = grammar
        self._program = compile_grammar(grammar, labels, separator)
        self._first = labels.first if labels else 0
        self._depth = UNLIMITED if max_depth is None else max_depth
        self._wraps = wraps
        self._max_tokens = max_tokens
        self._separator = len(separator.encode())

    def map(self, genes: Sequence[int]) -> str | Unmapped:
        """Map a genome to a text.

        Parameters
        ----------
        genes
            Integers of 0 or more.

        Returns
        -------
        str or Unmapped
            The sentence, its tokens joined by the separator.
        """
        found = self.derive(genes)
        return found if isinstance(found, Unmapped) else found.text

    def derive(
        self,
        genes: Sequence[int] | NDArray[np.int64],
        symbol: str | None = None,
        depth: int = 0,
        after: Derivation | None = None,
    ) -> Derivation | Unmapped:
        """Expand one non-terminal.

        Parameters
        ----------
        genes
            Integers of 0 or more; an array is taken as it is.
        symbol
            The non-terminal, the start symbol unless given.
        depth
            The depth at which it stands.
        after
            A derivation whose reading goes on: its genes are read, its labels in use.

        Returns
        -------
        Derivation or Unmapped
            Unmapped where the genome has no genes, or they ran out, or the sentence grew too long.
        """
        row = genes if isinstance(genes, np.ndarray) else gene_array(genes)
        if not row.size:
            return NO_GENES
        program = self._program
        start = (
            program.symbols[self.grammar.start if symbol is None else symbol],
            depth,
            after.genes_read if after else 0,
            after.labels if after else self._first,
        )
        limits = (program.bound, self._depth, row.size * (self._wraps + 1), self._max_tokens)
        status, reads, labels, tokens, letters = _kernels.expand(
            program.code, program.choices, program.targets, program.letters, program.spans, row, start, limits
        )
        if status == _kernels.DONE:
            return Derivation(letters.tobytes()[self._separator :].decode(), tokens, reads, labels)
        return unmapped(status, reads, row.size, self._wraps, self._max_tokens)


def unmapped(status: int, reads: int, genes: int, wraps: int, max_tokens: int) -> Unmapped:
    """Say why an expansion did not end; InputError where a gene is negative."""
    if status == _kernels.OUT_OF_GENES:
        return Unmapped(f"the genome ran out after {reads} genes ({wraps} wraps of {genes})")
    if status == _kernels.TOO_LONG:
        return Unmapped(f"the text grew past {max_tokens} tokens")
    raise _bad_genes()


def gene_array(genes: Sequence[int]) -> NDArray[np.int64]:
    """Give genes as an (n,) int64 array; InputError where one is no integer or too large."""
    try:
        return np.frombuffer(array("q", genes), dtype=np.int64)
    except (OverflowError, TypeError):
        raise _bad_genes() from None


def _bad_genes() -> InputError:
    return InputError("genome", "integers from 0 to 9223372036854775807", "something else", "give a list of them")
