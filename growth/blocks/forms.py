"""Block bodies as files: GLB with a material for each system, OBJ, STL, and a grid of voxels (NumPy ``.npz``).

GLB has y up, the others z. The same body gives the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from genome.errors import InputError
from genome.files import write_whole
from growth.blocks.body import BOUNDARY, ENVELOPE, INTERNAL, SYSTEMS, Body
from growth.blocks.lattice import Floats
from growth.blocks.parts import Part, glb, obj, voxels
from growth.blocks.skin import skin
from growth.forms import to_trimesh

Extras = Mapping[str, str | float | bool]

COLOURS: Final = {INTERNAL: (214, 118, 82, 255), ENVELOPE: (150, 178, 196, 70), BOUNDARY: (126, 122, 114, 255)}
"""Base colours of the materials: fired clay, glass, stone."""


def write_form(
    body: Body, path: Path, title: str = "", extras: Extras | None = None, forces: Floats | None = None
) -> None:
    """Write a body to a file, whole or not at all.

    Parameters
    ----------
    body
        What to write.
    path
        The file; its suffix chooses the format: ``.glb``, ``.obj``, ``.stl`` or ``.npz``.
    title, extras
        What the form is, kept in GLB (scene extras), OBJ (comments) and the grid (JSON); STL has no place for it.
    forces
        (n,) float64 from 0 to 1, one for each of the body's cells: shown as colours of vertices in GLB and OBJ, a grid
        of its own beside the voxels, left out of STL.

    Raises
    ------
    InputError
        When the suffix is unknown, there are no cells, forces are not one from 0 to 1 a cell, the grid would be too
        large, or the folder cannot be written to.
    """
    writer = WRITERS.get(path.suffix.lower())
    if writer is None:
        got = f"'{path.suffix}'" if path.suffix else "none"
        raise InputError(str(path), f"a block body's suffix ({', '.join(WRITERS)})", got, "choose one of these")
    if not len(body.cells):
        raise InputError(str(path), "a body with cells to write", "none")
    if forces is not None:
        right = forces.shape == (len(body.cells),) and bool(((forces >= 0.0) & (forces <= 1.0)).all())
        if not right:
            raise InputError(str(path), "forces from 0 to 1, one a cell", "others")
    words: dict[str, Any] = {"title": title} if title else {}
    write_whole(path, writer(body, {**words, **(extras or {})}, forces))


def _parts(body: Body) -> list[Part]:
    """Give each system that has cells, with its own skin."""
    return [
        Part(SYSTEMS[system], skin(body, [system]), colour, system == ENVELOPE)
        for system, colour in COLOURS.items()
        if (body.systems == system).any()
    ]


def _glb(body: Body, extras: Mapping[str, Any], forces: Floats | None) -> bytes:
    return glb(_parts(body), extras, forces)


def _obj(body: Body, extras: Mapping[str, Any], forces: Floats | None) -> bytes:
    return obj(_parts(body), extras, forces)


def _stl(body: Body, extras: Mapping[str, Any], forces: Floats | None) -> bytes:
    from trimesh.exchange.stl import export_stl

    del extras, forces  # a binary STL file has no place for them
    return bytes(export_stl(to_trimesh(skin(body).surface)))


def _npz(body: Body, extras: Mapping[str, Any], forces: Floats | None) -> bytes:
    """Write 1 + the system of each cell."""
    return voxels(body.cells, body.systems + np.uint8(1), body.lattice, extras, forces)


WRITERS: Final[Mapping[str, Callable[[Body, Mapping[str, Any], Floats | None], bytes]]] = {
    ".glb": _glb,
    ".obj": _obj,
    ".stl": _stl,
    ".npz": _npz,
}
"""How each suffix is written."""
