"""Exposed surface: the area of a body that lies open to the air."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks import _kernels as kernels
from evaluators.blocks.structure import Structure
from growth.blocks.body import BOUNDARY
from growth.blocks.lattice import FACE, Lattice


def exposed_surface(structure: Structure) -> float:
    """Add the areas of the faces of internal and envelope blocks that no other block covers (Galasyn's high surface).

    Parameters
    ----------
    structure
        The boundary's own faces do not count; it covers those that it touches.

    Returns
    -------
    float
        In squares of the lattice's unit: 5 for a single cube on the ground, 4 n + 1 for a column of n.
    """
    body = structure.body
    built = body.systems != BOUNDARY
    pairs, kinds = kernels.touching(body.cells, body.lattice.offsets, body.lattice.contacts)
    covered = np.count_nonzero(built[pairs[kinds == FACE]])
    faces = np.count_nonzero(built) * len(body.lattice.faces)
    return float((faces - covered) * face_area(body.lattice))


def face_area(lattice: Lattice) -> float:
    """Give the area of one face; those of a lattice are all alike."""
    outline: NDArray[np.float64] = lattice.corners[list(lattice.faces[0])]
    fan = np.cross(outline[1:-1] - outline[0], outline[2:] - outline[0])
    return float(np.linalg.norm(fan.sum(axis=0)) / 2.0)
