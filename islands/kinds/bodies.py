"""What the kinds of block bodies share: their growth settings, and the way from a body to its scores."""

from __future__ import annotations

import json
from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Any, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator

from evaluators.blocks import BLOCK_CRITERIA, Structure, resolve, score
from evaluators.blocks.load import LoadSettings, grown_under_load, loaded_throughout
from evaluators.blocks.load.layers import layers
from genome.errors import InputError
from genome.settings import describe
from growth.blocks import BlockGrowth
from growth.blocks.body import ENVELOPE, INTERNAL, Body
from growth.blocks.settings import as_cell, check_on_lattice
from growth.protocol import Failure
from islands.kinds.measures import Criteria

Cells = NDArray[np.int64]

COSTLY: Final = ("particles", "sun")
"""Criteria that take longer than all others together, and are measured where they have a goal."""

BODIES: Final = Criteria(tuple(name for name in BLOCK_CRITERIA if name not in COSTLY), resolve, score)
"""How bodies under load are measured."""

Cell = Annotated[tuple[int, int, int], BeforeValidator(as_cell)]


class BlockLoad(LoadSettings):
    """Settings of the load on an island's bodies: those of the analysis, and whether a body has to stand.

    ``required`` makes a body that fails at any stage of its growth invalid; without it such a body is scored as well.
    One that touches no ground, or of which a part floats, is invalid in any case.
    """

    required: bool = True


def structure_of(body: Body, growth: BlockGrowth, load: BlockLoad) -> Structure | Failure:
    """Load a body as it grew.

    Returns
    -------
    Structure or Failure
        ``single`` for one block alone, ``ground`` for a body that touches none, ``floating`` for parts that are joined
        to no ground; what the analysis says where a body has to stand and does not.
    """
    count = len(body.internal)
    if count < 2:
        return Failure("single", f"a body of {count} block{'s' if count != 1 else ''}, at least two make a structure")
    if not len(body.boundary):
        return Failure("ground", "the body touches no ground")
    floating = layers(body, envelope_counts=load.envelope_counts).floating
    if floating.size:
        x, y, z = body.cells[int(floating[0])].tolist()
        return Failure("floating", f"{floating.size} blocks are joined to no ground, one at ({x},{y},{z})")
    found = grown_under_load(body, growth, load)
    if isinstance(found, Failure):
        if load.required or found.reason != "unstable":
            return found
        found = loaded_throughout(body, growth, load)
    return Structure(body, found)


def is_stable(body: Body, growth: BlockGrowth, load: BlockLoad) -> bool:
    """Tell whether a body stands on some ground at all stages of its growth."""
    return len(body.boundary) > 0 and not isinstance(grown_under_load(body, growth, load), Failure)


def moved(cells: Cells, start: Sequence[int]) -> Cells:
    """Give cells (n, 3) that grew from the origin as they grow from another cell."""
    return np.asarray(cells + np.array(start, dtype=np.int64))


def check_start(start: Sequence[int], growth: BlockGrowth, where: str) -> None:
    """Refuse a start that is no cell of the lattice.

    Raises
    ------
    InputError
        For a sum of coordinates that is odd where the lattice has even ones alone.
    """
    x, y, z = start
    try:
        check_on_lattice((x, y, z), growth.cells)
    except InputError as error:
        raise InputError(where, error.expected, error.got, error.remedy) from None


def body_text(body: Body) -> str:
    """Write the skeleton of a body as it travels on channels of partners: lattice and cells, in the order of growth."""
    data = {"lattice": body.lattice.name, "cells": body.internal.tolist()}
    return json.dumps(data, separators=(",", ":"))


def read_body_text(text: str, lattice: str) -> Cells:
    """Read the cells, (n, 3) int64, of what :func:`body_text` wrote of a body on this lattice.

    Raises
    ------
    InputError
        For anything else.
    """
    match plain(text):
        case {"lattice": str(name), "cells": [*rows], **more} if name == lattice and rows and not more:
            return np.array([as_cell(row) for row in rows], dtype=np.int64)
    raise InputError("body", f"a body on the lattice {lattice}, its cells in order of growth", describe(text))


def plain(text: str) -> Any:  # noqa: ANN401 - plain data
    """Read JSON; None where it is none."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return None


def outside_of(body: Body) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Give the outer faces of a body without its foundation: vertices (v, 3) and triangles (t, 3), fronts outward."""
    from growth.blocks.skin import body_surface

    surface = body_surface(body, (INTERNAL, ENVELOPE))
    starts, ring = surface.face_starts, surface.face_vertices
    faces = [ring[start:end] for start, end in pairwise(starts)]
    triangles = [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]
    return surface.vertices, np.array(triangles, dtype=np.int32).reshape(-1, 3)
