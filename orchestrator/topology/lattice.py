"""Rows and columns: what the grid and the torus share."""

from __future__ import annotations

import math
from typing import Annotated, Final

from pydantic import Field

from genome.errors import InputError
from orchestrator.topology.protocol import Ground, Link, as_links, both_ways

LEAST: Final = 2
"""Rows and columns that a lattice has at least; with one it is a line or a ring."""

Side = Annotated[int, Field(ge=LEAST, le=1_000_000)]


def laid(ground: Ground, rows: int | None, columns: int | None, instead: str, *, closed: bool) -> list[Link]:
    """Give the edges of a lattice, both ways; none for a single island.

    Parameters
    ----------
    ground
        The islands.
    rows, columns, instead
        As for :func:`sides`.
    closed
        Whether each row and column ends where it begins.
    """
    if ground.count == 1:
        return []
    rows, columns = sides(ground.count, rows, columns, instead)
    open_ends = 0 if closed else 1
    right = (
        (r * columns + c, r * columns + (c + 1) % columns) for r in range(rows) for c in range(columns - open_ends)
    )
    down = ((r * columns + c, (r + 1) % rows * columns + c) for r in range(rows - open_ends) for c in range(columns))
    return as_links(both_ways([*right, *down]))


def sides(count: int, rows: int | None, columns: int | None, instead: str) -> tuple[int, int]:
    """Give the rows and columns of a lattice of so many places; what is not given is chosen nearest to square.

    Parameters
    ----------
    count
        How many islands there are.
    rows, columns
        As asked for.
    instead
        The topology to take where there is only one row.

    Raises
    ------
    InputError
        When no rows and columns of at least two make that number, or those given do not.
    """
    if rows is None and columns is None:
        found = _squarest(count)
        if found is None:
            raise InputError("", f"{_fitting(count)} islands", str(count), f"or take topology: {instead}")
        return found
    given = rows if rows is not None else columns or LEAST
    other = columns if rows is not None and columns is not None else count // given
    if given * other != count or other < LEAST:
        if rows is not None and columns is not None:
            raise InputError("", f"{rows} x {columns} = {given * other} islands", str(count), "change rows or columns")
        key = "rows" if rows is not None else "columns"
        known = [side for side in range(LEAST, count // LEAST + 1) if count % side == 0]
        expected = f"{key} that divide {count} islands" + (f": {_listed(known)}" if known else "")
        raise InputError(key, expected, str(given), "" if known else f"take {_fitting(count)} islands")
    return (given, other) if rows is not None else (other, given)


def _squarest(count: int) -> tuple[int, int] | None:
    for rows in range(math.isqrt(count), LEAST - 1, -1):
        if count % rows == 0:
            return rows, count // rows
    return None


def _fitting(count: int) -> str:
    """Name the numbers next to ``count`` that are rows times columns."""
    below = next((size for size in range(count - 1, 3, -1) if _squarest(size)), None)
    above = next(size for size in range(max(count + 1, 4), count + 5) if _squarest(size))
    return " or ".join(
        f"{size} ({rows} x {columns})"
        for size, (rows, columns) in ((size, _squarest(size) or (0, 0)) for size in (below, above) if size is not None)
    )


def _listed(values: list[int]) -> str:
    shown = ", ".join(map(str, values[:8]))
    return shown if len(values) <= 8 else f"{shown}, ..."
