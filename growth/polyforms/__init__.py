"""Rooms, zones and houses: forms conjoined of cells, and of each other (Rosenman 1997)."""

from growth.polyforms.distance import distances
from growth.polyforms.engine import (
    assemble,
    draw_assembly,
    draw_room,
    form_of,
    grow_room,
    mend_assembly,
    redraw_assembly,
    redraw_room,
)
from growth.polyforms.polyform import Plan, Polyform
from growth.polyforms.tiling import CUBE, HEXAGON, SQUARE, TILINGS, TRIANGLE, Tiling

__all__ = [
    "CUBE",
    "HEXAGON",
    "SQUARE",
    "TILINGS",
    "TRIANGLE",
    "Plan",
    "Polyform",
    "Tiling",
    "assemble",
    "distances",
    "draw_assembly",
    "draw_room",
    "form_of",
    "grow_room",
    "mend_assembly",
    "redraw_assembly",
    "redraw_room",
]
