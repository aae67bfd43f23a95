"""The kernels of conjoining: a form grows cell by cell, or part by part, and stays a disc (of cubes a ball).

Cells are three integers, see :mod:`growth.polyforms.tiling`. A free edge is one beyond which lies no cell. The free
edges of one vector are numbered in the order in which their cells were placed, from 0.
`tests/support/reference_polyforms.py` is the same as plain Python, and must give equal results.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Bytes = NDArray[np.uint8]
State = NDArray[np.uint64]

DONE: Final = 0
NO_EDGE: Final = 1
NO_DISC: Final = 2
OVERLAP: Final = 3
"""How a conjoining ended: well, without such a free edge, with a boundary that is not simple, with cells that meet."""

TRIES: Final = 64
"""How often one conjoining is drawn anew where it does not fit."""

_ABSENT: Final = -(2**20)
_GOLDEN: Final = np.uint64(0x9E3779B97F4A7C15)
_FIRST: Final = np.uint64(0xBF58476D1CE4E5B9)
_SECOND: Final = np.uint64(0x94D049BB133111EB)


@njit(cache=True)
def below(state: State, count: int) -> int:
    """Draw an integer from 0 up to and without ``count``; the state, (1,), moves on (SplitMix64)."""
    state[0] += _GOLDEN
    mixed = state[0]
    mixed = (mixed ^ (mixed >> np.uint64(30))) * _FIRST
    mixed = (mixed ^ (mixed >> np.uint64(27))) * _SECOND
    mixed ^= mixed >> np.uint64(31)
    return int((mixed >> np.uint64(11)) * (1.0 / 9007199254740992.0) * count)


@njit(cache=True)
def grid_of(reach: int, layers: int) -> Bytes:
    """Make an empty grid for cells up to ``reach`` from the origin: (layers, 2 reach + 3, 2 reach + 3)."""
    side = 2 * reach + 3
    return np.zeros((layers, side, side), dtype=np.uint8)


@njit(cache=True)
def spot(cell: Ints, layers: int, reach: int) -> tuple[int, int, int]:
    """Give a cell's place in a grid: layer, row, column."""
    shift = reach + 1
    return (cell[2] + shift if layers > 2 else cell[2]), cell[1] + shift, cell[0] + shift


@njit(cache=True)
def taken(grid: Bytes, cell: Ints, reach: int) -> bool:
    """Tell whether a cell is in a grid."""
    layers = grid.shape[0]
    z, y, x = spot(cell, layers, reach)
    return bool(grid[z, y, x] != 0)


@njit(cache=True)
def neighbour(cell: Ints, way: int, steps: Ints, out: Ints) -> bool:
    """Write the cell beyond an edge to ``out``; tell whether the cell has this edge."""
    kind = cell[2] if steps.shape[0] > 1 else 0
    if steps[kind, way, 0] == _ABSENT:
        return False
    out[0] = cell[0] + steps[kind, way, 0]
    out[1] = cell[1] + steps[kind, way, 1]
    out[2] = cell[2] + steps[kind, way, 2]
    return True


@njit(cache=True)
def is_free(cells: Ints, k: int, way: int, grid: Bytes, reach: int, steps: Ints) -> bool:
    """Tell whether a cell has an edge of a vector beyond which lies no cell; makes no array, since all ask it."""
    kind = cells[k, 2] if steps.shape[0] > 1 else 0
    if steps[kind, way, 0] == _ABSENT:
        return False
    shift = reach + 1
    x, y, z = cells[k, 0] + steps[kind, way, 0], cells[k, 1] + steps[kind, way, 1], cells[k, 2] + steps[kind, way, 2]
    return bool(grid[z + shift if grid.shape[0] > 2 else z, y + shift, x + shift] == 0)


@njit(cache=True)
def free_edges(cells: Ints, count: int, way: int, grid: Bytes, reach: int, steps: Ints) -> int:
    """Count the free edges of a vector."""
    found = 0
    for k in range(count):
        found += is_free(cells, k, way, grid, reach, steps)
    return found


@njit(cache=True)
def owner(cells: Ints, count: int, way: int, at: int, grid: Bytes, reach: int, steps: Ints) -> int:
    """Give the place of the cell that has the free edge number ``at`` of a vector; -1 where there is none."""
    found = 0
    for k in range(count):
        if is_free(cells, k, way, grid, reach, steps):
            if found == at:
                return k
            found += 1
    return -1


@njit(cache=True)
def corner_spot(cell: Ints, k: int, corners: Ints, lattice: Ints, reach: int) -> tuple[int, int]:
    """Give the place of a plane cell's corner in a grid of corners made by :func:`corner_grid`: row, column."""
    kind = cell[2] if corners.shape[0] > 1 else 0
    x = lattice[0, 0] * cell[0] + lattice[0, 1] * cell[1] + lattice[0, 2] * cell[2] + corners[kind, k, 0]
    y = lattice[1, 0] * cell[0] + lattice[1, 1] * cell[1] + lattice[1, 2] * cell[2] + corners[kind, k, 1]
    shift = 3 * reach + 4
    return y + shift, x + shift


@njit(cache=True)
def corner_grid(reach: int) -> Bytes:
    """Make an empty grid of the corners of plane cells up to ``reach`` from the origin."""
    side = 6 * reach + 9
    return np.zeros((side, side), dtype=np.uint8)


@njit(cache=True)
def fits_plane(cell: Ints, grid: Bytes, meets: Bytes, reach: int, steps: Ints, around: Ints, corners: Ints,
               lattice: Ints) -> bool:  # fmt: skip
    """Tell whether a form that is a disc stays one with this cell: it touches the form along one stretch of its rim.

    ``meets`` counts the form's cells at each corner.
    """
    kind = cell[2] if steps.shape[0] > 1 else 0
    shift = reach + 1
    y, x = corner_spot(cell, 0, corners, lattice, reach)
    y, x = y - corners[kind, 0, 1], x - corners[kind, 0, 0]
    # Sums of 0 and 1 in place of conditions, which no processor could foresee.
    rises, touching, first, before = 0, 0, 0, 0
    for k in range(around.shape[1]):
        corner = 1 if meets[y + corners[kind, k, 1], x + corners[kind, k, 0]] else 0
        way = around[kind, k]
        z = cell[2] + steps[kind, way, 2]
        edge = 1 if grid[z, cell[1] + steps[kind, way, 1] + shift, cell[0] + steps[kind, way, 0] + shift] else 0
        rises += corner * (1 - before) + edge * (1 - corner)
        touching += corner + edge
        first = corner if k == 0 else first
        before = edge
    rises -= first * before
    return rises == 1 or touching == 0


@njit(cache=True)
def _touched(cell: Ints, grid: Bytes, reach: int) -> Bytes:
    """Say which of the 26 parts of a cube's surface, (3, 3, 3) by way, some cell of the form touches."""
    rim = np.zeros((3, 3, 3), dtype=np.uint8)
    other = np.empty(3, dtype=np.int64)
    for i in range(-1, 2):
        for j in range(-1, 2):
            for k in range(-1, 2):
                if i == 0 and j == 0 and k == 0:
                    continue
                other[0], other[1], other[2] = cell[0] + i, cell[1] + j, cell[2] + k
                if not taken(grid, other, reach):
                    continue
                # A neighbour touches the part towards it, and all smaller parts of that part's rim.
                for a in range(-1, 2):
                    for b in range(-1, 2):
                        for c in range(-1, 2):
                            if (i == 0 or a == i) and (j == 0 or b == j) and (k == 0 or c == k):
                                rim[a + 1, b + 1, c + 1] = 1
    rim[1, 1, 1] = 0
    return rim


@njit(cache=True)
def _one_piece(rim: Bytes, value: int) -> bool:
    """Tell whether the parts of a cube's surface that have this value are connected; each part touches its rim."""
    seen = np.zeros((3, 3, 3), dtype=np.uint8)
    stack = np.empty((26, 3), dtype=np.int64)
    pieces = 0
    for start in range(27):
        i, j, k = start // 9, start // 3 % 3, start % 3
        if start == 13 or rim[i, j, k] != value or seen[i, j, k]:
            continue
        pieces += 1
        seen[i, j, k] = 1
        stack[0, 0], stack[0, 1], stack[0, 2] = i, j, k
        depth = 1
        while depth:
            depth -= 1
            i, j, k = stack[depth]
            for axis in range(3):
                for move in (-1, 1):
                    a, b, c = i, j, k
                    if axis == 0:
                        a += move
                    elif axis == 1:
                        b += move
                    else:
                        c += move
                    inside = 0 <= a < 3 and 0 <= b < 3 and 0 <= c < 3 and not (a == 1 and b == 1 and c == 1)
                    if inside and rim[a, b, c] == value and not seen[a, b, c]:
                        seen[a, b, c] = 1
                        stack[depth, 0], stack[depth, 1], stack[depth, 2] = a, b, c
                        depth += 1
    return pieces <= 1


@njit(cache=True)
def fits_space(cell: Ints, grid: Bytes, reach: int) -> bool:
    """Tell whether a form of cubes that is a ball stays one: what it touches of the cube is in one piece, and the rest.

    Neighbouring parts of a cube's surface (faces, edges, corners) differ by one in dimension and one coordinate.
    """
    rim = _touched(cell, grid, reach)
    return _one_piece(rim, 1) and _one_piece(rim, 0)


@njit(cache=True, inline="always")  # a call with so many arrays costs more than the work
def fits(cell: Ints, grid: Bytes, meets: Bytes, reach: int, steps: Ints, around: Ints, corners: Ints,
         lattice: Ints) -> bool:  # fmt: skip
    """Tell whether the form stays a disc, or a ball, with this cell."""
    if corners.shape[1] == 8:
        return fits_space(cell, grid, reach)
    return fits_plane(cell, grid, meets, reach, steps, around, corners, lattice)


@njit(cache=True)
def put(cell: Ints, grid: Bytes, meets: Bytes, reach: int, corners: Ints, lattice: Ints) -> None:
    """Put a cell into the grid of cells, and its corners, in the plane, into theirs."""
    z, y, x = spot(cell, grid.shape[0], reach)
    grid[z, y, x] = 1
    if corners.shape[1] < 8:
        for k in range(corners.shape[1]):
            y, x = corner_spot(cell, k, corners, lattice, reach)
            meets[y, x] += 1


@njit(cache=True)
def layers_of(reach: int, steps: Ints, corners: Ints) -> int:
    """Give the layers of a grid: the heights of cubes, or the types of the other cells."""
    return 2 * reach + 3 if corners.shape[1] == 8 else steps.shape[0]


# -- cell by cell ------------------------------------------------------------------------------------------------------


@njit(cache=True)
def conjoin(joins: Ints, force: int, mend: int, state: State, first: int, steps: Ints, around: Ints, corners: Ints,
            lattice: Ints) -> tuple[Ints, Ints, int, int]:  # fmt: skip
    """Grow a form cell by cell.

    Parameters
    ----------
    joins
        (n - 1, 2): the vector and the number of the free edge that each new cell joins.
    force
        The conjoining that is drawn anew in any case; none with -1.
    mend
        From this one on those that do not fit are drawn anew; none with n - 1 or more.
    state
        (1,), of the draws: each free edge is as likely.
    first
        The type of the first cell.

    Returns
    -------
    cells
        (n, 3), in the order of their places; the first at the origin.
    joins
        As given, with those drawn in their places.
    reason, at
        :data:`DONE`; or why the conjoining ``at`` does not fit.
    """
    count = len(joins) + 1
    reach = count
    made = joins.copy()
    cells = np.zeros((count, 3), dtype=np.int64)
    cells[0, 2] = first
    grid = grid_of(reach, layers_of(reach, steps, corners))
    meets = corner_grid(reach if corners.shape[1] < 8 else 0)
    put(cells[0], grid, meets, reach, corners, lattice)
    for k in range(1, count):
        reason = NO_EDGE
        if k - 1 != force:
            reason = _joined(cells, k, made[k - 1], grid, meets, reach, steps, around, corners, lattice)
        if reason != DONE and (k - 1 >= mend or k - 1 == force):
            for _ in range(TRIES):
                _draw_edge(cells, k, made[k - 1], grid, reach, steps, state)
                reason = _joined(cells, k, made[k - 1], grid, meets, reach, steps, around, corners, lattice)
                if reason == DONE:
                    break
        if reason != DONE:
            return cells[:k], made, reason, k - 1
        put(cells[k], grid, meets, reach, corners, lattice)
    return cells, made, DONE, 0


@njit(cache=True, inline="always")
def _joined(cells: Ints, count: int, join: Ints, grid: Bytes, meets: Bytes, reach: int, steps: Ints, around: Ints,
            corners: Ints, lattice: Ints) -> int:  # fmt: skip
    """Write the cell that a conjoining adds behind the others, and say whether it fits."""
    place = owner(cells, count, join[0], join[1], grid, reach, steps)
    if place < 0:
        return NO_EDGE
    neighbour(cells[place], join[0], steps, cells[count])
    if not fits(cells[count], grid, meets, reach, steps, around, corners, lattice):
        return NO_DISC
    return DONE


@njit(cache=True)
def _draw_edge(cells: Ints, count: int, join: Ints, grid: Bytes, reach: int, steps: Ints, state: State) -> None:
    """Draw one of all free edges."""
    ways = steps.shape[1]
    counts = np.empty(ways, dtype=np.int64)
    for way in range(ways):
        counts[way] = free_edges(cells, count, way, grid, reach, steps)
    at = below(state, counts.sum())
    for way in range(ways):
        if at < counts[way]:
            join[0], join[1] = way, at
            return
        at -= counts[way]


# -- part by part ------------------------------------------------------------------------------------------------------


@njit(cache=True)
def assemble(parts: Ints, starts: Ints, joins: Ints, force: int, mend: int, state: State, steps: Ints, opposite: Ints,
             corners: Ints, lattice: Ints) -> tuple[Ints, Ints, int, int]:  # fmt: skip
    """Conjoin parts, each a form of its own.

    Parameters
    ----------
    parts
        (n, 3), the cells of all parts one after the other.
    starts
        (p + 1,), where each part begins.
    joins
        (p - 1, 3): the vector and the number of the free edge of the form so far, and the number of the new part's free
        edge of the opposite vector.
    force, mend, state
        As of :func:`conjoin`; each free edge is as likely, and each of the part's that fits it.

    Returns
    -------
    cells
        (n, 3), in the order of the parts; or those placed before the conjoining that does not fit.
    joins, reason, at
        As of :func:`conjoin`.
    """
    count = len(parts)
    reach = count
    made = joins.copy()
    cells = parts.copy()
    grid = grid_of(reach, layers_of(reach, steps, corners))
    for k in range(starts[1]):
        z, y, x = spot(cells[k], grid.shape[0], reach)
        grid[z, y, x] = 1
    for part in range(1, len(starts) - 1):
        begin, end = starts[part], starts[part + 1]
        own = grid_of(end - begin, layers_of(end - begin, steps, corners))
        for k in range(begin, end):
            z, y, x = spot(parts[k], own.shape[0], end - begin)
            own[z, y, x] = 1
        reason = NO_EDGE
        if part - 1 != force:
            reason = _attached(cells, parts, begin, end, made[part - 1], grid, own, reach, steps, opposite, corners,
                               lattice)  # fmt: skip
        if reason != DONE and (part - 1 >= mend or part - 1 == force):
            join = made[part - 1]
            for _ in range(TRIES):
                _draw_edge(cells, begin, join, grid, reach, steps, state)
                facing = free_edges(parts[begin:end], end - begin, opposite[join[0]], own, end - begin, steps)
                if facing == 0:
                    continue
                join[2] = below(state, facing)
                reason = _attached(cells, parts, begin, end, join, grid, own, reach, steps, opposite, corners, lattice)
                if reason == DONE:
                    break
        if reason != DONE:
            return cells[:begin], made, reason, part - 1
        for k in range(begin, end):
            z, y, x = spot(cells[k], grid.shape[0], reach)
            grid[z, y, x] = 1
    return cells, made, DONE, 0


@njit(cache=True)
def _attached(cells: Ints, parts: Ints, begin: int, end: int, join: Ints, grid: Bytes, own: Bytes, reach: int,
              steps: Ints, opposite: Ints, corners: Ints, lattice: Ints) -> int:  # fmt: skip
    """Write the cells of a part where a conjoining puts them, and say whether they fit."""
    place = owner(cells, begin, join[0], join[1], grid, reach, steps)
    if place < 0:
        return NO_EDGE
    facing = owner(parts[begin:end], end - begin, opposite[join[0]], join[2], own, end - begin, steps)
    if facing < 0:
        return NO_EDGE
    beyond = np.empty(3, dtype=np.int64)
    neighbour(cells[place], join[0], steps, beyond)
    for axis in range(3):
        shift = beyond[axis] - parts[begin + facing, axis]
        for k in range(begin, end):
            cells[k, axis] = parts[k, axis] + shift
    for k in range(begin, end):
        if taken(grid, cells[k], reach):
            return OVERLAP
    if characteristic(cells[:end], steps, corners, lattice) != 1:
        return NO_DISC
    return DONE


@njit(cache=True)
def characteristic(cells: Ints, steps: Ints, corners: Ints, lattice: Ints) -> int:
    """Give the Euler characteristic of the union of closed cells; 1 of a disc and of a ball."""
    solid = corners.shape[1] == 8
    low = np.array([cells[:, 0].min(), cells[:, 1].min(), cells[:, 2].min()])
    high = np.array([cells[:, 0].max(), cells[:, 1].max(), cells[:, 2].max()])
    if solid:
        return _characteristic_of_cubes(cells, low, high)
    reach = max(high[0] - low[0], high[1] - low[1])
    grid = grid_of(reach, steps.shape[0])
    moved = cells.copy()
    moved[:, 0] -= low[0]
    moved[:, 1] -= low[1]
    meets = corner_grid(reach)
    beyond = np.empty(3, dtype=np.int64)
    vertices, doubled = 0, 0
    for k in range(len(moved)):
        z, y, x = spot(moved[k], grid.shape[0], reach)
        grid[z, y, x] = 1
        for c in range(corners.shape[1]):
            y, x = corner_spot(moved[k], c, corners, lattice, reach)
            vertices += meets[y, x] == 0
            meets[y, x] = 1
    sides = 0
    for k in range(len(moved)):
        for way in range(steps.shape[1]):
            if neighbour(moved[k], way, steps, beyond):
                sides += 1
                doubled += taken(grid, beyond, reach)
    return vertices - (sides - doubled // 2) + len(cells)


@njit(cache=True)
def _characteristic_of_cubes(cells: Ints, low: Ints, high: Ints) -> int:
    """Give the Euler characteristic of cubes by marking their vertices, edges, faces and insides on a doubled grid."""
    shape = 2 * (high - low) + 3
    marks = np.zeros((shape[0], shape[1], shape[2]), dtype=np.uint8)
    total = 0
    for n in range(len(cells)):
        x, y, z = 2 * (cells[n] - low) + 1
        for i in range(-1, 2):
            for j in range(-1, 2):
                for k in range(-1, 2):
                    if not marks[x + i, y + j, z + k]:
                        marks[x + i, y + j, z + k] = 1
                        odd = (i != 0) + (j != 0) + (k != 0)
                        total += -1 if (3 - odd) % 2 else 1
    return total
