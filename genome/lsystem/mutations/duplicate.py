"""A branch twice."""

from __future__ import annotations

import numpy as np

from genome.lsystem.places import branches, part, stretch, with_branch
from genome.lsystem.settings import LSystemGenome
from genome.lsystem.word import Word


def duplicate(word: Word, rng: np.random.Generator, settings: LSystemGenome) -> Word:
    """Copy a random branch to a random place, its own inside too; of a word without branches, a stretch as a branch."""
    del settings
    paths = branches(word)
    if paths:
        return with_branch(word, part(word, paths[int(rng.integers(len(paths)))]), rng)
    start, end = stretch(word, rng)
    return with_branch(word, Word(word.items[start:end]), rng)
