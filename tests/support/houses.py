"""Small briefs, parts for their islands, and a kind of house that has its parts from the beginning."""

from __future__ import annotations

from typing import Any

import numpy as np
from archipelagos import spec

from genome.polyform import Assembly, Part, Room
from growth.polyforms import SQUARE, draw_assembly, draw_room
from islands.kinds.assemblies import AssemblyBiology
from islands.kinds.house import HouseKind
from islands.kinds.parts import part_text
from islands.migration.channel import Migrant

BRIEF: dict[str, Any] = {
    "rooms": {"hall": {"cells": 3}, "living": {"cells": 6}, "bed": {"cells": 4}, "bath": {"cells": 2}},
    "adjacencies": [["hall", "living"], ["hall", "bed"], ["bed", "bath", 2]],
    "entrance": "hall",
}
ZONES = {"day": ["hall", "living"], "night": ["bed", "bath"]}
SUPPLIED_HOUSE: dict[str, Any] = {
    "kind": "house",
    "genome": {"parts": ZONES},
    "growth": {"brief": BRIEF},
    "fitness": {"adjacency": {"goal": "minimise"}},
}


def room(cells: int, rng: np.random.Generator) -> Room:
    return draw_room(cells, SQUARE, rng)


def zone(sizes: list[int], rng: np.random.Generator) -> Assembly:
    found = draw_assembly([Part(size, room(size, rng)) for size in sizes], SQUARE, rng)
    assert isinstance(found, Assembly)
    return found


def migrant(identity: int, text: str) -> Migrant:
    return Migrant(identity, text, 0.0, (), "")


def zones(count: int, seed: int = 1) -> tuple[Migrant, ...]:
    """Give so many zones of each name, of the small brief."""
    rng = np.random.default_rng(seed)
    sizes = {name: [BRIEF["rooms"][one]["cells"] for one in own] for name, own in ZONES.items()}
    return tuple(
        migrant(100 * place + number, part_text(name, zone(own, rng)))
        for place, (name, own) in enumerate(sizes.items(), start=1)
        for number in range(count)
    )


def house_spec(**growth: Any) -> Any:
    kind = HouseKind()
    whole = kind.growth.model_validate({"brief": BRIEF, **growth}).model_dump(mode="json")
    genome = kind.genome.model_validate({"parts": ZONES}).model_dump(mode="json")
    return spec(**{**SUPPLIED_HOUSE, "genome": genome, "growth": whole})


class SuppliedHouseKind:
    """As the kind ``house``, with parts that have risen already."""

    name = "house"
    genome = HouseKind.genome
    growth = HouseKind.growth

    def build(self, given, clock) -> AssemblyBiology:
        return HouseKind().build(given, clock).supplied(zones(4))

    def keep_files(self, given, keep):
        return HouseKind().keep_files(given, keep)
