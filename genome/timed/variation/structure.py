"""What of a system is structure: its productions but for their numbers; and how different systems are."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from genome.timed.expression import DRAWS, Call, parts
from genome.timed.genotype import TimedGenotype
from genome.timed.system import Production, TimedSystem
from genome.timed.variation.places import literals, with_literals
from genome.timed.writing import written_define, written_production


def bare_productions(system: TimedSystem) -> tuple[Production, ...]:
    """Give the productions with 1 in the place of every number, in order."""
    return with_literals(system, _any, lambda _, __: 1.0).productions


def differs_in_production(first: TimedGenotype, second: TimedGenotype) -> bool:
    """Tell whether two differ in a production, and not only in numbers, axioms, defines or seeds."""
    return bare_productions(first.system) != bare_productions(second.system)


def stochastic(system: TimedSystem) -> bool:
    """Tell whether anything in a system, or in those inside it, is drawn at random: then its seed matters."""
    if any(stochastic(inner) for inner in system.systems):
        return True
    births = [*system.axiom, *itertools.chain.from_iterable(one.successor for one in system.productions)]
    found = [one for birth in births for one in (*birth.arguments, birth.age)]
    found += [one.body for one in system.developments]
    for production in system.productions:
        if production.chance is not None:
            return True
        found += [production.end, *([] if production.condition is None else [production.condition])]
    return any(isinstance(part, Call) and part.function in DRAWS for one in found for part in parts(one))


def distances(genotypes: Sequence[TimedGenotype]) -> NDArray[np.float64]:
    """Give how different each two are, (n, n) float64, from 0 to 1.

    The mean of two shares: of productions that only one of the two has, among those of both (numbers not looked at,
    several alike counted as often); and of numbers, by place, and defines that only one has, among those of both. Seeds
    do not count.
    """
    structures = [Counter(map(written_production, bare_productions(one.system))) for one in genotypes]
    numbers = [_numbers(one.system) for one in genotypes]
    found = np.zeros((len(genotypes), len(genotypes)))
    for tallies in (structures, numbers):
        found += 0.5 * _apart(tallies)
    return found


def diversity(genotypes: Sequence[TimedGenotype]) -> float | None:
    """Give the mean of :func:`distances` over all pairs; ``None`` for fewer than two."""
    count = len(genotypes)
    if count < 2:
        return None
    return min(max(float(distances(genotypes).sum()) / (count * (count - 1)), 0.0), 1.0)


def _apart(tallies: Sequence[Counter[str]]) -> NDArray[np.float64]:
    """Give the share of what two tallies do not have in common."""
    known = {word: column for column, word in enumerate(dict.fromkeys(itertools.chain.from_iterable(tallies)))}
    table = np.zeros((len(tallies), max(1, len(known))))
    for row, tally in zip(table, tallies, strict=True):
        row[[known[word] for word in tally]] = list(tally.values())
    apart = np.abs(table[:, None] - table[None]).sum(axis=2)
    whole = table.sum(axis=1)
    return np.asarray(apart / np.maximum(whole[:, None] + whole[None], 1.0))


def _numbers(system: TimedSystem) -> Counter[str]:
    tally = Counter(map(written_define, system.defines))
    tally.update(f"{role} {value}" for role, value in literals(system, _any))
    return tally


def _any(symbol: str) -> bool:
    del symbol
    return True


def with_productions(system: TimedSystem, at: int, new: tuple[Production, ...]) -> TimedSystem:
    """Give a system with others in the place of one production."""
    return replace(system, productions=(*system.productions[:at], *new, *system.productions[at + 1 :]))
