"""How a surface is grown, apart from its rules: the ``growth:`` section of an island of surfaces."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from genome.settings import Settings, Vector3
from growth.protocol import Budget


class SurfaceGrowth(Settings):
    """Settings of the growth of a HEMLS surface (Hemberg 2006, section 4.3).

    Attributes
    ----------
    steps
        Derivation steps; 0 leaves the seed.
    scale
        Factor by which the surface grows about its centre in each step; under 1 it shrinks.
    start_length
        Side length of the seed polygon.
    place
        Centre of the seed polygon.
    branch_distance
        The farthest apart that two branch points may lie and still be joined; ``None`` sets no limit.
    max_elements
        The most edges at any moment; a form that needs more is invalid.
    max_pairs
        The most pairs of branches that one joining may compare; a form that needs more is invalid.
    max_seconds
        The clock behind the budget, a safety net.
    """

    steps: Annotated[int, Field(ge=0, le=64)] = 4
    scale: Annotated[float, Field(gt=0, le=100)] = 1.5
    start_length: Annotated[float, Field(ge=1e-6, le=1e6)] = 1.0
    place: Vector3 = (0.0, 0.0, 0.0)
    branch_distance: Annotated[float, Field(gt=0)] | None = None
    max_elements: Annotated[int, Field(ge=3, le=20_000_000)] = 50_000
    max_pairs: Annotated[int, Field(ge=1, le=20_000_000)] = 2_000_000
    max_seconds: Annotated[float, Field(gt=0)] = 30.0

    @property
    def budget(self) -> Budget:
        """The budget that these settings set."""
        return Budget(elements=self.max_elements, pairs=self.max_pairs, seconds=self.max_seconds)
