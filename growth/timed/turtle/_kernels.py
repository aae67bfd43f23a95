"""The turtle as a kernel: from a word to places and frames.

The state is the top row of a pile: a bracket copies it, the closing one takes it away.
`tests/support/reference_drawing.py` is the same as plain Python, and must give equal results.
"""

from __future__ import annotations

import math
from typing import Any, Final

from numba import njit

# isort: off
from growth.timed.tables import NONE, Floats, Ints
from growth.timed.turtle.tables import (
    AROUND, BACK, BEGIN, CARRIER, CARRY, CLOSE, COLOUR, Code, DISC, DRAW, FAR, FARTHEST, FEW, FINISH,
    FIRST_POLYGON, FRAME, HUE, IDLE, LEVEL, MANY, MOVER, OPEN, OWN_FRAME, OWN_PLACE, PALETTE, PLACE,
    RADIUS, RIGHT, ROLL, SECTION, SHADE, SHAPE, SPHERE, STATE_COLUMNS, SURFACE, TURN, TWIST, Trail, UNBALANCED, WEIGHT,
    WEIGHTS, WIDE,
)  # fmt: skip
# isort: on

_OPTIONS: Final[Any] = {"cache": True, "error_model": "numpy", "_nrt": False}
_lent: Final = njit(**_OPTIONS)
"""None of them makes an array: to count references to those that they are given takes longer than all else they do."""

PART: int = 0
SPOT: int = 1
CORNER: int = 2
TIP: int = 3
POLYGON: int = 4
TOP: int = 5
COUNTERS: int = 6
"""How many parts, sections, corners and tips there are, polygons that are open, and the place of the state."""


@_lent
def turned(row: Floats, frame: int, operation: int, cosine: float, sine: float) -> None:
    """Turn the heading to the left, or up, or the left up, and make the directions orthonormal again."""
    first, second = (frame, frame + 3) if operation == TURN else (frame, frame + 6)
    if operation == ROLL:
        first, second = frame + 3, frame + 6
    for k in range(3):
        a, b = row[first + k], row[second + k]
        row[first + k], row[second + k] = a * cosine + b * sine, b * cosine - a * sine
    hx, hy, hz = row[frame], row[frame + 1], row[frame + 2]
    lx, ly, lz = row[frame + 3], row[frame + 4], row[frame + 5]
    # They are unit vectors but for rounding: the first step of Newton's method is exact, and needs no root.
    scale = 1.5 - 0.5 * (hx * hx + hy * hy + hz * hz)
    hx, hy, hz = hx * scale, hy * scale, hz * scale
    along = hx * lx + hy * ly + hz * lz
    lx, ly, lz = lx - along * hx, ly - along * hy, lz - along * hz
    scale = 1.5 - 0.5 * (lx * lx + ly * ly + lz * lz)
    lx, ly, lz = lx * scale, ly * scale, lz * scale
    row[frame], row[frame + 1], row[frame + 2] = hx, hy, hz
    row[frame + 3], row[frame + 4], row[frame + 5] = lx, ly, lz
    row[frame + 6], row[frame + 7], row[frame + 8] = hy * lz - hz * ly, hz * lx - hx * lz, hx * ly - hy * lx


@_lent
def steered(row: Floats, whole: Ints, operation: int, angle: float, memory: Floats) -> None:
    """Carry out an operation that turns, by an angle in radians.

    The memory holds an angle with its cosine and sine, those of the turn before: words repeat themselves.
    """
    if operation == AROUND:
        operation, angle, cosine, sine = TURN, math.pi, -1.0, 0.0
    else:
        if operation == LEVEL:
            # The level left is the vertical times the heading; where the heading is upright all lefts are level.
            x, y = -row[FRAME + 1], row[FRAME]
            if math.hypot(x, y) < 1e-12:
                return
            operation = ROLL
            angle = math.atan2(x * row[FRAME + 6] + y * row[FRAME + 7], x * row[FRAME + 3] + y * row[FRAME + 4])
        elif operation >= RIGHT:
            operation, angle = operation - 3, -angle
        if abs(angle) != memory[0]:
            memory[0] = abs(angle)
            memory[1], memory[2] = math.cos(memory[0]), math.sin(memory[0])
        cosine, sine = memory[1], memory[2] if angle >= 0.0 else -memory[2]
    turned(row, FRAME, operation, cosine, sine)
    if whole[CARRIER] != NONE:
        turned(row, OWN_FRAME, operation, cosine, sine)
        if operation == ROLL:
            row[TWIST] += angle


@_lent
def part_put(parts: Ints, frames: Floats, colours: Floats, counts: Ints, at: int, operation: int, row: Floats, x: float,
             y: float, z: float, start: float) -> int:  # fmt: skip
    """Put a part whose x, y and z are the turtle's left, up and heading, so much scaled, from a place ahead of it."""
    part = counts[PART]
    counts[PART] += 1
    parts[part, 0], parts[part, 1] = at, operation
    for k in range(3):
        heading = row[FRAME + k]
        frames[part, k, 0], frames[part, k, 1] = row[FRAME + 3 + k] * x, row[FRAME + 6 + k] * y
        frames[part, k, 2], frames[part, k, 3] = heading * z, row[PLACE + k] + heading * start
        frames[part, 3, k] = 0.0
        colours[part, k] = row[SHADE + k]
    frames[part, 3, 3] = 1.0
    return part


@_lent
def spot_put(trail: Trail, counts: Ints, row: Floats, whole: Ints, way: float) -> None:
    """Put a section of the open carrier where the turtle is; its heading is the way in which the turtle moves."""
    spot = counts[SPOT]
    counts[SPOT] += 1
    trail.sections[spot, 0], trail.sections[spot, 1] = whole[CARRIER], whole[SHAPE]
    for k in range(3):
        trail.spots[spot, k] = row[OWN_PLACE + k]
        trail.spots[spot, 3 + k] = row[OWN_FRAME + k] * way
    trail.spots[spot, 6] = row[WIDE]
    trail.spots[spot, 7] = row[TWIST]


@_lent
def corner_put(trail: Trail, counts: Ints, row: Floats, polygon: int) -> None:
    """Put a corner of a polygon where the turtle is."""
    trail.corners[counts[CORNER]] = polygon
    for k in range(3):
        trail.places[counts[CORNER], k] = row[PLACE + k]
    counts[CORNER] += 1


@_lent
def carried(trail: Trail, counts: Ints, at: int, row: Floats, whole: Ints, length: float) -> None:
    """Put sections before and behind a move; begin a carrier where none is open."""
    way = -1.0 if length < 0.0 else 1.0
    if whole[CARRIER] == NONE:
        whole[CARRIER] = part_put(trail.parts, trail.frames, trail.colours, counts, at, CARRY, row, 1.0, 1.0, 1.0, 0.0)
        for k in range(OWN_PLACE, TWIST + 1):
            row[k] = 0.0
        row[OWN_FRAME + 2] = row[OWN_FRAME + 3] = row[OWN_FRAME + 7] = 1.0
        spot_put(trail, counts, row, whole, way)
    for k in range(3):
        row[OWN_PLACE + k] += length * row[OWN_FRAME + k]
    spot_put(trail, counts, row, whole, way)


@_lent
def ahead(row: Floats, length: float) -> int:
    """Move the turtle; tell whether that is too far."""
    x, y = row[PLACE] + length * row[FRAME], row[PLACE + 1] + length * row[FRAME + 1]
    z = row[PLACE + 2] + length * row[FRAME + 2]
    row[PLACE], row[PLACE + 1], row[PLACE + 2] = x, y, z
    return 0 if abs(x) <= FARTHEST and abs(y) <= FARTHEST and abs(z) <= FARTHEST else FAR


@_lent
def moved(trail: Trail, counts: Ints, at: int, row: Floats, whole: Ints, pile: Ints, length: float,
          ends: bool) -> int:  # fmt: skip
    """Move within a polygon, where places are corners, or along a carrier."""
    within = counts[POLYGON] > 0
    if not within:
        carried(trail, counts, at, row, whole, length)
    if ends or within:
        whole[CARRIER] = NONE
    whole[MOVER] = at
    trouble = ahead(row, length)
    if within:
        corner_put(trail, counts, row, pile[counts[POLYGON] - 1])
    return trouble


@_lent
def plate_put(trail: Trail, counts: Ints, at: int, row: Floats, inner: float, outer: float) -> None:
    """Put a disc in the plane of heading and left, as thick as twice the radius."""
    inner, outer = min(abs(inner), abs(outer)), max(abs(inner), abs(outer))
    if inner == outer or row[WIDE] <= 0.0:
        return
    part = part_put(trail.parts, trail.frames, trail.colours, counts, at, DISC, row, 1.0, 1.0, 1.0, 0.0)
    for k in range(3):
        trail.frames[part, k, 0], trail.frames[part, k, 1] = row[FRAME + k] * outer, row[FRAME + 3 + k] * outer
        trail.frames[part, k, 2] = row[FRAME + 6 + k] * (2.0 * row[WIDE])
    trail.extras[part, 0] = inner / outer


@_lent
def surface_put(trail: Trail, counts: Ints, at: int, row: Floats, scale: float) -> None:
    """Put the mean of the surfaces and forget their weights; those under 0 count as 0."""
    total = 0.0
    for k in range(WEIGHTS, row.size):
        total += max(row[k], 0.0)
    if total > 0.0 and scale != 0.0:
        part = part_put(trail.parts, trail.frames, trail.colours, counts, at, SURFACE, row, 1.0, 1.0, 1.0, 0.0)
        for k in range(3):
            trail.frames[part, k, 0], trail.frames[part, k, 1] = row[FRAME + k] * scale, row[FRAME + 3 + k] * scale
            trail.frames[part, k, 2] = row[FRAME + 6 + k] * scale
        for k in range(WEIGHTS, row.size):
            trail.extras[part, k - WEIGHTS] = max(row[k], 0.0) / total
    for k in range(WEIGHTS, row.size):
        row[k] = 0.0


@_lent
def bracketed(trail: Trail, counts: Ints, states: Floats, wholes: Ints, operation: int) -> int:
    """Begin or end a branch."""
    top = counts[TOP]
    if operation == OPEN:
        for k in range(states.shape[1]):
            states[top + 1, k] = states[top, k]
        for k in range(STATE_COLUMNS):
            wholes[top + 1, k] = wholes[top, k]
        wholes[top + 1, CARRIER] = NONE
        wholes[top + 1, FIRST_POLYGON] = counts[POLYGON]
        counts[TOP] += 1
        return 0
    if top == 0:
        return UNBALANCED
    tip_put(trail, counts, states[top], wholes[top])
    counts[POLYGON] = wholes[top, FIRST_POLYGON]
    counts[TOP] -= 1
    return 0


@_lent
def tip_put(trail: Trail, counts: Ints, row: Floats, whole: Ints) -> None:
    """Put a tip where the turtle is."""
    for k in range(3):
        trail.tips[counts[TIP], k] = row[PLACE + k]
    trail.movers[counts[TIP]] = whole[MOVER]
    counts[TIP] += 1


@_lent
def outlined(trail: Trail, counts: Ints, at: int, row: Floats, whole: Ints, pile: Ints, operation: int) -> None:
    """Begin a polygon, or close the one begun last in this branch."""
    if operation == BEGIN:
        part = part_put(trail.parts, trail.frames, trail.colours, counts, at, BEGIN, row, 1.0, 1.0, 1.0, 0.0)
        trail.extras[part, 0] = 0.0
        pile[counts[POLYGON]] = part
        counts[POLYGON] += 1
        corner_put(trail, counts, row, part)
    elif counts[POLYGON] > whole[FIRST_POLYGON]:
        counts[POLYGON] -= 1
        trail.extras[pile[counts[POLYGON]], 0] = 1.0


@_lent
def shaded(row: Floats, whole: Ints, operation: int, given: Floats, palette: Floats) -> None:
    """Change the colour."""
    if operation == COLOUR:
        for k in range(3):
            row[SHADE + k] = min(max(given[k], 0.0), 1.0)
        return
    size = palette.shape[0]
    whole[HUE] = int(math.floor(given[0]) % size) if given.size else (whole[HUE] + 1) % size
    for k in range(3):
        row[SHADE + k] = palette[whole[HUE], k]


@_lent
def chosen(row: Floats, whole: Ints, operation: int, kind: int, given: Floats) -> int:
    """Set what later modules draw with: radius, section, weight of a surface."""
    if operation == SECTION:
        whole[SHAPE] = kind
        return 0
    value = given[0] if given.size else 1.0
    if abs(value) > FARTHEST:
        return FAR
    if operation == RADIUS:
        row[WIDE] = max(value, 0.0)
    else:
        row[WEIGHTS + kind] += value
    return 0


@_lent
def put(trail: Trail, counts: Ints, at: int, row: Floats, operation: int, given: Floats) -> int:
    """Draw a disc, a sphere or a surface."""
    for value in given:
        if abs(value) > FARTHEST:
            return FAR
    if operation == DISC:
        inner, outer = (given[0], given[1]) if given.size > 1 else (0.0, given[0])
        plate_put(trail, counts, at, row, inner, outer)
    elif operation == SPHERE:
        radius = abs(given[0]) if given.size else row[WIDE]
        if radius > 0.0:
            part_put(trail.parts, trail.frames, trail.colours, counts, at, SPHERE, row, radius, radius, radius, 0.0)
    else:
        surface_put(trail, counts, at, row, given[0] if given.size else 1.0)
    return 0


@_lent
def seldom(code: Code, codes: Ints, given: Floats, defaults: Floats, palette: Floats, row: Floats, whole: Ints,
           pile: Ints, trail: Trail, counts: Ints, at: int) -> int:  # fmt: skip
    """Carry out an operation other than brackets, turns and moves; or a move within a polygon."""
    operation = code.operations[codes[at]]
    if operation <= CARRY:
        length, ends = given[0] if given.size else defaults[0], given.size < 2 or given[1] != 0.0
        return moved(trail, counts, at, row, whole, pile, length, ends)
    if operation in (BEGIN, FINISH):
        outlined(trail, counts, at, row, whole, pile, operation)
        return 0
    if operation in (COLOUR, PALETTE):
        shaded(row, whole, operation, given, palette)
        return 0
    if operation in (RADIUS, SECTION, WEIGHT):
        return chosen(row, whole, operation, code.kinds[codes[at]], given)
    return put(trail, counts, at, row, operation, given)


@_lent
def counted(operations: Ints, codes: Ints, found: Ints) -> int:
    """Count how often each operation comes, and give how deep brackets nest."""
    depth = most = 0
    for code in codes:
        operation = operations[code]
        found[operation] += 1
        if operation <= CLOSE:
            depth += 1 if operation == OPEN else (-1 if operation == CLOSE else 0)
            most = max(most, depth)
    return most


@_lent
def walked(code: Code, codes: Ints, starts: Ints, values: Floats, defaults: Floats, palette: Floats, states: Floats,
           wholes: Ints, pile: Ints, trail: Trail, counts: Ints,
           memory: Floats) -> tuple[int, int]:  # fmt: skip
    """Walk along a word.

    Parameters
    ----------
    code
        What the codes mean.
    codes, starts, values
        As of :class:`~growth.timed.word.Word`.
    defaults
        (3,) float64: the length of moves and the angle of turns without a parameter, that in radians, and how many
        radians a unit of angle is.
    palette
        (h, 3) float64.
    states, wholes
        Room for states, a row more than brackets nest; the first row is the state at the beginning.
    pile
        Room for the polygons that are open.
    trail
        Room for what is drawn; written.
    counts
        (6,) int64, 0; then how many parts, sections, corners and tips of the trail are written.
    memory
        (3,) float64, an angle over 0 with its cosine and sine; written.

    Returns
    -------
    trouble, at
        0 and 0, or what is wrong and with which module.
    """
    parts, frames, colours = trail.parts, trail.frames, trail.colours
    for at in range(codes.size):
        operation = code.operations[codes[at]]
        if operation == IDLE:
            continue
        row, whole = states[counts[TOP]], wholes[counts[TOP]]
        given = values[starts[at] : starts[at + 1]]
        trouble = 0
        if given.size < code.least[codes[at]] or given.size > code.most[codes[at]]:
            trouble = FEW if given.size < code.least[codes[at]] else MANY
        elif operation <= CLOSE:
            trouble = bracketed(trail, counts, states, wholes, operation)
        elif operation <= BACK or operation in (AROUND, LEVEL):
            steered(row, whole, operation, given[0] * defaults[2] if given.size else defaults[1], memory)
        elif operation <= DRAW and not counts[POLYGON]:
            length = given[0] if given.size else defaults[0]
            if operation == DRAW and length != 0.0 and row[WIDE] > 0.0:
                part_put(parts, frames, colours, counts, at, DRAW, row, row[WIDE], row[WIDE], abs(length),
                         min(length, 0.0))  # fmt: skip
            whole[CARRIER], whole[MOVER] = NONE, at
            trouble = ahead(row, length)
        else:
            trouble = seldom(code, codes, given, defaults, palette, row, whole, pile, trail, counts, at)
        if trouble:
            return trouble, at
    if counts[TOP]:
        return UNBALANCED, codes.size - 1
    tip_put(trail, counts, states[0], wholes[0])
    return 0, 0
