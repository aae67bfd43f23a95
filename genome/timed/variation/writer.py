"""Writes words and conditions of productions: genes, mapped by a grammar, read as the language has them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeVar, final

import numpy as np

from genome.errors import InputError
from genome.grammar import Grammar
from genome.mapping import Mapper, Unmapped
from genome.timed.expression import Expression, Name, substituted
from genome.timed.reading import Reader
from genome.timed.statements import read_birth_word
from genome.timed.system import Birth, Production, TimedSystem
from genome.timed.tokens import lines
from genome.timed.variation.alphabet import spelt

TRIES: Final = 6
"""Genomes that are drawn until one maps to something that can be read."""

CEILING: Final = 2**31
"""Genes are integers from 0 up to, and without, this."""

MOST_TOKENS: Final = 2000

SUCCESSOR: Final = "Successor"
MODULE: Final = "Module"
CONDITION: Final = "Condition"
WORDS: Final = (SUCCESSOR, MODULE)

T = TypeVar("T")


@final
class Writer:
    """Writes parts of productions anew.

    Parameters
    ----------
    grammar
        Its ``<Successor.X>``, ``<Module.X>`` and ``<Condition.X>`` are for productions of X, those without a symbol
        for every one that has none of its own. Names of parameters are those of the symbol's first production in
        ``system``.
    system
        The file's.
    genes
        How many are drawn.
    depth
        As of :class:`genome.mapping.Mapper`.
    """

    def __init__(self, grammar: Grammar, system: TimedSystem, genes: int, depth: int) -> None:
        self.grammar: Final = grammar
        self._mapper: Final = Mapper(grammar, max_depth=depth, max_tokens=MOST_TOKENS)
        self._genes: Final = genes
        self._formals: Final = {
            one.predecessor.symbol: one.predecessor.parameters for one in reversed(system.productions)
        }

    def successor(self, production: Production, rng: np.random.Generator) -> tuple[Birth, ...] | None:
        """Write a word that could be a production's successor; ``None`` where the grammar writes none."""
        return self._word(SUCCESSOR, production, rng)

    def module(self, production: Production, rng: np.random.Generator) -> tuple[Birth, ...] | None:
        """Write what stands for one module of a production's successor; ``None`` where the grammar writes none."""
        return self._word(MODULE if self.begins(MODULE, production) else SUCCESSOR, production, rng)

    def condition(self, production: Production, rng: np.random.Generator) -> Expression | None:
        """Write a condition; ``None`` where the grammar writes none."""
        return self._written(CONDITION, production, rng, Reader.expression, substituted)

    def begins(self, what: str, production: Production) -> str:
        """Give the non-terminal that something of a production begins with; empty where there is none."""
        own = f"{what}.{spelt(production.predecessor.symbol)}"
        return own if own in self.grammar.rules else what if what in self.grammar.rules else ""

    def sentence(self, start: str, rng: np.random.Generator) -> str | None:
        """Map genes to text, with wrapping; ``None`` where they ran out each time."""
        for _ in range(TRIES):
            row = rng.integers(0, CEILING, size=self._genes, dtype=np.int64)
            found = self._mapper.derive(row, start)
            if not isinstance(found, Unmapped):
                return found.text
        return None

    def _word(self, what: str, production: Production, rng: np.random.Generator) -> tuple[Birth, ...] | None:
        return self._written(what, production, rng, read_birth_word, _renamed)

    def _written(
        self,
        what: str,
        production: Production,
        rng: np.random.Generator,
        read: Callable[[Reader], T],
        rename: Callable[[T, dict[str, Expression]], T],
    ) -> T | None:
        start = self.begins(what, production)
        if not start:
            return None
        for _ in range(TRIES):
            text = self.sentence(start, rng)
            if text is None:
                return None
            try:
                found = read_whole(text, start, read)
            except InputError:
                continue
            names = self._names(production)
            return rename(found, names) if names else found
        return None

    def _names(self, production: Production) -> dict[str, Expression]:
        """Give the production's own names for the grammar's, where they differ."""
        own = production.predecessor.parameters
        given = self._formals.get(production.predecessor.symbol, own)
        return {} if given == own else {name: Name(other) for name, other in zip(given, own, strict=False)}


def read_whole(text: str, where: str, read: Callable[[Reader], T]) -> T:
    """Read something that is all of a text.

    Raises
    ------
    InputError
        For anything else.
    """
    rows = list(lines(text, where))
    if len(rows) != 1:
        raise InputError(where, "one line", f"{len(rows)} lines")
    reader = Reader(rows[0], where)
    found = read(reader)
    if reader.next.kind != "end":
        raise reader.error("the end of the text")
    return found


def _renamed(word: tuple[Birth, ...], names: dict[str, Expression]) -> tuple[Birth, ...]:
    return tuple(
        Birth(
            birth.symbol, tuple(substituted(one, names) for one in birth.arguments), substituted(birth.age, names),
            birth.at,
        )
        for birth in word
    )  # fmt: skip
