"""What the kinds of species that evolve by each other share: who is whose partner, and what they give and take."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

from evaluators.symbiosis import ROLES, Role
from genome.lsystem import LSystemGenome
from genome.settings import Settings
from growth.protocol import Clock
from islands.kinds.environments import kept_environment
from islands.kinds.meshes import MESH
from islands.kinds.protocol import Keep
from islands.kinds.symbiosis import SymbiosisBiology
from islands.migration.channel import ChannelKind
from islands.spec import IslandSpec


class SymbioticKind(ABC):
    """A kind of one of the species.

    Attributes
    ----------
    partners
        The species that an individual cannot be scored without.
    """

    genome: ClassVar[type[Settings]] = LSystemGenome
    variation: ClassVar[frozenset[str]] = frozenset({"crossover", "mutations"})
    needs: ClassVar[tuple[ChannelKind, ...]] = ("partners",)
    partners: ClassVar[tuple[Role, ...]]

    @property
    @abstractmethod
    def role(self) -> Role:
        """Which species it is."""

    def gives(self, spec: IslandSpec) -> Mapping[ChannelKind, str]:
        """Give cells to partners; walls give their outer skin to surroundings."""
        given: dict[ChannelKind, str] = {"partners": _cells(self.role, spec)}
        return given | {"surroundings": MESH} if self.role == "enclosure" else given

    def takes(self, spec: IslandSpec) -> Mapping[ChannelKind, tuple[str, ...]]:
        """Take the cells of other species on the same lattice as partners, and closed meshes as surroundings."""
        others = tuple(_cells(role, spec) for role in ROLES if role != self.role)
        return {"partners": others, "surroundings": (MESH,)}

    def needed(self, spec: IslandSpec) -> Mapping[ChannelKind, tuple[str, ...]]:
        """Give the partners that it cannot do without."""
        return {"partners": tuple(_cells(role, spec) for role in self.partners)}

    def compile_kernels(self) -> None:
        """Compile the growth's, the environment's and the criteria's."""
        from evaluators.symbiosis.warm import compile_kernels as compile_measures
        from growth.blocks.warm import compile_kernels as compile_growth
        from growth.environment.warm import compile_kernels as compile_environment

        compile_growth()
        compile_environment()
        compile_measures()

    @abstractmethod
    def build(self, spec: IslandSpec, clock: Clock) -> SymbiosisBiology:
        """Make the site and find the criteria."""

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep the environment's file of the site, and the meshes that it names."""
        growth = dict(spec.growth)
        site = dict(growth["site"])
        if site.get("environment") is not None:
            site["environment"] = kept_environment(spec, site["environment"], keep, "growth", "site", "environment")
        return spec.genome, growth | {"site": site}


def _cells(role: Role, spec: IslandSpec) -> str:
    return f"{role} on {spec.growth['lattice']}"
