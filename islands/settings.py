"""Settings of an island's algorithm: the ``algorithm:`` section of an island."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from genome.errors import InputError
from genome.settings import Settings

Probability = Annotated[float, Field(ge=0, le=1)]


class Algorithm(Settings):
    """How a deme turns one generation into the next.

    Attributes
    ----------
    name
        ``generational``: all but the elite are replaced by offspring. ``plus``: the best of parents and offspring
        together live on, of equals the younger (mu + lambda).
    elite
        Of ``generational`` alone: how many of the best live on as they are.
    elitism
        Of ``generational`` alone. ``keep``: the elite live on in any case. ``restore``: offspring fill the deme, and
        one of the elite takes the place of the worst of them only where it is better than all of them.
    offspring
        Of ``plus`` alone: how many are bred in a generation; as many as the population without.
    selection
        ``tournament``: a parent is the best of ``tournament`` members drawn with replacement.
    tournament
        Entrants of a tournament; 1 selects at random.
    crossover
        Probability that a pair of offspring is crossed.
    mutation
        Probability that an offspring is mutated; one that was not crossed is mutated in any case.
    """

    name: Literal["generational", "plus"] = "generational"
    elite: Annotated[int, Field(ge=0)] = 1
    elitism: Literal["keep", "restore"] = "keep"
    offspring: Annotated[int, Field(ge=1)] | None = None
    selection: Literal["tournament"] = "tournament"
    tournament: Annotated[int, Field(ge=1, le=1_000_000)] = 3
    crossover: Probability = 0.8
    mutation: Probability = 0.1

    @model_validator(mode="after")
    def _offspring_are_of_plus(self) -> Self:
        if self.name != "plus" and self.offspring is not None:
            expected = f"no offspring with the algorithm '{self.name}'"
            raise InputError("", expected, f"{self.offspring}", "did you mean name: plus?")
        return self
