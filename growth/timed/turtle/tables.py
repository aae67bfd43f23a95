"""The arrays that the turtle's kernels read and write, and the codes in them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from genome.timed.commands import SECTIONS
from growth.timed.tables import Floats, Ints

IDLE: Final = 0
OPEN: Final = 1
CLOSE: Final = 2
TURN: Final = 3
PITCH: Final = 4
ROLL: Final = 5
RIGHT: Final = 6
DOWN: Final = 7
BACK: Final = 8
"""The last three turn the other way: right, down, and anti-clockwise."""
MOVE: Final = 9
DRAW: Final = 10
CARRY: Final = 11
AROUND: Final = 12
LEVEL: Final = 13
RADIUS: Final = 14
DISC: Final = 15
SPHERE: Final = 16
BEGIN: Final = 17
FINISH: Final = 18
SURFACE: Final = 19
COLOUR: Final = 20
PALETTE: Final = 21
SECTION: Final = 22
WEIGHT: Final = 23

OPERATIONS: Final[Mapping[str, int]] = {
    "[": OPEN, "]": CLOSE, "f": MOVE, "F": DRAW, "cC": CARRY, "+": TURN, "-": RIGHT, "^": PITCH, "&": DOWN, "/": ROLL,
    "\\": BACK, "|": AROUND, "$": LEVEL, "!": RADIUS, "disc": DISC, "sphere": SPHERE, "{": BEGIN, "}": FINISH,
    "~": SURFACE, "colour": COLOUR, "'": PALETTE, **dict.fromkeys(SECTIONS, SECTION),
}  # fmt: skip
"""What each command does."""

PLACE: Final = 0
FRAME: Final = 3
WIDE: Final = 12
SHADE: Final = 13
OWN_PLACE: Final = 16
OWN_FRAME: Final = 19
TWIST: Final = 28
WEIGHTS: Final = 29
"""Columns of a state: place, heading left and up, radius, colour; the same place and directions as seen from where the
open carrier began, and by how much the turtle has rolled since; the weight of each surface."""

SHAPE: Final = 0
CARRIER: Final = 1
HUE: Final = 2
MOVER: Final = 3
FIRST_POLYGON: Final = 4
STATE_COLUMNS: Final = 5
"""Columns of a state's whole numbers: section, open carrier or NONE, place in the palette or NONE, the module that
moved last or NONE, how many polygons were open where the branch began."""

FARTHEST: Final = 1e9
"""No coordinate, radius or scale may be more."""

FEW: Final = 1
MANY: Final = 2
FAR: Final = 3
UNBALANCED: Final = 4
"""What can go wrong with a module."""


class Code(NamedTuple):
    """What the turtle makes of c codes.

    Attributes
    ----------
    operations
        (c,) int64.
    kinds
        (c,) int64, which section or surface; 0 of others.
    least, most
        (c,) int64, how many parameters there may be.
    """

    operations: Ints
    kinds: Ints
    least: Ints
    most: Ints


class Trail(NamedTuple):
    """What the turtle has left behind; p parts, s sections, c corners, k tips.

    Attributes
    ----------
    parts
        (p, 2) int64: the module, and the operation DRAW, SPHERE, DISC, SURFACE, CARRY or BEGIN. The parts of carriers
        and polygons come where these begin.
    frames
        (p, 4, 4) float64, scaled but for carriers and polygons.
    colours
        (p, 3) float64.
    extras
        (p, w) float64: the inner radius of a disc as a part of the outer; the weights of surfaces, which add up to 1;
        1 for a polygon that was closed.
    sections
        (s, 2) int64: the part, and the section.
    spots
        (s, 8) float64: place and heading as seen from the frame of the part, radius, and roll since the carrier began.
    corners
        (c,) int64, the polygon's part.
    places
        (c, 3) float64.
    tips
        (k, 3) float64.
    movers
        (k,) int64, the module that moved there, or NONE.
    """

    parts: Ints
    frames: Floats
    colours: Floats
    extras: Floats
    sections: Ints
    spots: Floats
    corners: Ints
    places: Floats
    tips: Floats
    movers: Ints
