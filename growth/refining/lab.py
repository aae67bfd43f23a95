"""The door to pymeshlab: meshes in, meshes out, and one clear error where it cannot be used."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from genome.errors import InputError
from growth.protocol import Failure
from growth.refining.mesh import Mesh, area

PACKAGES: Final[Mapping[str, str]] = {"libGL.so.1": "libgl1", "libOpenGL.so.0": "libopengl0", "libEGL.so.1": "libegl1"}
"""Debian's packages of the libraries that pymeshlab looks for, by the file that it misses."""


def load() -> Any:  # noqa: ANN401 - pymeshlab has no types
    """Import pymeshlab.

    Raises
    ------
    InputError
        When it, or a library that it needs, is not on this machine; it names the package to install.
    """
    try:
        import pymeshlab
    except ImportError as error:
        raise _missing(error) from None
    return pymeshlab


def _missing(error: ImportError) -> InputError:
    """Say what to install."""
    expected = "pymeshlab, which refines meshes"
    if isinstance(error, ModuleNotFoundError) and error.name == "pymeshlab":
        return InputError("refine", expected, "it is not installed", "install it: pip install pymeshlab")
    library = re.search(r"[\w.+-]+\.so[.\d]*", str(error))
    if library is None:
        return InputError("refine", expected, f"it does not load: {error}", "see docs/refining.md")
    package = PACKAGES.get(library.group())
    remedy = f"apt-get install {package}" if package else f"install the package that holds {library.group()}"
    return InputError("refine", expected, f"this machine lacks {library.group()}, which it needs", remedy)


FLAT: Final = 1e-12
"""Of the diagonal squared: forms of less area have none, and filters stumble over them."""

Filter = tuple[str, Mapping[str, Any]]
"""A filter of pymeshlab by its name, and its parameters."""


def filtered(mesh: Mesh, *filters: Filter) -> Mesh | Failure:
    """Send a mesh through filters of pymeshlab.

    Parameters
    ----------
    mesh
        What they change.
    filters
        In their order. The mesh that is current after the last one is taken.

    Returns
    -------
    Mesh or Failure
        A failure has the reason ``refining``: a filter refused the mesh, or nothing was left of it.
    """
    lab = load()
    if not area(mesh) > FLAT * mesh.diagonal**2:
        return Failure("refining", f"{filters[0][0]}: the form has no area")
    session = lab.MeshSet()
    session.add_mesh(lab.Mesh(mesh.vertices, mesh.triangles))
    for name, parameters in filters:
        try:
            session.apply_filter(name, **parameters)
        except lab.PyMeshLabException as error:
            return Failure("refining", f"{name}: {' '.join(str(error).split())}")
        if not session.current_mesh().face_number():
            return Failure("refining", f"{name}: nothing was left of the form")
    found = session.current_mesh()
    vertices = np.array(found.vertex_matrix(), dtype=np.float64).reshape(-1, 3)
    triangles = np.array(found.face_matrix(), dtype=np.int32).reshape(-1, 3)
    return Mesh(vertices, triangles)


def length(value: float) -> Any:  # noqa: ANN401 - pymeshlab has no types
    """Give a length in the form's unit, as parameters take it; a plain number they read as a share of the diagonal."""
    return load().PureValue(value)
