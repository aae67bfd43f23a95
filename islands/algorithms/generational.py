"""The generational algorithm: offspring take the deme over, but for an elite."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar, final

from islands.individual import Individual, beats
from islands.selection import ranked
from islands.settings import Algorithm

G = TypeVar("G")


@final
class Generational:
    """See :class:`islands.algorithms.scheme.Scheme`.

    With ``elitism: keep`` the elite live on, and offspring fill the rest of the deme. With ``restore`` offspring fill
    all of it; then each of the elite that is better than every offspring takes the place of the worst of them left.
    """

    __slots__ = ()

    def offspring(self, settings: Algorithm, population: int, members: int) -> int:
        """Give the population, less the elite that is kept."""
        return population if settings.elitism == "restore" else population - min(settings.elite, members)

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
        """Put the elite before the offspring, which stay in the order of their births."""
        del population
        elite = order[: settings.elite]
        if settings.elitism == "keep":
            return (*elite, *children)
        standing = ranked(children)
        restored = [member for member in elite if member.id in promoted or beats(member, standing[0])]
        if not restored:
            return tuple(children)
        lost = {child.id for child in standing[-len(restored) :]}
        return (*restored, *(child for child in children if child.id not in lost))
