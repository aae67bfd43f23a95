"""Block bodies as files: GLB with a material for each system, OBJ, STL, and a grid of voxels (NumPy ``.npz``).

GLB has y up by its standard: it is turned here, (x, y, z) to (x, z, -y). The others keep z up. The same body gives the
same bytes.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from genome.errors import InputError
from genome.files import write_whole
from growth.blocks.body import BOUNDARY, ENVELOPE, INTERNAL, SYSTEMS, Body
from growth.blocks.skin import Skin, skin
from growth.forms import face_triangles, to_trimesh

if TYPE_CHECKING:
    import trimesh

Floats = NDArray[np.float64]
Extras = Mapping[str, str | float | bool]

COLOURS: Final = {INTERNAL: (214, 118, 82, 255), ENVELOPE: (150, 178, 196, 70), BOUNDARY: (126, 122, 114, 255)}
"""Base colours of the materials: fired clay, glass, stone."""

LARGEST_GRID: Final = 2**26
"""Voxels of a grid."""

RAMP: Final = ((0.0, 0.35, 0.7, 1.0), (0.88, 0.90, 0.86, 0.62), (0.87, 0.74, 0.42, 0.07), (0.83, 0.42, 0.20, 0.09))
"""Colours of forces from 0 to 1: where on the way, then red, green and blue (sRGB) there."""


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


def ramp(values: Floats) -> Floats:
    """Give colours (n, 3), sRGB from 0 to 1, of values (n,) from 0 to 1: pale, ochre, red."""
    return np.stack([np.interp(values, RAMP[0], channel) for channel in RAMP[1:]], axis=1)


def _parts(body: Body) -> list[tuple[int, Skin]]:
    """Give each system that has cells, with its own skin."""
    return [(system, skin(body, [system])) for system in COLOURS if (body.systems == system).any()]


def _glb(body: Body, extras: Mapping[str, Any], forces: Floats | None) -> bytes:
    import trimesh
    from trimesh.exchange.gltf import export_glb

    scene = trimesh.Scene(metadata=dict(extras))
    for system, part in _parts(body):
        name = SYSTEMS[system]
        scene.add_geometry(_mesh(part, system, forces), node_name=name, geom_name=name)
    return bytes(export_glb(scene, include_normals=False))


def _mesh(part: Skin, system: int, forces: Floats | None) -> trimesh.Trimesh:
    """Give a system's faces with its material; with forces each face has corners of its own, coloured by its cell."""
    import trimesh
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    colour = COLOURS[system]
    triangles, faces = face_triangles(part.surface)
    vertices = part.surface.vertices
    attributes = {}
    if forces is not None:
        colour = (255, 255, 255, colour[3])
        shades = np.power(ramp(forces[part.owners[faces]]), 2.2)  # glTF takes amounts of light, not sRGB
        vertices = vertices[triangles].reshape(-1, 3)
        triangles = np.arange(len(vertices), dtype=np.int32).reshape(-1, 3)
        opaque = np.full((len(shades), 1), 1.0)
        attributes["color"] = np.rint(255.0 * np.repeat(np.hstack([shades, opaque]), 3, axis=0)).astype(np.uint8)
    turned = np.stack([vertices[:, 0], vertices[:, 2], -vertices[:, 1]], axis=1)
    finish = {"baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.85}
    if system == ENVELOPE:
        finish |= {"alphaMode": "BLEND", "doubleSided": True}
    visual = TextureVisuals(material=PBRMaterial(name=SYSTEMS[system], **finish))
    visual.vertex_attributes.update(attributes)
    return trimesh.Trimesh(vertices=turned, faces=triangles, process=False, validate=False, visual=visual)


def _obj(body: Body, extras: Mapping[str, Any], forces: Floats | None) -> bytes:
    lines = ["# " + " ".join(f"{key}: {value}".split()) for key, value in extras.items()]
    before = 1
    for system, part in _parts(body):
        lines.append(f"o {SYSTEMS[system]}")
        corners = part.surface.face_vertices.astype(np.int64)
        vertices = part.surface.vertices
        tails = [""] * len(vertices)
        if forces is not None:
            shades = np.repeat(ramp(forces[part.owners]), 4, axis=0)
            vertices, corners = vertices[corners], np.arange(len(corners))
            tails = [f" {r:.3f} {g:.3f} {b:.3f}" for r, g, b in shades.tolist()]
        lines += [f"v {x!r} {y!r} {z!r}{tail}" for (x, y, z), tail in zip(vertices.tolist(), tails, strict=True)]
        lines += [f"f {' '.join(map(str, ring))}" for ring in (corners.reshape(-1, 4) + before).tolist()]
        before += len(vertices)
    return ("\n".join(lines) + "\n").encode()


def _stl(body: Body, extras: Mapping[str, Any], forces: Floats | None) -> bytes:
    from trimesh.exchange.stl import export_stl

    del extras, forces  # a binary STL file has no place for them
    return bytes(export_stl(to_trimesh(skin(body).surface)))


def _npz(body: Body, extras: Mapping[str, Any], forces: Floats | None) -> bytes:
    """Write ``grid``, (x, y, z) uint8: 0 free, else 1 + the system; ``origin``, ``lattice``, ``extras``, ``forces``."""
    low = body.cells.min(axis=0)
    shape = tuple((body.cells.max(axis=0) - low + 1).tolist())
    if np.prod(shape, dtype=np.float64) > LARGEST_GRID:
        got = " by ".join(map(str, shape))
        raise InputError(".npz", f"a body within a grid of {LARGEST_GRID} voxels", got, "write another format")
    x, y, z = (body.cells - low).T
    grid = np.zeros(shape, dtype=np.uint8)
    grid[x, y, z] = body.systems + 1
    arrays: dict[str, Any] = {"grid": grid, "origin": low, "lattice": np.array(body.lattice.name)}
    if forces is not None:
        arrays["forces"] = np.zeros(shape, dtype=np.float32)
        arrays["forces"][x, y, z] = forces
    stream = io.BytesIO()
    np.savez_compressed(stream, extras=np.array(json.dumps(dict(extras), ensure_ascii=False)), **arrays)
    return stream.getvalue()


WRITERS: Final[Mapping[str, Callable[[Body, Mapping[str, Any], Floats | None], bytes]]] = {
    ".glb": _glb,
    ".obj": _obj,
    ".stl": _stl,
    ".npz": _npz,
}
"""How each suffix is written."""
