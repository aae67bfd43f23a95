"""Places in a word: spans that hold whole branches, so that brackets balance whatever is exchanged."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from genome.timed.system import CLOSE, OPEN, Birth

Word = tuple[Birth, ...]
Span = tuple[int, int]
"""First place, and the place behind the last."""

LONGEST = 4
"""How many modules and branches side by side a random span holds at most."""


def levels(word: Sequence[Birth]) -> list[list[Span]]:
    """Give the modules and branches that stand side by side: on the trunk, then inside each bracket, as it opens."""
    trunk: list[Span] = []
    found = [trunk]
    open_at: list[int] = []
    inside = [trunk]
    for place, birth in enumerate(word):
        if birth.symbol == OPEN:
            open_at.append(place)
            inside.append([])
            found.append(inside[-1])
        elif birth.symbol == CLOSE:
            inside.pop()
            inside[-1].append((open_at.pop(), place + 1))
        else:
            inside[-1].append((place, place + 1))
    return found


def depth(word: Sequence[Birth]) -> int:
    """Give how many branches stand inside each other at most."""
    most = now = 0
    for birth in word:
        now += (birth.symbol == OPEN) - (birth.symbol == CLOSE)
        most = max(most, now)
    return most


def any_span(word: Sequence[Birth], rng: np.random.Generator) -> Span | None:
    """Draw a level that is not empty, each as likely, and modules or branches side by side on it.

    Returns
    -------
    Span or None
        ``None`` for a word without modules.
    """
    full = [level for level in levels(word) if level]
    if not full:
        return None
    level = full[int(rng.integers(len(full)))]
    first = int(rng.integers(len(level)))
    count = int(rng.integers(1, min(LONGEST, len(level) - first) + 1))
    return level[first][0], level[first + count - 1][1]


def any_place(word: Sequence[Birth], rng: np.random.Generator) -> int:
    """Draw a place before a module, or behind the last; what is whole may be put at any of them."""
    return int(rng.integers(len(word) + 1))


def put(word: Word, span: Span, new: Word) -> Word:
    """Put a word in the place of a span."""
    return word[: span[0]] + new + word[span[1] :]
