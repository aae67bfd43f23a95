"""How different the L-systems of a deme are."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence

import numpy as np

from genome.lsystem.system import LSystem


def system_diversity(systems: Sequence[LSystem]) -> float | None:
    """Give the mean distance over all pairs of L-systems.

    The distance of two compares how their words are made: which share of all neighbouring characters, brackets and
    ends of words included, each pair of characters has in them. It is half the sum of the differences of these shares:
    0 where they are the same, 1 where the two have no pair of characters in common. Rules count by operand;
    iterations, seeds and chances do not count.

    Parameters
    ----------
    systems
        A deme's genotypes.

    Returns
    -------
    The mean; ``None`` for fewer than two.
    """
    count = len(systems)
    if count < 2:
        return None
    tallies = [_pairs(system) for system in systems]
    known = {pair: column for column, pair in enumerate(dict.fromkeys(itertools.chain.from_iterable(tallies)))}
    table = np.zeros((count, len(known)))
    for row, tally in zip(table, tallies, strict=True):
        row[[known[pair] for pair in tally]] = list(tally.values())
    shares = np.sort(table / table.sum(axis=1, keepdims=True), axis=0)
    # Of sorted values, the k-th is added k times and taken away count - 1 - k times in the sum over all pairs.
    weights = 2.0 * np.arange(count) - (count - 1)
    total = float((weights[:, None] * shares).sum())
    return min(max(0.5 * total / (count * (count - 1) / 2), 0.0), 1.0)


def _pairs(system: LSystem) -> Counter[tuple[str, str]]:
    """Count neighbouring characters of all words, marked with the operand whose successor they stand in."""
    tally: Counter[tuple[str, str]] = Counter()
    for mark, word in [("", system.axiom), *((rule.operand, rule.successor) for rule in system.rules)]:
        text = f".{word}."
        tally.update((mark, a + b) for a, b in itertools.pairwise(text))
    return tally
