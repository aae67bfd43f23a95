"""What every boundary answers, and the settings that all of them share."""

from __future__ import annotations

from typing import Final, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from genome.settings import Settings

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Triangles = NDArray[np.int32]

SKIN: Final = 1e-6
"""The distance that is kept before a boundary, as a share of the boundary's size."""


class BoundarySettings(Settings):
    """What may be set of every boundary.

    Attributes
    ----------
    solid
        Which side is solid: ``inside`` (an obstacle) or ``outside`` (a container).
    soft
        Whether growth may pass it; then the nodes on its solid side are counted instead.
    """

    solid: Literal["inside", "outside"] = "inside"
    soft: bool = False


class Boundary(Protocol):
    """A solid and a free side of space. Points are (n, 3) float64, C-contiguous."""

    @property
    def soft(self) -> bool:
        """Whether growth may pass it."""
        ...

    @property
    def skin(self) -> float:
        """The distance that growth keeps before it, in the environment's unit."""
        ...

    def first_hit(self, start: Floats, end: Floats) -> Floats:
        """Give the fraction (n,) of each way at which it enters the solid side; infinite where it does not.

        A way that begins on the surface and leads into the solid enters it at 0; one that leads along it or away does
        not enter. A way that begins within the solid is not looked at: :meth:`inside` finds where it ends.
        """
        ...

    def inside(self, points: Floats) -> Flags:
        """Say of each point whether it is within the solid side; a point on the surface is not."""
        ...

    def nearest_free(self, points: Floats, clearance: float = 1.0) -> Floats:
        """Move points of the solid side to the nearest of the free side, ``clearance`` skins off the surface."""
        ...

    def outline(self, extent: float) -> tuple[Floats, Triangles]:
        """Give vertices (v, 3) and triangles (t, 3), fronts out of the shape, to look at or to compare with.

        A shape without end is cut off at about ``extent`` from its place.
        """
        ...


def skin_for(measure: float, reach: float) -> float:
    """Give the skin of a boundary of some size (its least measure) whose points lie up to ``reach`` off the origin.

    It never falls below what float64 can tell apart there.
    """
    return max(SKIN * measure, 64.0 * float(np.finfo(np.float64).eps) * reach)
