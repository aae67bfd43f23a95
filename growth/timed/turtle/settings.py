"""How the turtle draws what modules leave open, how fine its shapes are, and how much it may draw."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from genome.settings import Settings

_Sides = Annotated[int, Field(ge=3, le=720)]
_Length = Annotated[float, Field(gt=0, le=1e9)]


class TurtleSettings(Settings):
    """The ``turtle:`` part of the growth of timed forms.

    Attributes
    ----------
    radius
        Of the turtle before any ``!``.
    length
        Of moves without a parameter.
    angle
        Of turns without a parameter, in degrees whatever the file's ``angles`` says.
    sides
        Of round sections and spheres; discs have four times as many.
    corners
        Of carriers that have a section other than the circle; 40 meets the corners of squares and five-pointed stars.
    rings
        Rings of a carrier from one section to the next.
    max_parts, max_vertices
        The most parts of a drawing, and vertices of all of them.
    """

    radius: Annotated[float, Field(ge=0, le=1e9)] = 0.1
    length: _Length = 1.0
    angle: Annotated[float, Field(ge=-360, le=360)] = 22.5
    sides: _Sides = 16
    corners: _Sides = 40
    rings: Annotated[int, Field(ge=1, le=100)] = 6
    max_parts: Annotated[int, Field(ge=1, le=10_000_000)] = 200_000
    max_vertices: Annotated[int, Field(ge=1, le=100_000_000)] = 10_000_000
