"""A branch less."""

from __future__ import annotations

import numpy as np

from genome.lsystem.places import branches, part, replaced, stretch
from genome.lsystem.settings import LSystemGenome
from genome.lsystem.word import Branch, Word


def delete(word: Word, rng: np.random.Generator, settings: LSystemGenome) -> Word:
    """Take away a random branch; where it bears branches, every other time one of them takes its place.

    Of a word without branches a stretch goes; the last item stays.
    """
    del settings
    paths = branches(word)
    if not paths:
        if len(word.items) < 2:
            return word
        start, end = stretch(word, rng)
        return Word(word.items[:start] + word.items[end:])
    path = paths[int(rng.integers(len(paths)))]
    borne = [one for item in part(word, path).items if isinstance(item, Branch) for one in item.siblings]
    heir = borne[int(rng.integers(len(borne)))] if borne and rng.random() < 0.5 else Word()
    return replaced(word, path, heir)
