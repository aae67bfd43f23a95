"""Whose place an immigrant takes. Each chooser takes the ranked residents, the worst last, and gives a place."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from islands.individual import Individual

Replacer = Callable[[int, np.random.Generator], int]
"""From the number of residents (at least 1) and a stream to a place in their ranking."""


def worst(residents: int, rng: np.random.Generator) -> int:
    """Take the place of the worst resident."""
    del rng
    return residents - 1


def random(residents: int, rng: np.random.Generator) -> int:
    """Take the place of any resident, each as likely."""
    return int(rng.integers(0, residents))


REPLACERS: Final[Mapping[str, Replacer]] = {"worst": worst, "random": random}


def beats(newcomer: Individual[Any], resident: Individual[Any]) -> bool:
    """Tell whether a newcomer is strictly better: valid against invalid, or of higher fitness."""
    if newcomer.fitness is None:
        return False
    return resident.fitness is None or newcomer.fitness > resident.fitness
