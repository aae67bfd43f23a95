"""A branch from its end."""

from __future__ import annotations

import numpy as np

from genome.lsystem.places import branches, part, replaced
from genome.lsystem.settings import LSystemGenome
from genome.lsystem.word import Word


def invert(word: Word, rng: np.random.Generator, settings: LSystemGenome) -> Word:
    """Turn the order of a random branch's own items round; of a word without branches, that of the trunk."""
    del settings
    paths = branches(word) or [()]
    path = paths[int(rng.integers(len(paths)))]
    return replaced(word, path, Word(part(word, path).items[::-1]))
