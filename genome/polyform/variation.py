"""Crossover of sequences of conjoinings, at sites where both children can be built (Rosenman 1997, section 3.3.2)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, TypeVar

import numpy as np
from deap import tools

from genome.fence import fenced

T = TypeVar("T")

TRIES: Final = 8
"""Sites that are tried."""


def crossover(
    first: Sequence[T], second: Sequence[T], rng: np.random.Generator, valid: Callable[[tuple[T, ...]], bool]
) -> tuple[tuple[T, ...], tuple[T, ...]]:
    """Cross two sequences of one length at a site.

    Parameters
    ----------
    first, second
        Genes: a room's conjoinings; of an assembly its parts and attachments in turn.
    rng
        Where the sites are drawn from.
    valid
        Tells whether a sequence can be built.

    Returns
    -------
    tuple of two sequences
        Both can be built; after :data:`TRIES` sites at which they cannot, and where there is no site to cut, the
        parents.
    """
    if len(first) < 2:
        return tuple(first), tuple(second)
    with fenced(rng):
        for _ in range(TRIES):
            one, other = tools.cxOnePoint(list(first), list(second))
            if valid(tuple(one)) and valid(tuple(other)):
                return tuple(one), tuple(other)
    return tuple(first), tuple(second)
