"""The ``.body.json`` file: a block body given cell by cell."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from genome.errors import InputError
from genome.settings import describe, near
from growth.blocks.body import Body
from growth.blocks.engine import stand
from growth.blocks.lattice import LATTICES
from growth.blocks.settings import BlockGrowth, Cell, as_cells, check_on_lattice

_KEYS: Final = ("cells", "supports", "lattice")


def read_body(path: Path, growth: BlockGrowth | None = None) -> Body:
    """Read a body; see :func:`read_given`."""
    return read_given(path, growth)[0]


def read_given(path: Path, growth: BlockGrowth | None = None) -> tuple[Body, BlockGrowth]:
    """Read a body, and the growth whose ground, or supports, parts of it stand on.

    Parameters
    ----------
    path
        A file ``{"cells": [[x, y, z], ...], "supports": [[x, y, z], ...], "lattice": "cubic"}``; without supports the
        body stands on a ground, without a lattice it is cubic.
    growth
        Ground and envelope; the defaults where not given. Supports and lattice are the file's.

    Returns
    -------
    body
        Its skeleton is the file's cells in their order.
    growth
        As given, with the file's lattice and supports.

    Raises
    ------
    InputError
        When the file is not there or is no body: cells given twice, in a support, or not of the lattice.
    """
    data = _loaded(path)
    for key in data:
        if key not in _KEYS:
            raise InputError(f"{path}: {key}", "a known key", describe(key), near(key, list(_KEYS)))
    lattice = data.get("lattice", "cubic")
    if not isinstance(lattice, str) or lattice not in LATTICES:
        raise InputError(f"{path}: lattice", f"one of {', '.join(LATTICES)}", describe(lattice))
    if "cells" not in data:
        raise InputError(str(path), "a list of cells under 'cells'", "none", "add the key")
    cells = _cells(data["cells"], lattice, f"{path}: cells")
    supports = None
    if data.get("supports") is not None:
        supports = _cells(data["supports"], lattice, f"{path}: supports")
        held = frozenset(supports)
        for cell in cells:
            if cell in held:
                raise InputError(f"{path}: cells", "cells that are no supports", f"{list(cell)}, which is one")
    growth = (growth or BlockGrowth()).model_copy(update={"lattice": lattice, "supports": supports})
    return stand(np.array(cells, dtype=np.int64), growth), growth


def _loaded(path: Path) -> dict[str, Any]:
    try:
        data = json.loads(path.read_text(encoding="utf-8-sig"), object_pairs_hook=partial(_once, path))
    except InputError:
        raise
    except FileNotFoundError:
        raise InputError(str(path), "a body's file", "no such file", "check the path") from None
    except OSError as error:
        raise InputError(str(path), "a body's file", error.strerror or str(error)) from None
    except json.JSONDecodeError as error:
        raise InputError(f"{path}:{error.lineno}:{error.colno}", "JSON", f"an error in it: {error.msg}") from None
    except (ValueError, RecursionError):
        raise InputError(str(path), "a body as JSON in UTF-8", "something else") from None
    if not isinstance(data, dict):
        raise InputError(str(path), "a JSON object with the key 'cells'", describe(data))
    return data


def _once(path: Path, pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Make an object of its keys and values; a key that is given twice is a mistake, whichever of them was meant."""
    data = dict(pairs)
    if len(data) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise InputError(str(path), "each key once", f"'{twice}' twice")
    return data


def _cells(value: object, lattice: str, where: str) -> tuple[Cell, ...]:
    try:
        cells = as_cells(value)
        for cell in cells:
            check_on_lattice(cell, LATTICES[lattice])
    except InputError as error:
        raise InputError(where, error.expected, error.got, error.remedy) from None
    return cells
