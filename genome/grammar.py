"""Grammars as values: terminals, non-terminals, repetitions, options, and how deep each must go.

A grammar is what :func:`genome.bnf.parse_bnf` returns and what :mod:`genome.program` compiles. Nothing here knows
the text that it was written in.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

ENDLESS = 1 << 40
"""The least depth of a non-terminal that no finite derivation ends."""


@dataclass(frozen=True, slots=True)
class Terminal:
    """A token that is written as it is; the empty one writes nothing."""

    text: str


@dataclass(frozen=True, slots=True)
class NonTerminal:
    """A reference to a production by its name, without the angle brackets."""

    name: str


@dataclass(frozen=True, slots=True)
class Repeat:
    """``{ ... }``: nought or more times one of the alternatives."""

    alternatives: Alternatives


@dataclass(frozen=True, slots=True)
class Option:
    """``[ ... ]``: one of the alternatives, or nothing."""

    alternatives: Alternatives


Item = Terminal | NonTerminal | Repeat | Option
Sequence = tuple[Item, ...]
Alternatives = tuple[Sequence, ...]


@dataclass(frozen=True, slots=True)
class Grammar:
    """A context-free grammar in extended Backus-Naur form.

    Attributes
    ----------
    source
        Where it was read from, for messages.
    start
        The start symbol: the name of the first production.
    rules
        Each non-terminal's alternatives, in the order written. Every non-terminal used is defined, and each has a
        finite derivation.
    """

    source: str
    start: str
    rules: Mapping[str, Alternatives]


def terminals(sequence: Sequence) -> Iterator[str]:
    """Give the terminals of a sequence, those inside groups included, in the order written."""
    for item in sequence:
        if isinstance(item, Terminal):
            yield item.text
        elif isinstance(item, (Repeat, Option)):
            for alternative in item.alternatives:
                yield from terminals(alternative)


def non_terminals(sequence: Sequence) -> Iterator[str]:
    """Give the names used in a sequence, those inside groups included, in the order written."""
    for item in sequence:
        if isinstance(item, NonTerminal):
            yield item.name
        elif isinstance(item, (Repeat, Option)):
            for alternative in item.alternatives:
                yield from non_terminals(alternative)


def least_depth(sequence: Sequence, depths: Mapping[str, int]) -> int:
    """Give the least number of levels that a sequence needs below it.

    Groups in braces and brackets can be left out, and so count for nothing.

    Parameters
    ----------
    sequence
        The items of a production.
    depths
        The least depth of each non-terminal, as :func:`least_depths` gives it.

    Returns
    -------
    int
        0 where no non-terminal has to be expanded.
    """
    return max((depths[item.name] for item in sequence if isinstance(item, NonTerminal)), default=0)


def least_depths(rules: Mapping[str, Alternatives]) -> dict[str, int]:
    """Give for each non-terminal the height of its lowest derivation tree.

    Parameters
    ----------
    rules
        The productions; every name used in them must be a key.

    Returns
    -------
    dict of str to int
        1 where a production without mandatory non-terminals exists, :data:`ENDLESS` where none ever ends.
    """
    depths = dict.fromkeys(rules, ENDLESS)
    changed = True
    while changed:
        changed = False
        for name, alternatives in rules.items():
            depth = min(ENDLESS, 1 + min(least_depth(sequence, depths) for sequence in alternatives))
            if depth < depths[name]:
                depths[name] = depth
                changed = True
    return depths


def shortest(alternatives: Alternatives, depths: Mapping[str, int]) -> tuple[int, ...]:
    """Choose the alternatives that are left when the derivation tree may grow no deeper.

    Those without non-terminals (Hemberg 2006, section 5.1, ``max_depth``); where there are none, those of least
    possible depth.

    Returns
    -------
    tuple of int
        Positions among the alternatives, ascending; never empty.
    """
    plain = tuple(i for i, sequence in enumerate(alternatives) if next(non_terminals(sequence), None) is None)
    if plain:
        return plain
    least = min(least_depth(sequence, depths) for sequence in alternatives)
    return tuple(i for i, sequence in enumerate(alternatives) if least_depth(sequence, depths) == least)
