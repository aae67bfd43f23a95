"""Choosing among individuals: who breeds and who survives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from islands.individual import Individual, merit
from islands.kinds.protocol import Biology

G = TypeVar("G")


def ranked(deme: Sequence[Individual[G]], promoted: Sequence[int] = ()) -> list[Individual[G]]:
    """Sort a deme, the best first; the invalid stand last, equals by the lower id.

    Members that are ``promoted``, by their ids, stand before all others, in the order of these ids.
    """
    if not promoted:
        return sorted(deme, key=merit)
    return sorted(deme, key=lambda member: (standing(member.id, promoted), *merit(member)))


def different(order: Sequence[Individual[G]], count: int, biology: Biology[G]) -> list[Individual[G]]:
    """Give the first valid ones of a ranked deme that are of different forms; fewer where there are no more.

    Members whose scores are equal to the last bit count as one form, since different genotypes may grow into one. Of a
    kind without scores genotypes are compared.
    """
    forms: dict[object, Individual[G]] = {}
    for member in order:
        if len(forms) == count:
            break
        if member.fitness is not None:
            forms.setdefault(member.scores or biology.encode(member.genotype), member)
    return list(forms.values())


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


def roulettes(order: Sequence[Individual[G]], rounds: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Spin a roulette wheel over a ranked deme: each member as likely as its weight says (Goldberg 1989).

    A member weighs what its fitness is above the worst valid one's, so that fitness may be negative; the worst and the
    invalid weigh nothing. Where all are alike the valid are as likely as each other, and where none is valid all are.
    Who is promoted stands before better members, and weighs as much as the best of them.

    Parameters
    ----------
    order
        The deme, best first; at least one member.
    rounds
        How many are drawn, with replacement.
    rng
        The stream; one number a round.

    Returns
    -------
    (rounds,) int64, the places of those drawn.
    """
    shares = np.cumsum(_weights(order))
    drawn = np.searchsorted(shares, rng.random(rounds) * shares[-1], side="right")
    # The last share that is not empty ends the wheel, whatever was rounded.
    places: NDArray[np.int64] = np.minimum(drawn, int(np.searchsorted(shares, shares[-1]))).astype(np.int64)
    return places


def _weights(order: Sequence[Individual[G]]) -> NDArray[np.float64]:
    """Give the weights of a ranked deme, (n,), not all of them 0."""
    # Halved, so that no difference of two finite values is infinite.
    halves = np.array([np.nan if one.fitness is None else one.fitness / 2 for one in order])
    if np.isnan(halves).all():
        return np.ones(len(order))
    span = float(np.nanmax(halves) - np.nanmin(halves))
    weights = (halves - np.nanmin(halves)) / span if span > 0 else np.ones(len(order))
    weights[np.isnan(halves)] = 0.0
    rising: NDArray[np.float64] = np.maximum.accumulate(weights[::-1])
    return rising[::-1]


def uniform(size: int, rounds: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Draw among so many members, each as likely as any other, with replacement; (rounds,) int64."""
    places: NDArray[np.int64] = rng.integers(0, size, size=rounds)
    return places
