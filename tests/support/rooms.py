"""Enclosures, spaces and routes for tests: given cells, written genotypes, experiments."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from archipelagos import spec
from block_bodies import system

from growth.blocks.lattice import CUBIC, Lattice
from islands.kinds.cells import cells_text
from islands.kinds.enclosure import EnclosureKind
from islands.kinds.route import RouteKind
from islands.kinds.space import SpaceKind
from islands.kinds.symbiosis import SymbiosisBiology
from islands.migration.channel import Migrant

SPECIES = {"enclosure": EnclosureKind, "space": SpaceKind, "route": RouteKind}

CUBE = system("axiom: FF&&FF&&FF\niterations: 0\n")
"""Grows seven cells of a ring of eight around (1, 0, 1), counter to the clock from the origin, up first."""


def grid(low: int, high: int, floors: tuple[int, int] | None = None) -> list[tuple[int, int, int]]:
    """The cells of a cube, or of a storey of it."""
    side = range(low, high + 1)
    return list(itertools.product(side, side, side if floors is None else range(floors[0], floors[1] + 1)))


ROOM = grid(-1, 1)
SHELL = [cell for cell in grid(-2, 2) if cell not in ROOM]
"""A solid 3x3x3 of space, and its closed shell of 98 cells."""


def partner(role: str, cells, identity: int = 9, lattice: Lattice = CUBIC) -> Migrant:
    return Migrant(identity, cells_text(role, lattice, np.array(cells)), 1.0, (), "")


def species_spec(role: str, fitness: Any = None, **growth: Any):
    """Give an island of a species with every default written out, as the orchestrator does."""
    kind = SPECIES[role]
    return spec(
        kind=role,
        genome=kind.genome.model_validate({}).model_dump(mode="json"),
        growth=kind.growth.model_validate(growth).model_dump(mode="json"),
        fitness=fitness or {"symbiotic": {"goal": "maximise"}},
    )


def species(role: str, fitness: Any = None, **growth: Any) -> SymbiosisBiology:
    return SPECIES[role]().build(species_spec(role, fitness, **growth), lambda: 0.0)


def house(**changes: Any) -> dict[str, Any]:
    """An experiment of two islands of walls and two of rooms, each pair of them partners."""
    goals = {"symbiotic": {"goal": "maximise"}, "economy": {"goal": "maximise"}}
    data: dict[str, Any] = {
        "name": "house",
        "seed": 5,
        "epochs": 3,
        "epoch": 2,
        "backend": "inline",
        "defaults": {"count": 2, "population": 6, "growth": {"max_blocks": 60}},
        "islands": {
            "walls": {"kind": "enclosure", "fitness": goals},
            "rooms": {"kind": "space", "growth": {"least": 3}, "fitness": goals},
        },
        "channels": [
            {"topology": "ring", "among": "walls"},
            {"topology": "ring", "among": "rooms"},
            {"kind": "partners", "from": "rooms", "to": "walls", "join": "matching"},
            {
                "kind": "partners", "from": "walls", "to": "rooms", "join": "matching",
                "count": 2, "pairing": "several", "pairings": 2,
            },
        ],
    }  # fmt: skip
    return {**data, **changes}
