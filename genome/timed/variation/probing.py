"""Tries a grammar out before a run, so that one that writes nonsense is refused and no generation is lost."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from genome.errors import InputError
from genome.timed.checks import check_system
from genome.timed.reading import Reader
from genome.timed.statements import read_birth_word
from genome.timed.system import Production, TimedSystem
from genome.timed.variation.writer import CONDITION, MODULE, SUCCESSOR, Writer, read_whole

SENTENCES: Final = 32
"""How many are written of each non-terminal for each symbol."""


def probe(writer: Writer, system: TimedSystem, symbols: tuple[str, ...], where: str) -> None:
    """Refuse a grammar that writes what is not of the language, or nothing that fits into a symbol's productions.

    Parameters
    ----------
    writer
        Holds the grammar.
    system
        The file's.
    symbols
        Those whose productions vary.
    where
        The experiment's key, for messages.

    Raises
    ------
    InputError
        With the first sentence that is wrong.
    """
    rng = np.random.default_rng(0)
    for symbol in symbols:
        at = next(at for at, one in enumerate(system.productions) if one.predecessor.symbol == symbol)
        production = system.productions[at]
        if not writer.begins(SUCCESSOR, production):
            raise InputError(where, f"a production <{SUCCESSOR}>, or <{SUCCESSOR}.X> for every symbol X that varies",
                             f"none for '{symbol}'", "add one, or list the symbol under protected")  # fmt: skip
        for what in (SUCCESSOR, MODULE, CONDITION):
            start = writer.begins(what, production)
            if start:
                _probe_one(writer, system, at, what, start, where, rng)


def _probe_one(
    writer: Writer, system: TimedSystem, at: int, what: str, start: str, where: str, rng: np.random.Generator
) -> None:
    """Write sentences of one non-terminal: each has to be of the language, and one to fit."""
    production = system.productions[at]
    complaint = ""
    fits = 0
    for text in _sentences(writer, start, where, rng):
        try:
            child = _read(text, production, what)
        except InputError as error:
            got = f"'{text}', where {error.expected} is expected"
            raise InputError(
                where, f"<{start}> to write what the language takes", got, "see docs/formats/tl.md"
            ) from None
        try:
            check_system(replace(system, productions=(*system.productions[:at], child, *system.productions[at + 1 :])))
            fits += 1
        except InputError as error:
            complaint = complaint or f"'{text}', which has {error.got} where {error.expected} is expected"
    if not fits:
        remedy = f"<{what}.X> is for productions of X alone"
        symbol = production.predecessor.symbol
        raise InputError(where, f"<{start}> to write what can stand in a production of '{symbol}'", complaint, remedy)


def _sentences(writer: Writer, start: str, where: str, rng: np.random.Generator) -> Iterator[str]:
    for _ in range(SENTENCES):
        text = writer.sentence(start, rng)
        if text is None:
            raise InputError(where, f"<{start}> to end", "more genes or tokens than there are", "set genes higher")
        yield text


def _read(text: str, production: Production, what: str) -> Production:
    """Put what a sentence says into a production."""
    if what == CONDITION:
        return replace(production, condition=read_whole(text, "sentence", Reader.expression))
    return replace(production, successor=read_whole(text, "sentence", read_birth_word))
