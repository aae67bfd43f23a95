"""Choosing among individuals: who breeds and who survives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from islands.individual import Individual, merit

G = TypeVar("G")


def ranked(deme: Sequence[Individual[G]]) -> list[Individual[G]]:
    """Sort a deme, the best first; the invalid stand last, equals by the lower id."""
    return sorted(deme, key=merit)


def tournaments(size: int, entrants: int, rounds: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Hold tournaments over a ranked deme.

    Parameters
    ----------
    size
        Members of the deme; member 0 is the best.
    entrants
        How many are drawn, with replacement, for each tournament.
    rounds
        How many tournaments.
    rng
        The stream.

    Returns
    -------
    (rounds,) int64, the place of each winner in the ranking.
    """
    winners: NDArray[np.int64] = rng.integers(0, size, size=(rounds, entrants)).min(axis=1)
    return winners
