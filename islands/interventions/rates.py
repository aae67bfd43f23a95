"""``rate``: other rates of an island's algorithm, from that epoch on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from genome.errors import InputError
from genome.settings import near, validated
from islands.interventions.intervention import Arguments, Subject
from islands.settings import Algorithm

RATES: Final = ("crossover", "elite", "longest_life", "mutation", "offspring", "parents", "tournament")
"""Settings that may change while an island evolves; which algorithm it is stays."""


def changed(algorithm: Algorithm, population: int, values: Mapping[str, float], where: str) -> dict[str, float]:
    """Give the new rates as the algorithm takes them.

    Parameters
    ----------
    algorithm
        As it is.
    population
        Of the island.
    values
        The new rates, by name.
    where
        The place, for messages.

    Raises
    ------
    InputError
        For a rate that there is not, that the algorithm does not have, or that is out of its bounds.
    """
    for name in values:
        if name not in RATES:
            raise InputError(where, "a rate of the algorithm", f"'{name}'", near(name, list(RATES)))
    if "elite" in values and algorithm.name != "generational":
        raise InputError(f"{where} elite", f"no elite with the algorithm '{algorithm.name}'", str(values["elite"]))
    made = validated(Algorithm, {**algorithm.model_dump(), **values}, where)
    if "elite" in values and made.elitism == "keep" and made.elite >= population:
        raise InputError(f"{where} elite", f"less than the population of {population}", str(made.elite))
    if made.parents is not None and made.parents > population:
        raise InputError(f"{where} parents", f"at most the population of {population}", str(made.parents))
    return {name: getattr(made, name) for name in values}


def rate(subject: Subject[Any], arguments: Arguments) -> Subject[Any]:
    """Change rates: ``{"values": {name: rate}}``."""
    spec, steered = subject.spec, subject.steered
    rates = changed(steered.spec(spec).algorithm, spec.population, arguments["values"], "rate")
    return subject._replace(steered=steered.with_rates(rates))
