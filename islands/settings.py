"""Settings of an island's algorithm: the ``algorithm:`` section of an island."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from genome.settings import Settings

Probability = Annotated[float, Field(ge=0, le=1)]


class Algorithm(Settings):
    """How a deme turns one generation into the next.

    Attributes
    ----------
    name
        ``generational``: all but the elite are replaced by offspring.
    elite
        How many of the best live on as they are.
    selection
        ``tournament``: a parent is the best of ``tournament`` members drawn with replacement.
    tournament
        Entrants of a tournament; 1 selects at random.
    crossover
        Probability that a pair of offspring is crossed.
    mutation
        Probability that an offspring is mutated; one that was not crossed is mutated in any case.
    """

    name: Literal["generational"] = "generational"
    elite: Annotated[int, Field(ge=0)] = 1
    selection: Literal["tournament"] = "tournament"
    tournament: Annotated[int, Field(ge=1, le=1_000_000)] = 3
    crossover: Probability = 0.8
    mutation: Probability = 0.1
