"""A new random branch."""

from __future__ import annotations

import numpy as np

from genome.lsystem.initial import random_word
from genome.lsystem.places import with_branch
from genome.lsystem.settings import LSystemGenome
from genome.lsystem.word import Word


def add(word: Word, rng: np.random.Generator, settings: LSystemGenome) -> Word:
    """Grow a random branch, without branches of its own, at a random place."""
    length = int(rng.integers(1, settings.length[1] + 1))
    return with_branch(word, random_word(settings, rng, length, 0, length), rng)
