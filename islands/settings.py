"""Settings of an island's algorithm: the ``algorithm:`` section of an island."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from genome.errors import InputError
from genome.settings import Settings

Probability = Annotated[float, Field(ge=0, le=1)]

OF_ALGORITHM: Final[Mapping[str, str]] = {"offspring": "plus", "parents": "parents", "longest_life": "parents"}
"""Keys that one algorithm alone takes."""


class Algorithm(Settings):
    """How a deme turns one generation into the next.

    Attributes
    ----------
    name
        ``generational``: all but the elite are replaced by offspring. ``plus``: the best of parents and offspring
        together live on, of equals the younger (mu + lambda). ``parents``: the best of the old parents and of the
        offspring are the parents of the next generation, and nobody else breeds (Senatore 2009, 'Selection: an elitist
        approach').
    elite
        Of ``generational`` alone: how many of the best live on as they are.
    elitism
        Of ``generational`` alone. ``keep``: the elite live on in any case. ``restore``: offspring fill the deme, and
        one of the elite takes the place of the worst of them only where it is better than all of them.
    offspring
        Of ``plus`` alone: how many are bred in a generation; as many as the population without.
    parents
        Of ``parents`` alone: how many breed; a quarter of the population without, at least one.
    longest_life
        Of ``parents`` alone: after so many generations as a parent one is dropped, however good; never without.
    selection
        Among the deme, with ``parents`` among the parents. ``tournament``: the best of ``tournament`` members drawn
        with replacement. ``roulette``: each as likely as its fitness above the worst valid one's is large.
        ``uniform``: each as likely as any other.
    tournament
        Entrants of a tournament; 1 selects at random.
    crossover
        Probability that a pair of offspring is crossed.
    mutation
        Probability that an offspring is mutated; one that was not crossed is mutated in any case.
    sharing
        By what those who breed and survive are chosen: ``none``, by their fitness; ``competitive``, by what they take
        of the partners that the deme was scored with (:mod:`islands.sharing`).
    restart
        After so many generations a new run begins from a fresh random population, which takes the place of a
        generation; never without (Rosenman 1997, section 4, prefers it to mutation).
    restart_keep
        How many of the best different members stay in it.
    """

    name: Literal["generational", "plus", "parents"] = "generational"
    elite: Annotated[int, Field(ge=0)] = 1
    elitism: Literal["keep", "restore"] = "keep"
    offspring: Annotated[int, Field(ge=1)] | None = None
    parents: Annotated[int, Field(ge=1)] | None = None
    longest_life: Annotated[int, Field(ge=1)] | None = None
    selection: Literal["tournament", "roulette", "uniform"] = "tournament"
    tournament: Annotated[int, Field(ge=1, le=1_000_000)] = 3
    crossover: Probability = 0.8
    mutation: Probability = 0.1
    sharing: Literal["none", "competitive"] = "none"
    restart: Annotated[int, Field(ge=1)] | None = None
    restart_keep: Annotated[int, Field(ge=0)] = 0

    @model_validator(mode="after")
    def _keys_are_of_their_algorithm(self) -> Self:
        for key, name in OF_ALGORITHM.items():
            if self.name != name and getattr(self, key) is not None:
                expected = f"no {key} with the algorithm '{self.name}'"
                raise InputError("", expected, f"{getattr(self, key)}", f"did you mean name: {name}?")
        return self

    def breeders(self, population: int) -> int:
        """Give how many parents the algorithm ``parents`` keeps."""
        return min(population, self.parents or max(1, population // 4))
