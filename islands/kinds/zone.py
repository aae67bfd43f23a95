"""The island kind ``zone``: rooms that belong together, conjoined (Rosenman 1997, section 3)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, final

from islands.kinds.assemblies import AssemblyKind
from islands.kinds.parts import DEMAND
from islands.kinds.room import part_of
from islands.migration.channel import ChannelKind
from islands.spec import IslandSpec


@final
class ZoneKind(AssemblyKind):
    """The kind ``zone``."""

    name: ClassVar[str] = "zone"

    def gives(self, spec: IslandSpec) -> Mapping[ChannelKind, str]:
        """Give a part to those above, a demand to those below."""
        return {"components": f"part {part_of(spec)}", "partners": DEMAND}
