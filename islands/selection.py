"""Choosing among individuals: who breeds and who survives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from islands.individual import Individual, merit

G = TypeVar("G")


def ranked(deme: Sequence[Individual[G]], promoted: Sequence[int] = ()) -> list[Individual[G]]:
    """Sort a deme, the best first; the invalid stand last, equals by the lower id.

    Members that are ``promoted``, by their ids, stand before all others, in the order of these ids.
    """
    if not promoted:
        return sorted(deme, key=merit)
    return sorted(deme, key=lambda member: (standing(member.id, promoted), *merit(member)))


def standing(identity: int, promoted: Sequence[int]) -> int:
    """Give a member's place among those promoted; of any other the place after them all."""
    return promoted.index(identity) if identity in promoted else len(promoted)


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
