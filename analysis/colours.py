"""Colours of figures: people who do not tell red from green tell them apart, and so does a printer without colour."""

from __future__ import annotations

from typing import Final

COLOURS: Final = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""Okabe and Ito's."""

DASHES: Final = ("-", "--", "-.", ":")


def colour(place: int) -> str:
    """Give a colour by number; they come round again."""
    return COLOURS[place % len(COLOURS)]


def dashes(place: int) -> str:
    """Give a line's dashes by number: others for each round of the colours."""
    return DASHES[place // len(COLOURS) % len(DASHES)]
