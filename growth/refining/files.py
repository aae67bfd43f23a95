"""Reading a form to refine: any mesh that trimesh loads."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from genome.errors import InputError
from growth.environment.boundaries.files import Y_UP, load_triangles
from growth.refining.mesh import Mesh


def read_form(path: Path) -> Mesh:
    """Read a form, open or closed; what a file contains is joined into one mesh, z up.

    Raises
    ------
    InputError
        When the file is missing, unreadable, without faces or not finite.
    """
    vertices, triangles = load_triangles(path, str(path), "check the path")
    if path.suffix.lower() in Y_UP:
        vertices = np.stack([vertices[:, 0], -vertices[:, 2], vertices[:, 1]], axis=1)
    if len(triangles) == 0:
        raise InputError(str(path), "a mesh with faces", "none")
    if not np.isfinite(vertices).all():
        raise InputError(str(path), "finite coordinates", "NaN or infinity", "repair the file")
    # Parts of an animation that are not there at its end have no extent: they are no part of the form.
    corners = vertices[triangles]
    kept = (corners != corners[:, :1]).any(axis=(1, 2))
    return Mesh(np.ascontiguousarray(vertices), triangles[kept].astype(np.int32))
