"""The brief: which rooms a house is to have, which of them belong together, and where it stands."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, NamedTuple, Self

from pydantic import BeforeValidator, Field, StringConstraints, WithJsonSchema, model_validator

from evaluators.plans.ground import room_for
from genome.errors import InputError
from genome.settings import Settings, describe, near
from growth.outline import Outline, as_outline
from growth.polyforms.tiling import TILINGS, Tiling

Side = Literal["north", "east", "south", "west"]
RoomName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=60)]

MOST_CELLS = 2000
"""Of a house."""

LARGEST_SITE = 250_000
"""The box around a site, in edges of cells squared."""

LARGER = "give the site a larger outline, or the rooms fewer cells"


class Adjacency(NamedTuple):
    """Two rooms that are to be adjacent, and how much that weighs."""

    first: str
    second: str
    weight: float


def _as_cells(value: object) -> object:
    if type(value) is not int or value < 1:
        raise InputError("", "a whole number of cells, at least 1", describe(value))
    return value


def _as_adjacency(value: object) -> Adjacency:
    match value:
        case Adjacency():
            return value
        case [str(first), str(second)]:
            return Adjacency(first, second, 1.0)
        case [str(first), str(second), int() | float() as weight] if (
            not isinstance(weight, bool) and math.isfinite(weight) and weight > 0
        ):
            return Adjacency(first, second, float(weight))
    raise InputError("", "two rooms, and a weight above 0 if it is not 1: [hall, bathroom, 2]", describe(value))


_PAIR_SCHEMA = {
    "type": "array",
    "prefixItems": [{"type": "string"}, {"type": "string"}, {"type": "number", "exclusiveMinimum": 0}],
    "minItems": 2,
    "maxItems": 3,
}
Pair = Annotated[Adjacency, BeforeValidator(_as_adjacency), WithJsonSchema(_PAIR_SCHEMA)]


class RoomWish(Settings):
    """What one room is to be.

    Attributes
    ----------
    cells
        Its area, in cells.
    daylight
        Whether it wants an outer wall.
    facing
        The sides of which one of its outer walls is to face one at least, such as the sun's.
    view
        Whether an outer wall is to face the site's view.
    private
        Whether nobody is to walk through it to another room: bedrooms, bathrooms.
    """

    cells: Annotated[int, BeforeValidator(_as_cells), Field(le=MOST_CELLS)]
    daylight: bool = False
    facing: tuple[Side, ...] | list[Side] = ()
    view: bool = False
    private: bool = False


class SiteWish(Settings):
    """Where the house stands; y is north.

    Attributes
    ----------
    outline
        A simple polygon, [[x, y], ...] in lengths of a cell's edge.
    street, view
        The sides on which the street and the view lie.
    """

    outline: Annotated[Outline | None, BeforeValidator(as_outline)] = None
    street: Side | None = None
    view: Side | None = None


class Brief(Settings):
    """A zone's or a house's rooms and what they want of each other.

    Attributes
    ----------
    tiling
        What the cells are.
    unit
        The length of a cell's edge in metres, for drawings.
    rooms
        By name, in the order in which they are conjoined.
    adjacencies
        The interconnection matrix: pairs and weights.
    entrance
        The room with the front door.
    door
        How many edges of cells two rooms share at least to be adjacent.
    site
        Where the house stands.
    """

    tiling: Literal["square", "triangle", "hexagon", "cube"] = "square"
    unit: Annotated[float, Field(gt=0, le=1000)] = 1.0
    rooms: Annotated[dict[RoomName, RoomWish], Field(min_length=1)]
    adjacencies: list[Pair] = Field(default_factory=list)
    entrance: str | None = None
    door: Annotated[int, Field(ge=1, le=1000)] = 1
    site: SiteWish = SiteWish()

    @model_validator(mode="after")
    def _names_are_rooms(self) -> Self:
        known = list(self.rooms)
        seen = set()
        for one in self.adjacencies:
            for name in (one.first, one.second):
                if name not in self.rooms:
                    raise InputError("", "adjacencies of rooms of the brief", f"'{name}'", near(name, known))
            if one.first == one.second:
                raise InputError("", "adjacencies of two rooms", f"'{one.first}' with itself")
            pair = frozenset((one.first, one.second))
            if pair in seen:
                raise InputError("", "each adjacency once", f"[{one.first}, {one.second}] twice")
            seen.add(pair)
        if self.entrance is not None and self.entrance not in self.rooms:
            raise InputError("", "an entrance that is a room", f"'{self.entrance}'", near(self.entrance, known))
        total = sum(room.cells for room in self.rooms.values())
        if total > MOST_CELLS:
            raise InputError("", f"rooms of {MOST_CELLS} cells in all at most", f"{total}")
        if self.site.outline is not None:
            needed, there = total * self.cells.area, self.site.outline.area
            if needed > there + 1e-9:
                raise InputError("", f"a site that holds the rooms' area of {needed:g}", f"one of {there:g}", LARGER)
            self._check_site(self.site.outline, total)
        return self

    def _check_site(self, outline: Outline, total: int) -> None:
        width, depth = (max(axis) - min(axis) for axis in zip(*outline.points, strict=True))
        if width * depth > LARGEST_SITE:
            raise InputError("", f"a site within {LARGEST_SITE:,} edges squared", f"{width:g} by {depth:g}")
        room = room_for(outline, self.tiling)
        if room < total and self.tiling != "cube":
            got = f"one in which {room} lie whole"
            raise InputError("", f"a site that holds the rooms' {total} cells", got, LARGER)

    @property
    def cells(self) -> Tiling:
        """The tiling that it names."""
        return TILINGS[self.tiling]

    def among(self, names: Sequence[str]) -> Brief:
        """Give the brief of these rooms alone, in this order: of the adjacencies those among them, and no site."""
        inside = set(names)
        changes: Mapping[str, Any] = {
            "rooms": {name: self.rooms[name] for name in names},
            "adjacencies": [one for one in self.adjacencies if {one.first, one.second} <= inside],
            "entrance": self.entrance if self.entrance in inside else None,
            "site": SiteWish(street=self.site.street, view=self.site.view),
        }
        return self.model_copy(update=dict(changes))
