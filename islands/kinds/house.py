"""The island kind ``house``: zones conjoined to a plan (Rosenman 1997, section 3)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, final

from islands.kinds.assemblies import AssemblyKind
from islands.kinds.meshes import MESH
from islands.kinds.parts import DEMAND
from islands.migration.channel import ChannelKind
from islands.spec import IslandSpec


@final
class HouseKind(AssemblyKind):
    """The kind ``house``."""

    name: ClassVar[str] = "house"

    def gives(self, spec: IslandSpec) -> Mapping[ChannelKind, str]:
        """Give a demand to those below, and to other islands the solid that the house fills."""
        del spec
        return {"partners": DEMAND, "surroundings": MESH}
