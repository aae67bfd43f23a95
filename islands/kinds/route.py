"""The island kind ``route``: ways through the space, whose partners are the space and the walls around it."""

from __future__ import annotations

from typing import ClassVar, final

from evaluators.symbiosis import Role
from genome.settings import Settings
from growth.protocol import Clock
from islands.kinds.symbiosis import SpeciesGrowth, SymbiosisBiology
from islands.kinds.symbiotic import SymbioticKind
from islands.spec import IslandSpec


@final
class RouteKind(SymbioticKind):
    """The kind ``route``."""

    name: ClassVar[str] = "route"
    growth: ClassVar[type[Settings]] = SpeciesGrowth
    partners: ClassVar[tuple[Role, ...]] = ("enclosure", "space")

    @property
    def role(self) -> Role:
        """Which species it is."""
        return "route"

    def build(self, spec: IslandSpec, clock: Clock) -> SymbiosisBiology:
        """Make the site and find the criteria."""
        return SymbiosisBiology(self.role, spec, SpeciesGrowth.model_validate(dict(spec.growth)), clock)
