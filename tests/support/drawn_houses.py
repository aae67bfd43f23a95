"""Drawn houses of every tiling, laid out for a brief, for the tests of drawings."""

from __future__ import annotations

from typing import Any

import numpy as np

from evaluators.plans import Brief, Layout, laid_out
from genome.polyform import Assembly, Part
from growth.polyforms import TILINGS, Plan, draw_assembly, draw_room, form_of

SIZES = {"living": 14, "kitchen": 6, "entrance": 4, "hall": 3, "master_bedroom": 9, "bathroom": 4}
ADJACENCIES = [["entrance", "living"], ["living", "kitchen"], ["hall", "bathroom"], ["entrance", "hall"],
               ["hall", "master_bedroom"], ["living", "hall"], ["kitchen", "entrance"]]  # fmt: skip
WISHES: dict[str, dict[str, Any]] = {
    "living": {"daylight": True, "facing": ["south"]},
    "master_bedroom": {"daylight": True, "private": True},
    "kitchen": {"view": True},
}
PLANE = ("square", "triangle", "hexagon")


def house(tiling: str, seed: int, **brief: Any) -> Layout:
    rng, cells = np.random.default_rng(seed), TILINGS[tiling]
    drawn = draw_assembly([Part(k, draw_room(size, cells, rng)) for k, size in enumerate(SIZES.values())], cells, rng)
    assert isinstance(drawn, Assembly)
    plan = form_of(drawn, cells)
    assert isinstance(plan, Plan)
    rooms = {name: {"cells": size, **WISHES.get(name, {})} for name, size in SIZES.items()}
    given = {"tiling": tiling, "rooms": rooms, "adjacencies": ADJACENCIES, "entrance": "entrance", **brief}
    return laid_out(plan, Brief.model_validate(given))
