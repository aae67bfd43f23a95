"""Where cells may be placed: within an outline of some storeys, and outside whatever is solid."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Annotated, Final, final

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field

from genome.errors import InputError
from genome.settings import Settings, describe
from growth.blocks.lattice import Floats, Ints, Lattice
from growth.environment import Environment

Flags = NDArray[np.bool_]
Corner = tuple[float, float]

MOST_LOOKED_AT: Final = 2**22
"""Places of an outline's box that are looked at to see whether it holds a cell."""


def _as_outline(value: object) -> object:
    if value is None:
        return None
    if not isinstance(value, (list, tuple)) or len(value) < 3:
        raise InputError("", "an outline of three corners or more: [[x, y], ...]", describe(value))
    for corner in value:
        if not isinstance(corner, (list, tuple)) or len(corner) != 2 or not all(map(_is_number, corner)):
            raise InputError("", "corners of two finite numbers: [x, y]", describe(corner))
    corners = tuple((float(x), float(y)) for x, y in value)
    check_simple(corners)
    return corners


def _is_number(value: object) -> bool:
    return type(value) in (int, float) and bool(np.isfinite(value))  # type: ignore[call-overload]


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

    outline: Annotated[tuple[Corner, ...] | None, BeforeValidator(_as_outline)] = None
    floors: Annotated[int, Field(ge=1, le=1_000_000)] | None = None


@final
@dataclass(frozen=True, slots=True, eq=False)
class Site:
    """Where cells may be placed.

    Attributes
    ----------
    outline
        (k, 2) float64, or None without one.
    levels
        The lowest and the highest z of cells, or None.
    environment
        Its hard boundaries take the cells whose centre lies in them; nothing else of it counts.
    """

    outline: Floats | None
    levels: tuple[int, int] | None
    environment: Environment

    def holds(self, cells: Ints) -> Flags:
        """Say of each of (n, 3) cells whether it may be placed."""
        held = np.ones(len(cells), dtype=np.bool_)
        if self.levels is not None:
            held &= (cells[:, 2] >= self.levels[0]) & (cells[:, 2] <= self.levels[1])
        if self.outline is not None:
            held &= within(self.outline, cells[:, :2].astype(np.float64))
        if self.environment.has_hard:
            held[held] &= ~self.environment.inside(cells[held])
        return held

    def has_room(self, lattice: Lattice, level: int) -> bool:
        """Tell whether the outline holds any cell of a level; an outline too large to look at does."""
        if self.outline is None:
            return True
        low, high = np.floor(self.outline.min(axis=0)), np.ceil(self.outline.max(axis=0))
        if np.prod(high - low + 1) > MOST_LOOKED_AT:
            return True
        x, y = np.meshgrid(*(np.arange(a, b + 1) for a, b in zip(low, high, strict=True)), indexing="ij")
        centres = np.stack([x.reshape(-1), y.reshape(-1)], axis=1)
        held = within(self.outline, centres)
        floors = 2 if self.levels is None or self.levels[1] > self.levels[0] else 1
        if lattice.parity and floors == 1:
            held &= (centres.sum(axis=1) + level) % 2 == 0
        return bool(held.any())


def site_of(settings: OutlineSettings, level: int, environment: Environment) -> Site:
    """Make a site whose storeys begin at a level."""
    outline = None if settings.outline is None else np.array(settings.outline, dtype=np.float64)
    levels = None if settings.floors is None else (level, level + settings.floors - 1)
    return Site(outline, levels, environment)


def within(outline: Floats, points: Floats) -> Flags:
    """Say of each of (n, 2) points whether it lies in a polygon (k, 2) or on its edge.

    A point is in it where a ray along x crosses its edges an odd number of times.
    """
    inside = np.zeros(len(points), dtype=np.bool_)
    edge = np.zeros(len(points), dtype=np.bool_)
    x, y = points[:, 0], points[:, 1]
    for (ax, ay), (bx, by) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        side = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
        between = (np.minimum(ax, bx) <= x) & (x <= np.maximum(ax, bx))
        between &= (np.minimum(ay, by) <= y) & (y <= np.maximum(ay, by))
        edge |= (side == 0.0) & between
        inside ^= ((ay > y) != (by > y)) & ((side > 0.0) == (by > ay))
    return np.asarray(inside | edge)


def check_simple(corners: tuple[Corner, ...]) -> None:
    """Refuse an outline that crosses or touches itself, or has no area.

    Raises
    ------
    InputError
        Naming the first two sides that meet, counted from 1.
    """
    sides = list(zip(corners, (*corners[1:], corners[0]), strict=True))
    for start, end in sides:
        if start == end:
            raise InputError("", "an outline whose corners differ", f"{list(start)} twice in a row", "remove one")
    count = len(sides)
    for one, other in combinations(range(count), 2):
        if _meet(*sides[one], *sides[other], shared=other - one in (1, count - 1)):
            got = f"one whose sides {one + 1} and {other + 1} meet"
            raise InputError("", "an outline that does not cross or touch itself", got, "list its corners in order")
    if not _area(corners):
        raise InputError("", "an outline with an area", "one without")


def _area(corners: tuple[Corner, ...]) -> float:
    after = (*corners[1:], corners[0])
    return 0.5 * sum(ax * by - bx * ay for (ax, ay), (bx, by) in zip(corners, after, strict=True))


def _meet(a: Corner, b: Corner, c: Corner, d: Corner, *, shared: bool) -> bool:
    """Tell whether two sides have a point in common, or of two that share a corner another one."""
    turns = [_turn(a, b, c), _turn(a, b, d), _turn(c, d, a), _turn(c, d, b)]
    if shared:
        if any(turns):
            return False
        corner, one, other = (b, a, d) if b == c else (a, b, c)
        return (one[0] - corner[0]) * (other[0] - corner[0]) + (one[1] - corner[1]) * (other[1] - corner[1]) > 0.0
    if turns[0] * turns[1] < 0 and turns[2] * turns[3] < 0:
        return True
    ends = ((turns[0], a, b, c), (turns[1], a, b, d), (turns[2], c, d, a), (turns[3], c, d, b))
    return any(turn == 0 and _beside(start, end, point) for turn, start, end, point in ends)


def _turn(a: Corner, b: Corner, c: Corner) -> int:
    """Give 1 where c lies to the left of the way from a to b, -1 to the right, 0 on its line."""
    side = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (side > 0.0) - (side < 0.0)


def _beside(start: Corner, end: Corner, point: Corner) -> bool:
    return all(min(a, b) <= p <= max(a, b) for a, b, p in zip(start, end, point, strict=True))
