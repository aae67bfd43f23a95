"""Reading a boundary's mesh file: any that trimesh loads, as one closed body with its fronts outward."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from genome.errors import InputError
from growth.environment.boundaries.protocol import Floats, Triangles

Y_UP: Final = frozenset({".glb", ".gltf"})
"""Formats whose files have y up by their standard; they are turned so that z is up."""

_REPAIR: Final = "close it in the program that made it (fill holes, merge vertices, make normals agree)"


def read_mesh(path: Path, source: str) -> tuple[Floats, Triangles]:
    """Read a closed mesh.

    Parameters
    ----------
    path
        The file; what it contains is joined into one mesh, z up.
    source
        Where it is asked for, for messages.

    Returns
    -------
    vertices
        (v, 3) float64, no two at one place.
    triangles
        (t, 3) int32, fronts outward.

    Raises
    ------
    InputError
        When the file is missing, unreadable, empty, not finite, flat or not closed.
    """
    where = f"{source}: {path}"
    vertices, faces = load_triangles(path, where)
    if path.suffix.lower() in Y_UP:
        vertices = np.stack([vertices[:, 0], -vertices[:, 2], vertices[:, 1]], axis=1)
    return closed(vertices, faces, where)


def closed(vertices: Floats, faces: NDArray[np.int64], where: str) -> tuple[Floats, Triangles]:
    """Make one closed body of vertices (v, 3) and triangles (t, 3) that somebody else wrote; as :func:`read_mesh`."""
    if len(faces) == 0:
        raise InputError(where, "a mesh with faces", "an empty one")
    if not np.isfinite(vertices).all():
        raise InputError(where, "finite coordinates", "NaN or infinity", "repair the file")
    vertices, triangles = _merged(vertices, faces)
    opened, clashing = _unmatched(triangles)
    if opened:
        raise InputError(where, "a closed mesh", f"one with {opened} open edges", _REPAIR)
    if clashing:
        remedy = "recalculate the normals in the program that made it"
        raise InputError(where, "faces that agree on a front", f"{clashing} edges where they do not", remedy)
    return _outward(vertices, triangles, where)


def load_triangles(
    path: Path, where: str, remedy: str = "check the path; it is relative to the environment file"
) -> tuple[Floats, NDArray[np.int64]]:
    """Read all triangles of a file as they stand in it: vertices (v, 3) float64 and triangles (t, 3) int64.

    Parameters
    ----------
    path
        The file.
    where
        The place that an error names.
    remedy
        What to do where the file is missing.

    Raises
    ------
    InputError
        When the file is missing or cannot be read.
    """
    import trimesh

    if path.is_dir():
        raise InputError(where, "a mesh file", "a folder")
    if not path.is_file():
        raise InputError(where, "a mesh file", "no such file", remedy)
    if path.stat().st_size == 0:
        raise InputError(where, "a mesh file", "an empty file")
    known = sorted(trimesh.available_formats())
    if path.suffix.lower().removeprefix(".") not in known:
        raise InputError(
            where, "a mesh file that trimesh loads", f"the suffix '{path.suffix}'", f"known: {_list(known)}"
        )
    try:
        mesh = trimesh.load_scene(path, process=False).to_mesh()
        vertices = np.array(mesh.vertices, dtype=np.float64).reshape(-1, 3)
        return vertices, np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)
    except Exception as error:
        # Readers of some forty formats raise whatever they stumble over.
        text = " ".join(str(error).split()) or type(error).__name__
        raise InputError(where, "a mesh file that trimesh loads", text) from error


def _list(words: list[str]) -> str:
    return ", ".join(words)


def _merged(vertices: Floats, faces: NDArray[np.int64]) -> tuple[Floats, Triangles]:
    """Merge vertices at one place (STL files and texture seams repeat them) and drop what folds up by that.

    Exact places first; where that leaves a mesh open, places that agree to a hundred millionth of its size.
    """
    size = float(np.ptp(vertices, axis=0).max())
    kept, triangles = _merged_by(vertices + 0.0, vertices, faces)
    if sum(_unmatched(triangles)) and size > 0.0:
        near = _merged_by(np.round(vertices / (1e-8 * size)), vertices, faces)
        if not sum(_unmatched(near[1])):
            return near
    return kept, triangles


def _merged_by(keys: Floats, vertices: Floats, faces: NDArray[np.int64]) -> tuple[Floats, Triangles]:
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    triangles = inverse.reshape(-1)[faces]
    folded = (
        (triangles[:, 0] == triangles[:, 1])
        | (triangles[:, 1] == triangles[:, 2])
        | (triangles[:, 2] == triangles[:, 0])
    )
    triangles = triangles[~folded]
    used, renumbered = np.unique(triangles, return_inverse=True)
    return np.ascontiguousarray(vertices[first][used]), renumbered.reshape(-1, 3).astype(np.int32)


def _unmatched(triangles: Triangles) -> tuple[int, int]:
    """Count the edges that an odd number of faces share, and those that even numbers run along in one direction."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    forward = np.where(ends[:, 0] < ends[:, 1], 1, -1)
    low, high = ends.min(axis=1), ends.max(axis=1)
    _, edge = np.unique(low * (int(triangles.max(initial=0)) + 1) + high, return_inverse=True)
    uses = np.bincount(edge)
    balance = np.bincount(edge, weights=forward)
    opened = uses % 2 == 1
    return int(opened.sum()), int(((balance != 0) & ~opened).sum())


def _outward(vertices: Floats, triangles: Triangles, where: str) -> tuple[Floats, Triangles]:
    """Turn a mesh whose fronts face inward; refuse one without volume."""
    if len(triangles) == 0:
        raise InputError(where, "a mesh with a volume", "faces without area")
    corners = vertices[triangles] - vertices.mean(axis=0)
    volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    size = float(np.ptp(vertices, axis=0).max())
    if not abs(volumes.sum()) > 1e-12 * size**3:
        raise InputError(where, "a mesh with a volume", "a flat one")
    if volumes.sum() < 0.0:
        triangles, volumes = triangles[:, ::-1], -volumes
    turned = _inside_out(vertices, triangles, volumes)
    return vertices, np.ascontiguousarray(np.where(turned[:, None], triangles[:, ::-1], triangles))


def _inside_out(vertices: Floats, triangles: Triangles, volumes: Floats) -> NDArray[np.bool_]:
    """Say which faces (t,) belong to separate bodies whose fronts face inward; a shell within another is a cavity."""
    part = np.arange(len(vertices))
    while True:
        lowest = part.copy()
        np.minimum.at(lowest, triangles.reshape(-1), np.repeat(part[triangles].min(axis=1), 3))
        lowest = lowest[lowest]
        if (lowest == part).all():
            break
        part = lowest
    parts, owner = np.unique(part, return_inverse=True)
    owner = owner.reshape(-1)
    volume = np.bincount(owner[triangles[:, 0]], weights=volumes, minlength=len(parts))
    low, high = np.full((len(parts), 3), np.inf), np.full((len(parts), 3), -np.inf)
    np.minimum.at(low, owner, vertices)
    np.maximum.at(high, owner, vertices)
    solid = volume > 0.0
    for index in np.flatnonzero(~solid):
        around = (low[volume > 0.0] <= low[index]).all(axis=1) & (high[volume > 0.0] >= high[index]).all(axis=1)
        solid[index] = around.any()
    return np.asarray(~solid[owner[triangles[:, 0]]])
