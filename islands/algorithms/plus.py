"""The plus algorithm: parents and offspring compete for the places, (mu + lambda); with one of each it is (1+1)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar, final

from islands.individual import Individual
from islands.selection import standing
from islands.settings import Algorithm

G = TypeVar("G")


@final
class Plus:
    """See :class:`islands.algorithms.scheme.Scheme`.

    Of equals the one that came later to this deme stays, and of those that came together the one with the higher id: an
    offspring that is as good as its parent takes its place, as in the (1+1) EA (Droste, Jansen and Wegener 2002).
    """

    __slots__ = ()

    def offspring(self, settings: Algorithm, population: int, members: int) -> int:
        """Give ``offspring``, the population without; never fewer than a deme lacks."""
        return max(settings.offspring or population, population - members)

    def breeders(self, settings: Algorithm, population: int, order: Sequence[Individual[G]]) -> Sequence[Individual[G]]:
        """Give all."""
        del settings, population
        return order

    def survivors(
        self,
        settings: Algorithm,
        population: int,
        order: Sequence[Individual[G]],
        children: Sequence[Individual[G]],
        promoted: Sequence[int] = (),
    ) -> tuple[Individual[G], ...]:
        """Give the best of all, best first."""
        del settings
        everyone = (*order, *children)
        if not promoted:
            return tuple(sorted(everyone, key=_youth)[:population])
        return tuple(sorted(everyone, key=lambda one: (standing(one.id, promoted), *_youth(one)))[:population])


def _youth(member: Individual[Any]) -> tuple[float, int, int]:
    worth = float("inf") if member.fitness is None else -member.fitness
    return (worth, -member.since, -member.id)
