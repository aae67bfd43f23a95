"""What an algorithm decides, and the algorithms by name. A new one is one file here and one line of ``SCHEMES``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, Protocol, TypeVar

from islands.algorithms.generational import Generational
from islands.algorithms.parents import Parents
from islands.algorithms.plus import Plus
from islands.individual import Individual
from islands.settings import Algorithm

G = TypeVar("G")


class Scheme(Protocol):
    """One algorithm; it holds nothing, and draws nothing."""

    def offspring(self, settings: Algorithm, population: int, members: int) -> int:
        """Give how many are bred by a deme of so many members that is to have ``population``."""
        ...

    def breeders(self, settings: Algorithm, population: int, order: Sequence[Individual[G]]) -> Sequence[Individual[G]]:
        """Give those of a ranked deme who may be parents, best first; at least one of a deme of any."""
        ...

    def survivors(
        self,
        settings: Algorithm,
        population: int,
        order: Sequence[Individual[Any]],
        children: Sequence[Individual[Any]],
        promoted: Sequence[int] = (),
    ) -> tuple[Individual[Any], ...]:
        """Give the next deme.

        Parameters
        ----------
        settings, population
            As above.
        order
            The deme, best first.
        children
            Its offspring, in the order of their births.
        promoted
            Ids of members that stand at the head of ``order`` whatever their fitness; they beat everyone.
        """
        ...


SCHEMES: Final[Mapping[str, Scheme]] = {"generational": Generational(), "plus": Plus(), "parents": Parents()}
