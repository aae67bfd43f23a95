"""The island kinds by name. A new kind is one file here and one line of ``KINDS``."""

from __future__ import annotations

from typing import Final

from evaluators.plugins import find
from genome.errors import InputError
from islands.kinds.protocol import Kind

KINDS: Final = {
    "bits": "islands.kinds.bits:BitsKind",
    "block_pair": "islands.kinds.block_pair:BlockPairKind",
    "blocks": "islands.kinds.blocks:BlocksKind",
    "enclosure": "islands.kinds.enclosure:EnclosureKind",
    "house": "islands.kinds.house:HouseKind",
    "room": "islands.kinds.room:RoomKind",
    "route": "islands.kinds.route:RouteKind",
    "space": "islands.kinds.space:SpaceKind",
    "surface": "islands.kinds.surface:SurfaceKind",
    "timed": "islands.kinds.timed:TimedKind",
    "zone": "islands.kinds.zone:ZoneKind",
}
"""Built kinds and where they stand; imported when first used."""

GROUP: Final = "atoll.kinds"


def resolve_kind(name: str, where: str) -> Kind:
    """Give the island kind of this name, import path or entry point.

    Raises
    ------
    InputError
        When there is none, or what is there is no island kind.
    """
    found = find(name, where, "island kind", KINDS, GROUP)
    kind = found() if isinstance(found, type) else found
    if not isinstance(kind, Kind):
        missing = [part for part in ("name", "genome", "growth", "build", "keep_files") if not hasattr(kind, part)]
        got = f"'{name}', a {type(kind).__name__} without {', '.join(missing)}"
        raise InputError(where, "an island kind", got, "see CONTRIBUTING, 'adding an island kind'")
    return kind
