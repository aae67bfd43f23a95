"""Criteria of single rooms: what makes a shape of cells compact (Rosenman 1997, section 3.3.1)."""

from evaluators.rooms.registry import ROOM_CRITERIA, resolve, score
from evaluators.rooms.shape import corners, perimeter, perimeter_to_area, proportions

__all__ = ["ROOM_CRITERIA", "corners", "perimeter", "perimeter_to_area", "proportions", "resolve", "score"]
