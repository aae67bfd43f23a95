"""The symbols that the turtle knows (McCormack, section 4), and how many parameters each takes.

Genotypes know their names, not what they draw: growth/timed/turtle/ does.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

SECTIONS: Final = ("circle", "square", "triangle", "star")
"""Cross-sections of generalised cylinders that every file has; `section` statements add others."""

TURTLE: Final[Mapping[str, tuple[int, int]]] = {
    "[": (0, 0),
    "]": (0, 0),
    "f": (0, 1),
    "F": (0, 1),
    "cC": (0, 2),
    "+": (0, 1),
    "-": (0, 1),
    "^": (0, 1),
    "&": (0, 1),
    "/": (0, 1),
    "\\": (0, 1),
    "|": (0, 0),
    "$": (0, 0),
    "!": (1, 1),
    "disc": (1, 2),
    "sphere": (0, 1),
    "{": (0, 0),
    "}": (0, 0),
    "~": (0, 1),
    "colour": (3, 3),
    "'": (0, 1),
    **dict.fromkeys(SECTIONS, (0, 0)),
}
"""The least and the most parameters of each command."""
