"""Windows where rooms want daylight, the sun or the view."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from evaluators.plans.brief import RoomWish
from evaluators.plans.drawings.doors import faces, jamb
from evaluators.plans.drawings.drawing import WINDOW_HEAD, WINDOW_SILL, Opening, Wall
from evaluators.plans.layout import COMPASS, Layout

LIGHT: Final = 1 / 8
"""The area of a room's windows as a share of its floor's."""
WIDEST: Final = 2.4
NARROWEST: Final = 0.4
"""Widths in metres."""
SHARE: Final = 0.8
"""Of a free stretch of wall that a window takes at most."""


def windows(layout: Layout, walls: Sequence[Wall], doors: Sequence[Opening]) -> list[Opening]:
    """Place windows.

    Rooms that want daylight, a side or the view get them; where no room of the brief wants any, all rooms do. The walls
    that face what a room wants come first, then the longest ones, until the windows' area is an eighth of the floor's.

    Returns
    -------
    list of Opening
        Room by room.
    """
    wishes = list(layout.brief.rooms.values())
    asked = [bool(wish.daylight or wish.facing or wish.view) for wish in wishes]
    found: list[Opening] = []
    for room, wish in enumerate(wishes):
        if asked[room] or not any(asked):
            found += _of_room(layout, room, wish, walls, doors)
    return found


def _of_room(
    layout: Layout, room: int, wish: RoomWish, walls: Sequence[Wall], doors: Sequence[Opening]
) -> Iterator[Opening]:
    unit = layout.brief.unit
    wanted = [COMPASS[side] for side in wish.facing]
    if wish.view and layout.brief.site.view is not None:
        wanted.append(COMPASS[layout.brief.site.view])
    own = [k for k, wall in enumerate(walls) if wall.outer and wall.rooms[0] == room]
    own.sort(key=lambda k: (-sum(faces(walls[k], way) for way in wanted), -round(walls[k].length, 6), k))
    area = sum(wish.cells for wish in [wish]) * layout.plan.tiling.area * unit**2
    needed = LIGHT * area / (WINDOW_HEAD - WINDOW_SILL)
    for k in own:
        if needed <= 0:
            return
        low, high = _free(walls[k], [one for one in doors if one.wall == k], jamb(unit))
        width = min(WIDEST, SHARE * (high - low))
        if width > 0 and width >= min(NARROWEST, unit / 3):
            needed -= width
            yield Opening("window", k, (low + high - width) / 2, width, room)


def _free(wall: Wall, doors: Sequence[Opening], margin: float) -> tuple[float, float]:
    """Give the longest stretch of a wall that has no door."""
    low, high = wall.clear[0] + margin, wall.clear[1] - margin
    stretches = [(low, high)]
    for door in doors:
        stretches = [
            part
            for a, b in stretches
            for part in ((a, min(b, door.start - margin)), (max(a, door.start + door.width + margin), b))
        ]
    return max(stretches, key=lambda part: (round(part[1] - part[0], 9), -part[0]))
