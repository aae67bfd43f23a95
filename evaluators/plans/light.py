"""Outer walls where rooms want them: for daylight, towards the sun, the view and the street.

Each gives the share of those rooms that have what they want; 1 where no room wants anything.
"""

from __future__ import annotations

from collections.abc import Iterable

from evaluators.plans.layout import Layout


def daylight(layout: Layout) -> float:
    """Give the share of the rooms that want daylight and have an outer wall."""
    wishes = layout.brief.rooms.values()
    return _share(bool(layout.outer[k].sum()) for k, wish in enumerate(wishes) if wish.daylight)


def orientation(layout: Layout) -> float:
    """Give the share of the rooms that are to face some side and have an outer wall that does."""
    wishes = layout.brief.rooms.values()
    return _share(any(layout.facing(k, side) for side in wish.facing) for k, wish in enumerate(wishes) if wish.facing)


def view(layout: Layout) -> float:
    """Give the share of the rooms that want the view and have an outer wall towards it."""
    side = layout.brief.site.view
    if side is None:
        return 1.0
    return _share(layout.facing(k, side) > 0 for k, wish in enumerate(layout.brief.rooms.values()) if wish.view)


def street(layout: Layout) -> float:
    """Tell whether the room with the front door has an outer wall towards the street; without a street, any."""
    entrance = layout.brief.entrance
    if entrance is None:
        return 1.0
    room = list(layout.brief.rooms).index(entrance)
    side = layout.brief.site.street
    return float((layout.outer[room].sum() if side is None else layout.facing(room, side)) > 0)


def _share(good: Iterable[bool]) -> float:
    found = list(good)
    return sum(found) / len(found) if found else 1.0
