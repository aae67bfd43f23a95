"""Lattices of cells: which cells touch, over what, how a turtle turns among them, and a cell's shape.

A cell is named by three integers. A new lattice is one value here and one line of :data:`LATTICES`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

FACE: Final = 0
EDGE: Final = 1
VERTEX: Final = 2
"""What two neighbours share."""

AXES: Final = (2, 1, 0)
"""The world's axes that the turtle yaws, pitches and rolls about: z, y and x."""


@final
@dataclass(frozen=True, eq=False)
class Lattice:
    """Cells that fill space, and their neighbourhood.

    Attributes
    ----------
    name
        As settings write it.
    offsets
        (k, 3) int64, from a cell to its neighbours; a fixed order, the opposite of each among them.
    contacts
        (k,) uint8, what is shared with each: :data:`FACE`, :data:`EDGE` or :data:`VERTEX`.
    beneath
        (b,) int64, places in ``offsets`` of the neighbours that a cell rests on: straight below where there is one.
    heading
        The place in ``offsets`` along which a turtle sets out: straight up where there is such a neighbour.
    parity
        Whether only cells whose coordinates add up to an even number exist.
    corners
        (c, 3) float64, the corners of the cell at the origin; the unit is the coordinates'.
    faces
        The corners of each of its faces, counter-clockwise as seen from outside.
    volume
        Of a cell, in cubes of the unit.
    """

    name: str
    offsets: Ints
    contacts: NDArray[np.uint8]
    beneath: Ints
    heading: int
    parity: bool
    corners: Floats
    faces: tuple[tuple[int, ...], ...]
    volume: float

    @cached_property
    def turns(self) -> Ints:
        """Give where who heads along each neighbour heads after a turn: (3, k) int64 of places in ``offsets``.

        Row 0 yaws about the world's z axis, row 1 pitches about y, row 2 rolls about x, each by the angle to the next
        neighbour on the same ring around the axis, by the right-hand rule. Who heads along the axis stays. The turn the
        other way is the inverse permutation.
        """
        return np.stack([_turned(self.offsets, axis) for axis in AXES])

    @cached_property
    def opposite(self) -> Ints:
        """Give the place of each offset's opposite: (k,) int64."""
        places = {tuple(offset): place for place, offset in enumerate(self.offsets.tolist())}
        return np.array([places[tuple(-value for value in offset)] for offset in self.offsets.tolist()], dtype=np.int64)


def _turned(offsets: Ints, axis: int) -> Ints:
    """Order each ring of offsets, those of one height along the axis and one kind of step, by angle; give the next."""
    across, up = (axis + 1) % 3, (axis + 2) % 3
    rings: dict[int, list[tuple[float, int]]] = {}
    following = np.arange(len(offsets), dtype=np.int64)
    for place, offset in enumerate(offsets.tolist()):
        if offset[across] or offset[up]:
            angle = float(np.arctan2(offset[up], offset[across]))
            rings.setdefault(offset[axis], []).append((angle, place))
    for ring in rings.values():
        ordered = [place for _, place in sorted(ring)]
        for place, after in zip(ordered, [*ordered[1:], ordered[0]], strict=True):
            following[place] = after
    return following


def _cubic() -> Lattice:
    offsets = np.array(
        [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) != (0, 0, 0)],
        dtype=np.int64,
    )
    contacts = (np.abs(offsets).sum(axis=1) - 1).astype(np.uint8)
    corners = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    faces = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return Lattice(
        "cubic", offsets, contacts, _places(offsets, (0, 0, -1)), int(_places(offsets, (0, 0, 1))[0]),
        parity=False, corners=corners, faces=faces, volume=1.0,
    )  # fmt: skip


def _isospatial() -> Lattice:
    """Make the lattice of rhombic dodecahedra; all of the 12 neighbours share a face (Senatore 2009, chapter 2)."""
    offsets = np.array(
        [
            (x, y, z)
            for x in (-1, 0, 1)
            for y in (-1, 0, 1)
            for z in (-1, 0, 1)
            if abs(x) + abs(y) + abs(z) == 2  # (1, 1, 0) and its kin
        ],
        dtype=np.int64,
    )
    cube = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    tips = [(-1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0), (0.0, 0.0, 1.0)]
    corners = np.array([*cube, *tips])
    faces = tuple(_rhombus(corners, offset.astype(np.float64)) for offset in offsets)
    contacts = np.full(len(offsets), FACE, dtype=np.uint8)
    beneath = _places(offsets, (-1, 0, -1), (0, -1, -1), (0, 1, -1), (1, 0, -1))
    heading = int(_places(offsets, (0, 1, 1))[0])
    return Lattice(
        "isospatial", offsets, contacts, beneath, heading, parity=True, corners=corners, faces=faces, volume=2.0
    )


def _square() -> Lattice:
    """Make the cells of a plane, z = 0: in it a turtle yaws, and pitching or rolling mirrors its heading."""
    whole = _cubic()
    flat = whole.offsets[:, 2] == 0
    return Lattice(
        "square", whole.offsets[flat], whole.contacts[flat], np.empty(0, dtype=np.int64),
        int(_places(whole.offsets[flat], (0, 1, 0))[0]),
        parity=False, corners=whole.corners, faces=whole.faces, volume=1.0,
    )  # fmt: skip


def _places(offsets: Ints, *wanted: tuple[int, int, int]) -> Ints:
    known = {tuple(offset): place for place, offset in enumerate(offsets.tolist())}
    return np.array([known[one] for one in wanted], dtype=np.int64)


def _rhombus(corners: Floats, towards: Floats) -> tuple[int, ...]:
    """Give the four corners of the face towards a neighbour, counter-clockwise as seen from there."""
    on = np.flatnonzero(np.isclose(corners @ towards, 1.0))
    local = corners[on] - corners[on].mean(axis=0)
    first = local[0] / np.linalg.norm(local[0])
    second = np.cross(towards / np.linalg.norm(towards), first)
    order = np.argsort(np.arctan2(local @ second, local @ first))
    return tuple(int(place) for place in on[order])


CUBIC: Final = _cubic()
"""Unit cubes and their 26 neighbours."""

ISOSPATIAL: Final = _isospatial()
"""Rhombic dodecahedra at the points of even coordinate sum, and their 12 neighbours."""

SQUARE: Final = _square()
"""Unit squares of one storey, drawn as cubes, and their 8 neighbours: for plans (Jackson 2002)."""

LATTICES: Final[Mapping[str, Lattice]] = MappingProxyType({one.name: one for one in (CUBIC, ISOSPATIAL)})
"""Those that bodies stand in, by name."""

ALL_LATTICES: Final[Mapping[str, Lattice]] = MappingProxyType({**LATTICES, SQUARE.name: SQUARE})
"""All, the plane among them, by name."""
