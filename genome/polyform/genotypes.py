"""The values: a room's conjoinings of cells, and an assembly's of parts."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple, final


class Conjoining(NamedTuple):
    """The next cell joins a free edge of the form so far.

    Attributes
    ----------
    vector
        The edge's vector, a place in the tiling's letters.
    edge
        Its number among the form's free edges of this vector, from 0, in the order in which their cells were placed.
    """

    vector: int
    edge: int


class Attachment(NamedTuple):
    """The next part joins a free edge of the form so far with one of its own, of the opposite vector.

    Attributes
    ----------
    vector, edge
        Of the form so far, as of :class:`Conjoining`.
    onto
        The number of the part's edge among its free edges of the opposite vector, from 0.
    """

    vector: int
    edge: int
    onto: int


@final
@dataclass(frozen=True, slots=True)
class Room:
    """A room of n cells.

    Attributes
    ----------
    joins
        n - 1 conjoinings.
    first
        The type of the first cell: of triangles whether it points up (0) or down (1).
    """

    joins: tuple[Conjoining, ...]
    first: int = 0
    _hash: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        # Forms are looked up by their genotypes, and a house's is hundreds of numbers.
        object.__setattr__(self, "_hash", hash((self.first, self.joins)))

    def __hash__(self) -> int:
        """Give the hash of all genes, worked out once."""
        return self._hash

    @property
    def size(self) -> int:
        """How many cells it has."""
        return len(self.joins) + 1


@final
@dataclass(frozen=True, slots=True)
class Part:
    """A part of an assembly, whole, so that the assembly can be regrown by itself.

    Attributes
    ----------
    id
        Of the individual that it is.
    genotype
        Its own.
    """

    id: int
    genotype: Room | Assembly


@final
@dataclass(frozen=True, slots=True)
class Assembly:
    """A zone of rooms, or a house of zones; which part is which room or zone is the population's order.

    Attributes
    ----------
    parts
        p parts, in the order in which they are conjoined.
    joins
        p - 1 attachments.
    """

    parts: tuple[Part, ...]
    joins: tuple[Attachment, ...]
    _hash: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_hash", hash((self.parts, self.joins)))

    def __hash__(self) -> int:
        """Give the hash of all genes, worked out once."""
        return self._hash

    @property
    def size(self) -> int:
        """How many cells it has."""
        return sum(part.genotype.size for part in self.parts)

    def rooms(self) -> tuple[Room, ...]:
        """Give all rooms, in the order in which they are conjoined."""
        found: list[Room] = []
        for part in self.parts:
            one = part.genotype
            found.extend((one,) if isinstance(one, Room) else one.rooms())
        return tuple(found)
