"""Elitism as in Senatore 2009, 'Selection: an elitist approach': a few parents, kept until beaten or too old."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar, final

from islands.individual import Individual
from islands.selection import standing
from islands.settings import Algorithm

G = TypeVar("G")


@final
class Parents:
    """See :class:`islands.algorithms.scheme.Scheme`.

    The parents are the best of the deme, and they alone breed, as many offspring as the population counts. The best of
    them and of their offspring are the next parents; the best of the other offspring fill the deme. A parent stays
    until a better one comes, so of equals it is the parent who stays; one who is invalid is a parent for want of valid
    ones alone, and gives way to any offspring, so that a search without a valid form goes on. After ``longest_life``
    generations as a parent one is dropped, and those after it move up. An immigrant's life begins where it arrives.
    """

    __slots__ = ()

    def offspring(self, settings: Algorithm, population: int, members: int) -> int:
        """Give the population: a generation is made whole, and the parents compete with it."""
        del settings, members
        return population

    def breeders(self, settings: Algorithm, population: int, order: Sequence[Individual[G]]) -> Sequence[Individual[G]]:
        """Give the parents: the best of the deme."""
        return order[: settings.breeders(population)]

    def survivors(
        self,
        settings: Algorithm,
        population: int,
        order: Sequence[Individual[G]],
        children: Sequence[Individual[G]],
        promoted: Sequence[int] = (),
    ) -> tuple[Individual[G], ...]:
        """Put the parents before the offspring that are none, both best first."""
        count = settings.breeders(population)
        now = children[0].since
        old = [one for one in order[:count] if settings.longest_life is None or now - one.since < settings.longest_life]
        valid = [one for one in old if one.fitness is not None or one.id in promoted]
        invalid = [one for one in old if one.fitness is None and one.id not in promoted]
        # The sort is stable: of equals those who stand first here stay first.
        pool = sorted([*valid, *children, *invalid], key=lambda one: (standing(one.id, promoted), _worth(one)))
        parents = tuple(pool[:count])
        born = {one.id for one in children}
        rest = [one for one in pool[count:] if one.id in born]
        return (*parents, *rest[: population - len(parents)])


def _worth(member: Individual[Any]) -> float:
    return float("inf") if member.fitness is None else -member.fitness
