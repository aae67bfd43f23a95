"""The layers of a body of blocks, counted from its foundation, and the parts that stand above each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks._kernels import touching
from evaluators.blocks.load._kernels import depths
from growth.blocks.body import BOUNDARY, ENVELOPE, Body

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

TURNING: Final = 1.0 / 12.0
"""A joint's moment per angle over its force per displacement: E I / L over E A / L of a unit block."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Layers:
    """Joints of what stands, by the depth of the blocks that they join.

    Attributes
    ----------
    joints
        (j, 2) int64, places in the body's cells; the lower layer first.
    kinds
        (j,) uint8, what the two blocks share (:data:`growth.blocks.lattice.FACE` and its kin).
    points
        (j, 3) float64, half way between the centres.
    depth
        (n,) int64, joints between each cell and the boundary; 0 for the boundary, -1 for cells that do not count or
        float.
    floating
        (m,) int64, cells that count and are joined to no boundary.
    """

    joints: Ints
    kinds: NDArray[np.uint8]
    points: Floats
    depth: Ints
    floating: Ints


def layers(body: Body, *, envelope_counts: bool = True) -> Layers:
    """Find the joints of a body and its layers: breadth first from the boundary (semantics.md, section 4).

    Parameters
    ----------
    body
        Its cells are all different.
    envelope_counts
        Whether blocks of the envelope are there.

    Returns
    -------
    Layers
        Without joints for a body without boundary, all of which floats. Joints within the boundary are left out.
    """
    places = np.flatnonzero((body.systems != ENVELOPE) | envelope_counts)
    cells = np.ascontiguousarray(body.cells[places])
    ground = np.ascontiguousarray(body.systems[places] == BOUNDARY)
    pairs, kinds = touching(cells, body.lattice.offsets, body.lattice.contacts)
    used = ~(ground[pairs[:, 0]] & ground[pairs[:, 1]])
    pairs, kinds = pairs[used], kinds[used]
    deep = depths(len(cells), pairs, ground)
    standing = deep[pairs[:, 0]] >= 0
    pairs, kinds = places[pairs[standing]], kinds[standing]
    depth = np.full(len(body.cells), -1, dtype=np.int64)
    depth[places] = deep
    swap = depth[pairs[:, 0]] > depth[pairs[:, 1]]
    pairs[swap] = pairs[swap][:, ::-1]
    points = (body.cells[pairs[:, 0]] + body.cells[pairs[:, 1]]) / 2.0
    return Layers(np.ascontiguousarray(pairs), kinds, points, depth, places[deep < 0].astype(np.int64))
