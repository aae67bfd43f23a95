"""What a drawing of a plan shows, in metres, x east and y north; every writer of a format takes its figures from here.

Walls stand on the edges of cells: the middle of a wall, its axis, is the line between two rooms, or a room and the
outside. Areas of rooms and lengths of walls are measured to the axes, so that they are those of the cells.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple, final

from evaluators.plans.brief import Side

Point = tuple[float, float]
Ring = tuple[Point, ...]
"""A closed polygon, counter-clockwise; the last point is joined to the first."""

OUTSIDE: Final = -1
"""The number that stands for the outside where a room's would."""

HEIGHT: Final = 2.7
"""Of a storey's walls."""
DOOR_HEAD: Final = 2.1
WINDOW_SILL: Final = 0.9
WINDOW_HEAD: Final = DOOR_HEAD
"""Heights above the floor."""
SLAB: Final = 0.2
"""The thickness of the floor's slab."""


class Label(NamedTuple):
    """Where a room's name and area are written.

    Attributes
    ----------
    at
        The middle of the words, inside the room.
    size
        The height of the letters.
    upright
        Whether the words run from south to north, as in a narrow room.
    """

    at: Point
    size: float
    upright: bool


@final
@dataclass(frozen=True, slots=True)
class DrawnRoom:
    """A room.

    Attributes
    ----------
    name
        Of the brief.
    area
        To the axes of its walls, in square metres.
    outline
        Along the axes.
    floor
        Along the faces of the walls: what one walks on.
    label
        For its words.
    private
        Whether nobody walks through it.
    """

    name: str
    area: float
    outline: Ring
    floor: Ring
    label: Label
    private: bool


@final
@dataclass(frozen=True, slots=True)
class Wall:
    """A straight wall between two rooms, or a room and the outside.

    Attributes
    ----------
    first, last
        The ends of its axis; the room of the lower number (of an outer wall the room) is on the left.
    rooms
        The numbers of the rooms left and right; the right one :data:`OUTSIDE` for an outer wall.
    thickness
        Outer walls are thicker.
    before, after
        The ring of the wall's body in two parts: round the first end from the left face to the right one, and round
        the last end from the right face to the left one. The bodies of all walls meet without gaps or overlaps.
    clear
        How far along the axis both faces are free: from, to.
    """

    first: Point
    last: Point
    rooms: tuple[int, int]
    thickness: float
    before: tuple[Point, ...]
    after: tuple[Point, ...]
    clear: tuple[float, float]

    @property
    def outer(self) -> bool:
        """Whether it bounds the house."""
        return self.rooms[1] == OUTSIDE

    @property
    def body(self) -> Ring:
        """The wall as it is seen from above, without openings."""
        return self.before + self.after

    @property
    def length(self) -> float:
        """Of its axis."""
        (ax, ay), (bx, by) = self.first, self.last
        return float(((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5)

    @property
    def along(self) -> Point:
        """The unit vector from first to last."""
        (ax, ay), (bx, by), length = self.first, self.last, self.length
        return (bx - ax) / length, (by - ay) / length

    def at(self, distance: float, aside: float = 0.0) -> Point:
        """Give the point so far along the axis, and so far left of it."""
        (x, y), (dx, dy) = self.first, self.along
        return x + distance * dx - aside * dy, y + distance * dy + aside * dx


@final
@dataclass(frozen=True, slots=True)
class Opening:
    """A door or a window in a wall.

    Attributes
    ----------
    kind
        Doors reach down to the floor.
    wall
        The number of the wall.
    start, width
        Along the wall's axis.
    into
        The room that a door swings into, or a window lights.
    hinge_last
        Whether a door's hinges are nearer to the wall's last end.
    front
        Whether it is the front door.
    """

    kind: Literal["door", "window"]
    wall: int
    start: float
    width: float
    into: int
    hinge_last: bool = False
    front: bool = False


class Leaf(NamedTuple):
    """A door that stands open at a right angle.

    Attributes
    ----------
    hinge, tip
        Where the leaf begins and ends.
    jamb
        Where the tip is when the door is shut.
    """

    hinge: Point
    tip: Point
    jamb: Point


class Dimension(NamedTuple):
    """A dimension line.

    Attributes
    ----------
    side
        Of the house; those of north and south run along x.
    first, last
        What is measured, from west or south to east or north, on the dimension line.
    """

    side: Side
    first: Point
    last: Point

    @property
    def length(self) -> float:
        """What is written on it."""
        return abs(self.last[0] - self.first[0]) + abs(self.last[1] - self.first[1])


@final
@dataclass(frozen=True, slots=True)
class Ground:
    """The site, where the brief has one.

    Attributes
    ----------
    outline
        In metres.
    street, view
        The sides on which they lie.
    """

    outline: Ring | None
    street: Side | None
    view: Side | None


@final
@dataclass(frozen=True, slots=True)
class Drawing:
    """A plan to be drawn.

    Attributes
    ----------
    title
        What it is.
    rooms
        In the brief's order.
    walls
        All of them.
    openings
        Doors where wanted adjacencies are met, the front door, windows.
    hull
        The outer faces of the outer walls.
    outline
        The axes of the outer walls.
    dimensions
        Along the sides.
    ground
        The site.
    """

    title: str
    rooms: tuple[DrawnRoom, ...]
    walls: tuple[Wall, ...]
    openings: tuple[Opening, ...]
    hull: Ring
    outline: Ring
    dimensions: tuple[Dimension, ...]
    ground: Ground

    @property
    def area(self) -> float:
        """Of all rooms."""
        return sum(room.area for room in self.rooms)

    @property
    def doors(self) -> tuple[Opening, ...]:
        """The doors."""
        return tuple(one for one in self.openings if one.kind == "door")

    @property
    def windows(self) -> tuple[Opening, ...]:
        """The windows."""
        return tuple(one for one in self.openings if one.kind == "window")

    def of_wall(self, number: int) -> list[Opening]:
        """Give a wall's openings, from its first end to its last."""
        return sorted((one for one in self.openings if one.wall == number), key=lambda one: one.start)

    def leaf(self, door: Opening) -> Leaf:
        """Give a door as it stands open; the leaf hangs in the face of the wall towards which it opens."""
        return leaf_of(self.walls[door.wall], door)


def leaf_of(wall: Wall, door: Opening) -> Leaf:
    """Give a door of a wall as it stands open."""
    side = 1.0 if wall.rooms[0] == door.into else -1.0
    face = side * wall.thickness / 2
    ends = (door.start, door.start + door.width)
    hinge, jamb = (ends[1], ends[0]) if door.hinge_last else ends
    return Leaf(wall.at(hinge, face), wall.at(hinge, face + side * door.width), wall.at(jamb, face))


def ring_area(ring: Sequence[Point]) -> float:
    """Give the area of a polygon, above 0 counter-clockwise."""
    pairs = zip(ring, (*ring[1:], ring[0]), strict=True)
    return sum(ax * by - bx * ay for (ax, ay), (bx, by) in pairs) / 2
