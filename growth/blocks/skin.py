"""The outer faces of block bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from growth.blocks.body import BOUNDARY, ENVELOPE, INTERNAL, Body
from growth.blocks.lattice import Ints, Lattice
from growth.surface import Surface

LABELS = ("block",)
"""All edges of a skin are of one sort."""


class Skin(NamedTuple):
    """Outer faces, and whose they are.

    Attributes
    ----------
    surface
        Quadrangles that look outwards, in the order of their cells.
    owners
        (F,) int64, the place in the body's cells of the cell that each face belongs to.
    """

    surface: Surface
    owners: Ints


def body_surface(body: Body, systems: Sequence[int] = (INTERNAL, ENVELOPE, BOUNDARY)) -> Surface:
    """Give the outer faces of a body.

    Parameters
    ----------
    body
        Any body.
    systems
        The systems that count; cells of the others are as if they were not there.

    Returns
    -------
    Surface
        Closed: along every edge as many faces run one way as the other, two where the body is a manifold and four where
        two cells touch in the edge alone. Without cells it has no faces.
    """
    return skin(body, systems).surface


def skin(body: Body, systems: Sequence[int] = (INTERNAL, ENVELOPE, BOUNDARY)) -> Skin:
    """Give the outer faces of a body and whose they are; see :func:`body_surface`."""
    lattice = body.lattice
    chosen = np.flatnonzero(np.isin(body.systems, list(systems)))
    cells = body.cells[chosen]
    corners, ways = _doubled(lattice)
    bare = np.stack([~_among(cells + way, cells) for way in ways], axis=1)
    cell, face = np.nonzero(bare.reshape(len(cells), len(ways)))
    places = 2 * cells[cell][:, None, :] + corners[face]
    points, ring = np.unique(places.reshape(-1, 3), axis=0, return_inverse=True)
    rings = ring.reshape(-1, 4).astype(np.int32)
    ends = np.sort(np.stack([rings, np.roll(rings, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges = np.unique(ends, axis=0)
    surface = Surface(
        vertices=points / 2.0,
        edges=edges,
        labels=np.zeros(len(edges), dtype=np.int32),
        label_names=LABELS,
        face_starts=np.arange(0, 4 * len(rings) + 1, 4, dtype=np.int32),
        face_vertices=rings.reshape(-1),
    )
    return Skin(surface, chosen[cell])


def _doubled(lattice: Lattice) -> tuple[Ints, Ints]:
    """Give twice the corners of each face of the cell at the origin, (f, 4, 3), and the cell behind each, (f, 3)."""
    corners = np.rint(2.0 * lattice.corners[np.array(lattice.faces)]).astype(np.int64)
    return corners, corners.sum(axis=1) // 4


def _among(cells: Ints, others: Ints) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Say of each of (n, 3) cells whether it is one of (m, 3) others."""
    both = np.concatenate([cells, others])
    low = both.min(axis=0, initial=0)
    span = both.max(axis=0, initial=0) - low + 1
    keys = ((both - low) * [1, span[0], span[0] * span[1]]).sum(axis=1)
    return np.isin(keys[: len(cells)], keys[len(cells) :])
