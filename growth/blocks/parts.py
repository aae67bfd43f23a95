"""Parts of cells as files: GLB with a material for each part, OBJ, and a grid of voxels (NumPy ``.npz``).

GLB has y up by its standard: it is turned here, (x, y, z) to (x, z, -y). The others keep z up. The same parts give the
same bytes.
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from genome.errors import InputError
from growth.blocks.lattice import Floats, Ints, Lattice
from growth.blocks.skin import Skin
from growth.forms import face_triangles

if TYPE_CHECKING:
    import trimesh

LARGEST_GRID: Final = 2**26
"""Voxels of a grid."""

RAMP: Final = ((0.0, 0.35, 0.7, 1.0), (0.88, 0.90, 0.86, 0.62), (0.87, 0.74, 0.42, 0.07), (0.83, 0.42, 0.20, 0.09))
"""Colours of forces from 0 to 1: where on the way, then red, green and blue (sRGB) there."""


class Part(NamedTuple):
    """One of several parts of a form.

    Attributes
    ----------
    name
        Of its node and its material.
    skin
        Its faces.
    colour
        Of the material: red, green, blue (sRGB) and opacity from 0 to 255.
    clear
        Whether one sees through it.
    """

    name: str
    skin: Skin
    colour: tuple[int, int, int, int]
    clear: bool


def ramp(values: Floats) -> Floats:
    """Give colours (n, 3), sRGB from 0 to 1, of values (n,) from 0 to 1: pale, ochre, red."""
    return np.stack([np.interp(values, RAMP[0], channel) for channel in RAMP[1:]], axis=1)


def glb(parts: Sequence[Part], extras: Mapping[str, Any], forces: Floats | None = None) -> bytes:
    """Give parts as a GLB file, each a node, a mesh and a material of its name.

    Parameters
    ----------
    parts
        At least one.
    extras
        What the form is, kept with the scene.
    forces
        (n,) float64 from 0 to 1 by the cells that own faces: shown as colours of vertices.
    """
    import trimesh
    from trimesh.exchange.gltf import export_glb

    scene = trimesh.Scene(metadata=dict(extras))
    for part in parts:
        scene.add_geometry(_mesh(part, forces), node_name=part.name, geom_name=part.name)
    return bytes(export_glb(scene, include_normals=False))


def _mesh(part: Part, forces: Floats | None) -> trimesh.Trimesh:
    """Give a part's faces with its material; with forces each face has corners of its own, coloured by its cell."""
    import trimesh
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    colour = part.colour
    triangles, faces = face_triangles(part.skin.surface)
    vertices = part.skin.surface.vertices
    attributes = {}
    if forces is not None:
        colour = (255, 255, 255, colour[3])
        shades = np.power(ramp(forces[part.skin.owners[faces]]), 2.2)  # glTF takes amounts of light, not sRGB
        vertices = vertices[triangles].reshape(-1, 3)
        triangles = np.arange(len(vertices), dtype=np.int32).reshape(-1, 3)
        opaque = np.full((len(shades), 1), 1.0)
        attributes["color"] = np.rint(255.0 * np.repeat(np.hstack([shades, opaque]), 3, axis=0)).astype(np.uint8)
    turned = np.stack([vertices[:, 0], vertices[:, 2], -vertices[:, 1]], axis=1)
    finish = {"baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.85}
    if part.clear:
        finish |= {"alphaMode": "BLEND", "doubleSided": True}
    visual = TextureVisuals(material=PBRMaterial(name=part.name, **finish))
    visual.vertex_attributes.update(attributes)
    return trimesh.Trimesh(vertices=turned, faces=triangles, process=False, validate=False, visual=visual)


def obj(parts: Sequence[Part], extras: Mapping[str, Any], forces: Floats | None = None) -> bytes:
    """Give parts as an OBJ file, each an object of its name; parameters as of :func:`glb`, extras as comments."""
    lines = ["# " + " ".join(f"{key}: {value}".split()) for key, value in extras.items()]
    before = 1
    for part in parts:
        lines.append(f"o {part.name}")
        corners = part.skin.surface.face_vertices.astype(np.int64)
        vertices = part.skin.surface.vertices
        tails = [""] * len(vertices)
        if forces is not None:
            shades = np.repeat(ramp(forces[part.skin.owners]), 4, axis=0)
            vertices, corners = vertices[corners], np.arange(len(corners))
            tails = [f" {r:.3f} {g:.3f} {b:.3f}" for r, g, b in shades.tolist()]
        lines += [f"v {x!r} {y!r} {z!r}{tail}" for (x, y, z), tail in zip(vertices.tolist(), tails, strict=True)]
        lines += [f"f {' '.join(map(str, ring))}" for ring in (corners.reshape(-1, 4) + before).tolist()]
        before += len(vertices)
    return ("\n".join(lines) + "\n").encode()


def voxels(
    cells: Ints, values: NDArray[np.uint8], lattice: Lattice, extras: Mapping[str, Any], forces: Floats | None = None
) -> bytes:
    """Give cells (n, 3) as arrays in a file.

    They are ``grid``, (x, y, z) uint8 with each cell's value, 0 where none is, the first cell's ``origin``,
    ``lattice``, ``extras`` as JSON, and ``forces`` by voxel.

    Raises
    ------
    InputError
        For a grid of more than :data:`LARGEST_GRID` voxels.
    """
    low = cells.min(axis=0)
    shape = tuple((cells.max(axis=0) - low + 1).tolist())
    if np.prod(shape, dtype=np.float64) > LARGEST_GRID:
        got = " by ".join(map(str, shape))
        raise InputError(".npz", f"a body within a grid of {LARGEST_GRID} voxels", got, "write another format")
    x, y, z = (cells - low).T
    grid = np.zeros(shape, dtype=np.uint8)
    grid[x, y, z] = values
    arrays: dict[str, Any] = {"grid": grid, "origin": low, "lattice": np.array(lattice.name)}
    if forces is not None:
        arrays["forces"] = np.zeros(shape, dtype=np.float32)
        arrays["forces"][x, y, z] = forces
    stream = io.BytesIO()
    np.savez_compressed(stream, extras=np.array(json.dumps(dict(extras), ensure_ascii=False)), **arrays)
    return stream.getvalue()
