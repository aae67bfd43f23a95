"""The island kind ``space``: the space that is used, whose partners are the walls around it (Senatore 2009)."""

from __future__ import annotations

from typing import Annotated, ClassVar, final

from pydantic import Field

from evaluators.symbiosis import Role
from genome.settings import Settings
from growth.protocol import Clock
from islands.kinds.symbiosis import SpeciesGrowth, SymbiosisBiology
from islands.kinds.symbiotic import SymbioticKind
from islands.spec import IslandSpec


class SpaceGrowth(SpeciesGrowth):
    """Settings of growth on an island of space: those of all species, with a least volume.

    Without one a single cell wins, since it is easily surrounded (semantics 5).
    """

    least: Annotated[int, Field(ge=1)] = 8


@final
class SpaceKind(SymbioticKind):
    """The kind ``space``."""

    name: ClassVar[str] = "space"
    growth: ClassVar[type[Settings]] = SpaceGrowth
    partners: ClassVar[tuple[Role, ...]] = ("enclosure",)

    @property
    def role(self) -> Role:
        """Which species it is."""
        return "space"

    def build(self, spec: IslandSpec, clock: Clock) -> SymbiosisBiology:
        """Make the site and find the criteria."""
        return SymbiosisBiology(self.role, spec, SpaceGrowth.model_validate(dict(spec.growth)), clock)
