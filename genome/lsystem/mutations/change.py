"""Another symbol."""

from __future__ import annotations

import numpy as np

from genome.lsystem.places import part, replaced, trunk_and_branches
from genome.lsystem.settings import LSystemGenome
from genome.lsystem.word import Word


def change(word: Word, rng: np.random.Generator, settings: LSystemGenome) -> Word:
    """Make one symbol, each as likely, another of the settings' symbols, each as likely."""
    places = [
        (path, at)
        for path in trunk_and_branches(word)
        for at, item in enumerate(part(word, path).items)
        if isinstance(item, str)
    ]
    path, at = places[int(rng.integers(len(places)))]
    items = part(word, path).items
    others = [symbol for symbol in settings.symbols if symbol != items[at]]
    if not others:
        return word
    new = others[int(rng.integers(len(others)))]
    return replaced(word, path, Word((*items[:at], new, *items[at + 1 :])))
