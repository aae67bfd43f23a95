"""Cells of one species as they travel on channels of partners: JSON of role, lattice and cells."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from evaluators.symbiosis import ROLES, Role
from genome.errors import InputError
from genome.settings import describe
from growth.blocks.lattice import SQUARE, Ints, Lattice
from growth.blocks.settings import FARTHEST
from islands.kinds.bodies import plain


def cells_text(role: Role, lattice: Lattice, cells: Ints) -> str:
    """Write cells (n, 3) in the order of growth."""
    data = {"role": role, "lattice": lattice.name, "cells": cells.tolist()}
    return json.dumps(data, separators=(",", ":"))


def read_cells_text(text: str, lattice: Lattice) -> tuple[Role, Ints]:
    """Read what :func:`cells_text` wrote of cells of this lattice: whose they are, and (n, 3) int64, read-only.

    Raises
    ------
    InputError
        For anything else.
    """
    match plain(text):
        case {"role": str(role), "lattice": str(name), "cells": [*rows], **more} if (
            role in ROLES and name == lattice.name and not more and _are_cells(rows)
        ):
            cells = np.array(rows, dtype=np.int64)
            if _are_of(lattice, cells):
                cells.flags.writeable = False
                return role, cells
    raise InputError("partner", f"cells of a species on the lattice {lattice.name}", describe(text))


def _are_cells(rows: list[Any]) -> bool:
    """Tell whether rows are cells, at least one: three whole numbers each, none too far away."""
    return bool(rows) and all(
        isinstance(row, list) and len(row) == 3 and all(type(one) is int and abs(one) <= 2 * FARTHEST for one in row)
        for row in rows
    )


def _are_of(lattice: Lattice, cells: Ints) -> bool:
    """Tell whether a lattice has these cells, and each is there once."""
    if lattice.parity and (cells.sum(axis=1) % 2).any():
        return False
    if lattice is SQUARE and cells[:, 2].any():
        return False
    return len(np.unique(cells, axis=0)) == len(cells)
