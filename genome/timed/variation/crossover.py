"""Crossover of timed systems: by symbol, or by parts of words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from genome.timed.system import Define, Production, TimedSystem
from genome.timed.variation.structure import with_productions
from genome.timed.variation.words import any_span, put

Pair = tuple[TimedSystem, TimedSystem]


def by_symbol(first: TimedSystem, second: TimedSystem, symbols: tuple[str, ...], rng: np.random.Generator) -> Pair:
    """Exchange, each with even chances: all productions of a symbol, every define, and the axiom.

    Parameters
    ----------
    first, second
        The parents; of symbols that only one has productions of nothing is exchanged, and so of defines.
    symbols
        Those whose productions vary.
    rng
        Where all is drawn from.
    """
    one, other = first, second
    for symbol in symbols:
        here, there = _of(one, symbol), _of(other, symbol)
        if here and there and rng.random() < 0.5:
            one, other = _with(one, symbol, there), _with(other, symbol, here)
    mine, theirs = _defines(one, other, rng), other.defines
    swapped = {old.name: old for old, new in zip(one.defines, mine, strict=True) if old != new}
    theirs = tuple(swapped.get(define.name, define) for define in theirs)
    one, other = replace(one, defines=mine), replace(other, defines=theirs)
    if rng.random() < 0.5:
        return replace(one, axiom=other.axiom), replace(other, axiom=one.axiom)
    return one, other


def by_words(first: TimedSystem, second: TimedSystem, symbols: tuple[str, ...], rng: np.random.Generator) -> Pair:
    """Exchange a branch, or modules side by side, between two productions of one symbol, each pair as likely.

    Parameters as of :func:`by_symbol`.
    """
    pairs = [
        (i, j)
        for symbol in symbols
        for i in _places(first, symbol)
        for j in _places(second, symbol)
        if first.productions[i].successor and second.productions[j].successor
    ]
    if not pairs:
        return first, second
    i, j = pairs[int(rng.integers(len(pairs)))]
    here, there = first.productions[i], second.productions[j]
    mine, theirs = any_span(here.successor, rng), any_span(there.successor, rng)
    if mine is None or theirs is None:
        return first, second
    taken, given = there.successor[slice(*theirs)], here.successor[slice(*mine)]
    child = replace(here, successor=put(here.successor, mine, taken))
    twin = replace(there, successor=put(there.successor, theirs, given))
    return with_productions(first, i, (child,)), with_productions(second, j, (twin,))


def _of(system: TimedSystem, symbol: str) -> tuple[Production, ...]:
    return tuple(one for one in system.productions if one.predecessor.symbol == symbol)


def _places(system: TimedSystem, symbol: str) -> list[int]:
    return [place for place, one in enumerate(system.productions) if one.predecessor.symbol == symbol]


def _with(system: TimedSystem, symbol: str, new: tuple[Production, ...]) -> TimedSystem:
    """Put productions where the first of their symbol stood."""
    at = _places(system, symbol)[0]
    others = [one for one in system.productions[at:] if one.predecessor.symbol != symbol]
    return replace(system, productions=(*system.productions[:at], *new, *others))


def _defines(one: TimedSystem, other: TimedSystem, rng: np.random.Generator) -> tuple[Define, ...]:
    theirs = {define.name: define for define in other.defines}
    return tuple(
        theirs[define.name] if define.name in theirs and rng.random() < 0.5 else define for define in one.defines
    )
