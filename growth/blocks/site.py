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

    def capacity(self, lattice: Lattice) -> int | None:
        """Count the cells that the site holds, solids aside; ``None`` where they have no end or are too many.

        An outline that holds no centre of a cell has none on any storey.
        """
        if self.outline is None:
            return None
        points = np.array(self.outline.points)
        low, high = np.floor(points.min(axis=0)), np.ceil(points.max(axis=0))
        if np.prod(high - low + 1) > MOST_LOOKED_AT:
            return None
        x, y = np.meshgrid(*(np.arange(a, b + 1) for a, b in zip(low, high, strict=True)), indexing="ij")
        centres = np.stack([x.reshape(-1), y.reshape(-1)], axis=1)
        centres = centres[self.outline.holds(centres)]
        if self.levels is None:
            return None if len(centres) else 0
        floors = 1 if lattice.name == "square" else self.levels[1] - self.levels[0] + 1
        if not lattice.parity:
            return len(centres) * floors
        odd = int(((centres.sum(axis=1) + self.levels[0]) % 2).sum())
        return (len(centres) - odd) * ((floors + 1) // 2) + odd * (floors // 2)


def site_of(settings: OutlineSettings, level: int, environment: Environment) -> Site:
    """Make a site whose storeys begin at a level."""
    levels = None if settings.floors is None else (level, level + settings.floors - 1)
    return Site(settings.outline, levels, environment)
