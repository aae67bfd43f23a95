"""What an island is to be, as plain data that can travel to its host."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from islands.settings import Algorithm


@dataclass(frozen=True, slots=True)
class IslandSpec:
    """One island of a run.

    Attributes
    ----------
    name
        Unique in the run: the group's name, with ``-0``, ``-1``, ... where the group counts several islands.
    group
        The key under ``islands:`` in the experiment.
    number
        Place in the experiment's order, from 0; the upper part of its individuals' ids.
    species
        Islands of one species may exchange migrants.
    kind
        The island kind, as the experiment names it.
    population
        Members of the deme.
    genome, growth, fitness
        Settings of the kind, plain data with every default written out.
    algorithm
        How the deme breeds.
    source
        The experiment's file name, for messages.
    base
        The folder that file names in the settings are relative to.
    since, until
        It begins in the epoch ``since``, and steps in epochs before ``until``; in all of them without one.
    epochs
        It breeds in so many epochs from its first population on, then rests; in all without.
    """

    name: str
    group: str
    number: int
    species: str
    kind: str
    population: int
    genome: Mapping[str, Any]
    growth: Mapping[str, Any]
    fitness: Mapping[str, Any]
    algorithm: Algorithm
    source: str
    base: str
    since: int = 0
    until: int | None = None
    epochs: int | None = None

    def is_there(self, epoch: int) -> bool:
        """Tell whether it steps in an epoch."""
        return self.since <= epoch and (self.until is None or epoch < self.until)

    def where(self, *keys: str) -> str:
        """Give the place of a key of this island for an error message."""
        return f"{self.source}: {'.'.join(('islands', self.group, *keys))}"
