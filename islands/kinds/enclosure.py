"""The island kind ``enclosure``: walls, whose partners are the space that they surround (Senatore 2009)."""

from __future__ import annotations

from typing import ClassVar, final

from evaluators.symbiosis import Role
from genome.settings import Settings
from growth.protocol import Clock
from islands.kinds.symbiosis import SpeciesGrowth, SymbiosisBiology
from islands.kinds.symbiotic import SymbioticKind
from islands.spec import IslandSpec


@final
class EnclosureKind(SymbioticKind):
    """The kind ``enclosure``."""

    name: ClassVar[str] = "enclosure"
    growth: ClassVar[type[Settings]] = SpeciesGrowth
    partners: ClassVar[tuple[Role, ...]] = ("space",)

    @property
    def role(self) -> Role:
        """Which species it is."""
        return "enclosure"

    def build(self, spec: IslandSpec, clock: Clock) -> SymbiosisBiology:
        """Make the site and find the criteria."""
        return SymbiosisBiology(self.role, spec, SpeciesGrowth.model_validate(dict(spec.growth)), clock)
