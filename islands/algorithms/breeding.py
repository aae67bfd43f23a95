"""Making offspring of a ranked deme: selection, crossover pair by pair, mutation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from islands.individual import Individual, Origin
from islands.kinds.protocol import Biology
from islands.selection import roulettes, tournaments, uniform
from islands.settings import Algorithm
from islands.streams import EpochStreams, Purpose

G = TypeVar("G")


class Birth(NamedTuple, Generic[G]):
    """An individual before it is scored: its genotype, its parents' ids, and how it came about."""

    genotype: G
    parents: tuple[int, ...]
    origin: Origin


def breed(
    biology: Biology[G], order: Sequence[Individual[G]], count: int, settings: Algorithm, streams: EpochStreams
) -> list[Birth[G]]:
    """Make offspring, pair by pair; of an odd pair the second is dropped.

    Parameters
    ----------
    biology
        Crosses and mutates.
    order
        Those who may be parents, best first; at least one.
    count
        How many offspring.
    settings
        How parents are selected, rates of crossover and mutation.
    streams
        SELECTION draws the parents, where there is anything to draw; VARIATION all the rest.
    """
    pairs = (count + 1) // 2
    # With one member to choose from nothing would be drawn.
    places = [0] * (2 * pairs)
    if len(order) > 1:
        places = _selected(order, 2 * pairs, settings, streams).tolist()
    change = streams(Purpose.VARIATION)
    draws = change.random(3 * pairs).tolist()
    # The generational algorithm mutates the offspring that it drops, too: what is drawn after it in recorded runs
    # depends on that.
    made = 2 * pairs if settings.name == "generational" else count
    births: list[Birth[G]] = []
    for pair in range(pairs):
        first, second = order[places[2 * pair]], order[places[2 * pair + 1]]
        crossed = draws[pair] < settings.crossover
        genotypes = (first.genotype, second.genotype)
        parents: tuple[tuple[int, ...], tuple[int, ...]] = ((first.id,), (second.id,))
        if crossed:
            genotypes = biology.crossover(*genotypes, change)
            both = (first.id,) if first.id == second.id else (first.id, second.id)
            parents = (both, both)
        for side in range(min(2, made - 2 * pair)):
            mutated = draws[pairs + 2 * pair + side] < settings.mutation or not crossed
            genotype = biology.mutate(genotypes[side], change) if mutated else genotypes[side]
            births.append(Birth(genotype, parents[side], _origin(crossed=crossed, mutated=mutated)))
    return births[:count]


def _selected(
    order: Sequence[Individual[G]], rounds: int, settings: Algorithm, streams: EpochStreams
) -> NDArray[np.int64]:
    """Select parents; give their places."""
    chance = streams(Purpose.SELECTION)
    if settings.selection == "roulette":
        return roulettes(order, rounds, chance)
    if settings.selection == "uniform":
        return uniform(len(order), rounds, chance)
    return tournaments(len(order), settings.tournament, rounds, chance)


def _origin(*, crossed: bool, mutated: bool) -> Origin:
    if not crossed:
        return "mutation"
    return "crossover+mutation" if mutated else "crossover"
