"""Block bodies for tests of islands: written genotypes, skeletons by hand, experiments."""

from __future__ import annotations

from typing import Any

import numpy as np
from archipelagos import spec

from genome.lsystem import LSystem, parse_blocks
from islands.kinds.blocks import BlocksBiology, BlocksKind

COLUMN = "axiom: F\niterations: 2\nF -> FF\n"
"""Grows five blocks on top of each other."""

FIRST = np.array([(0, 0, 0), (0, 0, 1), (0, 0, 2), (1, 0, 2), (2, 0, 2)])
SECOND = np.array([(5, 0, 0), (5, 0, 1), (5, 0, 2), (4, 0, 2), (3, 0, 2)])
"""Two brackets that lean on each other: each by itself carries a moment of 3 at its foot, together they carry none."""

LEANING = "axiom: FF&&FF\niterations: 0\n"
"""Grows :data:`FIRST`."""

FACING = "axiom: FF^^FF\niterations: 0\n"
"""Grows :data:`SECOND`, from where it starts."""


def system(text: str) -> LSystem:
    return parse_blocks(text, "test.blocks")


def block_spec(**changes: Any):
    """Give an island of blocks with every default written out, as the orchestrator does."""
    made = {"kind": "blocks", "genome": {}, "growth": {}, "fitness": {"height": {"goal": "maximise"}}, **changes}
    made["genome"] = BlocksKind.genome.model_validate(made["genome"]).model_dump(mode="json")
    made["growth"] = BlocksKind.growth.model_validate(made["growth"]).model_dump(mode="json")
    return spec(**made)


def blocks(clock=lambda: 0.0, **growth: Any) -> BlocksBiology:
    fitness = growth.pop("fitness", {"height": {"goal": "maximise"}})
    return BlocksKind().build(block_spec(growth=growth, fitness=fitness), clock)


def building(**changes: Any) -> dict[str, Any]:
    """An experiment of two small islands of bodies under load."""
    data: dict[str, Any] = {
        "name": "building",
        "seed": 3,
        "epochs": 3,
        "epoch": 2,
        "backend": "inline",
        "islands": {
            "tower": {
                "kind": "blocks",
                "count": 2,
                "population": 8,
                "growth": {"max_blocks": 60, "load": {"axial_strength": 60, "torsion_strength": 20}},
                "fitness": {"height": {"goal": "maximise", "scale": 10}, "stability": {"goal": "maximise"}},
                "algorithm": {"name": "parents", "parents": 3, "longest_life": 4, "selection": "uniform"},
            }
        },
        "channels": [{"topology": "ring", "among": "tower"}],
    }
    return {**data, **changes}
