"""What a topology is given, and what it gives."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Protocol, runtime_checkable

from genome.errors import InputError
from islands.kinds.protocol import Keep

Pairs = list[tuple[int, int]]
"""Edges as places of source and target, from 0."""


class Link(NamedTuple):
    """One directed edge between two places.

    Attributes
    ----------
    source, target
        Places among the members, from 0.
    weight
        The probability that it carries; ``None`` for the channel's.
    """

    source: int
    target: int
    weight: float | None = None


@dataclass(frozen=True, slots=True)
class Ground:
    """What a topology is laid out on.

    Attributes
    ----------
    names
        The islands' names, in the order of their places.
    base
        The folder that file names are relative to.
    seed
        The run's seed.
    channel
        The channel's number.
    reach
        Whether a graph drawn at random is drawn again until every island is reached.
    """

    names: tuple[str, ...]
    base: Path = Path()
    seed: int = 0
    channel: int = 0
    reach: bool = True

    @property
    def count(self) -> int:
        """How many islands there are."""
        return len(self.names)


@runtime_checkable
class Topology(Protocol):
    """A topology with parameters: a settings model of them that can lay its edges.

    An error that names no place is about the topology as a whole; one that names a key is about that parameter.
    """

    def links(self, ground: Ground) -> list[Link]:
        """Give the edges, in any order.

        Raises
        ------
        InputError
            When it does not fit the islands.
        """
        ...


@runtime_checkable
class FromFile(Protocol):
    """A topology that reads a file."""

    def kept(self, base: Path, keep: Keep) -> Mapping[str, object]:
        """Keep the file with the run; give the parameters with the copy's name in place of its own."""
        ...


def both_ways(pairs: Iterable[tuple[int, int]]) -> Pairs:
    """Give each pair of places in both directions, each direction once, ascending."""
    return sorted({way for source, target in pairs for way in ((source, target), (target, source))})


def as_links(pairs: Iterable[tuple[int, int]]) -> list[Link]:
    """Give pairs as links of the channel's weight."""
    return [Link(source, target) for source, target in pairs]


def misfit(expected: str, got: int, remedy: str = "") -> InputError:
    """Give the error of a topology that does not fit the number of islands; the caller adds the place."""
    return InputError("", f"{expected} islands", str(got), remedy)


def located(error: InputError, where: str) -> InputError:
    """Give an error of a topology its place: that of the topology, and the key where it names one."""
    place = f"{where}.{error.where}" if error.where else where
    return InputError(place, error.expected, error.got, error.remedy)


Parameters = Mapping[str, object]
"""A topology's parameters as the experiment gives them."""
