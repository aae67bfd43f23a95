"""Conjoining of cells and parts in plain Python, slow and by other means than the kernels: sets, and searches.

A form of the plane is a disc when its cells are connected over edges, and so are the cells around it, corners counted
apart: no two of its cells meet in a corner alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from growth.polyforms.tiling import NO_SIDE, Tiling

Cell = tuple[int, int, int]


def beyond(cell: Cell, vector: int, tiling: Tiling) -> Cell | None:
    """Give the cell beyond an edge; ``None`` where the cell has no such edge."""
    kind = cell[2] if tiling.types > 1 else 0
    dx, dy, dz = tiling.steps[kind, vector].tolist()
    return None if dx == NO_SIDE else (cell[0] + dx, cell[1] + dy, cell[2] + dz)


def owners(cells: Sequence[Cell], vector: int, tiling: Tiling) -> list[Cell]:
    """Give the cells that have a free edge of a vector, in the order of their places."""
    there = set(cells)
    found = []
    for cell in cells:
        other = beyond(cell, vector, tiling)
        if other is not None and other not in there:
            found.append(cell)
    return found


def conjoined(joins: Iterable[Sequence[int]], tiling: Tiling, first: int = 0) -> list[Cell] | None:
    """Grow a room; ``None`` where a conjoining does not fit."""
    cells: list[Cell] = [(0, 0, first)]
    for vector, edge in joins:
        free = owners(cells, vector, tiling)
        if edge >= len(free):
            return None
        new = beyond(free[edge], vector, tiling)
        assert new is not None
        cells.append(new)
        if not is_disc(cells, tiling):
            return None
    return cells


def assembled(parts: Sequence[Sequence[Cell]], joins: Iterable[Sequence[int]], tiling: Tiling) -> list[Cell] | None:
    """Conjoin parts; ``None`` where one does not fit."""
    cells = list(parts[0])
    for part, (vector, edge, onto) in zip(parts[1:], joins, strict=True):
        free, facing = owners(cells, vector, tiling), owners(part, int(tiling.opposite[vector]), tiling)
        if edge >= len(free) or onto >= len(facing):
            return None
        target, own = beyond(free[edge], vector, tiling), facing[onto]
        assert target is not None
        shift = [a - b for a, b in zip(target, own, strict=True)]
        moved = [(x + shift[0], y + shift[1], z + shift[2]) for x, y, z in part]
        if set(moved) & set(cells):
            return None
        cells += moved
        if not is_disc(cells, tiling):
            return None
    return cells


def is_disc(cells: Sequence[Cell], tiling: Tiling) -> bool:
    """Tell whether cells are a disc, of cubes a ball, by counting vertices, edges, faces and insides."""
    corners: set[tuple[int, ...]] = set()
    sides: set[frozenset[tuple[int, ...]]] = set()
    for cell in cells:
        kind = cell[2] if tiling.types > 1 else 0
        origin = [sum(tiling.lattice[axis, k] * cell[k] for k in range(3)) for axis in range(3)]
        ring = [tuple(int(a + b) for a, b in zip(origin, one, strict=True)) for one in tiling.corners[kind].tolist()]
        corners.update(ring)
        if tiling.solid:
            sides.update(frozenset((one, other)) for one in ring for other in ring if _apart(one, other) == 1)
        else:
            sides.update(frozenset((ring[k - 1], ring[k])) for k in range(len(ring)))
    if not tiling.solid:
        return len(corners) - len(sides) + len(cells) == 1 and _connected(cells, tiling)
    faces = {frozenset((cell, other)) for cell in cells for v in range(6) if (other := beyond(cell, v, tiling))}
    euler = len(corners) - len(sides) + len(faces) - len(cells)
    return euler == 1 and _connected(cells, tiling) and _no_cavity(cells, tiling)


def _apart(one: Sequence[int], other: Sequence[int]) -> int:
    return sum(abs(a - b) for a, b in zip(one, other, strict=True))


def _connected(cells: Iterable[Cell], tiling: Tiling) -> bool:
    there = set(cells)
    seen = {next(iter(cells))}
    todo = list(seen)
    while todo:
        cell = todo.pop()
        for vector in range(len(tiling.letters)):
            other = beyond(cell, vector, tiling)
            if other in there and other not in seen:
                seen.add(other)
                todo.append(other)
    return seen == there


def _no_cavity(cells: Sequence[Cell], tiling: Tiling) -> bool:
    low = [min(cell[k] for cell in cells) - 1 for k in range(3)]
    high = [max(cell[k] for cell in cells) + 2 for k in range(3)]
    box = [
        (x, y, z)
        for x in range(low[0], high[0])
        for y in range(low[1], high[1])
        for z in range(low[2], high[2])
        if (x, y, z) not in set(cells)
    ]
    return _connected(box, tiling)
