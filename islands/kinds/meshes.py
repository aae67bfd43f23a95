"""Forms that travel on channels of surroundings: a closed mesh as JSON text, its vertices and triangles."""

from __future__ import annotations

import json
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from genome.errors import InputError
from genome.settings import describe
from growth.environment.boundaries.files import closed

MESH: Final = "mesh"
"""What kinds that give or take such forms call them."""

LARGEST: Final = 1e9
"""Of a coordinate."""


def mesh_text(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> str:
    """Write a mesh.

    Parameters
    ----------
    vertices
        (v, 3) float64.
    triangles
        (t, 3), places in ``vertices``, fronts outward.
    """
    data = {"vertices": vertices.tolist(), "triangles": triangles.tolist()}
    return json.dumps(data, separators=(",", ":"), allow_nan=False)


def read_mesh_text(text: str, where: str) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Read a mesh: vertices (v, 3) float64 and triangles (t, 3) int32, closed, fronts outward.

    Parameters
    ----------
    text
        As :func:`mesh_text` writes it.
    where
        The place that an error names.

    Raises
    ------
    InputError
        For anything else, and for a mesh that is not closed.
    """
    expected = "a mesh as JSON: vertices and triangles"
    try:
        data: Any = json.loads(text)
    except (ValueError, RecursionError):
        raise InputError(where, expected, describe(text)) from None
    if not isinstance(data, dict) or sorted(data) != ["triangles", "vertices"]:
        raise InputError(where, expected, describe(data))
    try:
        vertices = np.array(data["vertices"], dtype=np.float64).reshape(-1, 3)
        triangles = np.array(data["triangles"], dtype=np.float64).reshape(-1, 3)
    except (TypeError, ValueError, OverflowError):
        raise InputError(where, "rows of three numbers", describe(data)) from None
    if not (np.abs(vertices) <= LARGEST).all():
        raise InputError(where, f"coordinates up to {LARGEST:g}", "another one")
    if not np.isin(triangles, np.arange(len(vertices))).all():
        raise InputError(where, f"triangles of vertices 0 to {len(vertices) - 1}", "another one")
    return closed(vertices, triangles.astype(np.int64), where)
