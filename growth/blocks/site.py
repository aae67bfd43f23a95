"""Where cells may be placed: within an outline of some storeys, and outside whatever is solid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final, final

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field

from genome.settings import Settings
from growth.blocks.lattice import Ints, Lattice
from growth.environment import Environment
from growth.outline import Outline, as_outline

Flags = NDArray[np.bool_]

MOST_LOOKED_AT: Final = 2**22
"""Places of an outline's box that are looked at to see whether it holds a cell."""


class OutlineSettings(Settings):
    """A site's outline, seen from above.

    Attributes
    ----------
    outline
        Corners of a polygon that does not cross or touch itself, in either sense; cells whose centre lies in it or on
        its edge are of the site. Without it the site has no edge.
    floors
        How many storeys of cells it has, from the level of the start upwards; without it there is no lowest or highest.
    """

    outline: Annotated[Outline | None, BeforeValidator(as_outline)] = None
    floors: Annotated[int, Field(ge=1, le=1_000_000)] | None = None


@final
@dataclass(frozen=True, slots=True, eq=False)
class Site:
    """Where cells may be placed.

    Attributes
    ----------
    outline
        A polygon, or None without one.
    levels
        The lowest and the highest z of cells, or None.
    environment
        Its hard boundaries take the cells whose centre lies in them; nothing else of it counts.
    """

    outline: Outline | None
    levels: tuple[int, int] | None
    environment: Environment

    def holds(self, cells: Ints) -> Flags:
        """Say of each of (n, 3) cells whether it may be placed."""
        held = np.ones(len(cells), dtype=np.bool_)
        if self.levels is not None:
            held &= (cells[:, 2] >= self.levels[0]) & (cells[:, 2] <= self.levels[1])
        if self.outline is not None:
            held &= self.outline.holds(cells[:, :2].astype(np.float64))
        if self.environment.has_hard:
            held[held] &= ~self.environment.inside(cells[held])
        return held

    def has_room(self, lattice: Lattice, level: int) -> bool:
        """Tell whether the outline holds any cell of a level; an outline too large to look at does."""
        if self.outline is None:
            return True
        points = np.array(self.outline.points)
        low, high = np.floor(points.min(axis=0)), np.ceil(points.max(axis=0))
        if np.prod(high - low + 1) > MOST_LOOKED_AT:
            return True
        x, y = np.meshgrid(*(np.arange(a, b + 1) for a, b in zip(low, high, strict=True)), indexing="ij")
        centres = np.stack([x.reshape(-1), y.reshape(-1)], axis=1)
        held = self.outline.holds(centres)
        floors = 2 if self.levels is None or self.levels[1] > self.levels[0] else 1
        if lattice.parity and floors == 1:
            held &= (centres.sum(axis=1) + level) % 2 == 0
        return bool(held.any())


def site_of(settings: OutlineSettings, level: int, environment: Environment) -> Site:
    """Make a site whose storeys begin at a level."""
    levels = None if settings.floors is None else (level, level + settings.floors - 1)
    return Site(settings.outline, levels, environment)
