"""Surfaces as triangles and as files: GLB, OBJ, PLY and STL.

A GLB file has y up by its standard: it is turned here, (x, y, z) to (x, z, -y), and nowhere else. The other formats
keep z up. OBJ keeps the polygons; the others hold triangles. OBJ and PLY are written here, because trimesh's writers
round them (to 8 digits, to float32). The same surface gives the same bytes.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from genome.errors import InputError
from genome.files import write_whole
from growth.surface import Indices, Points, Surface

if TYPE_CHECKING:
    import trimesh

COLOUR: Final = (214, 118, 82, 255)
"""The material's base colour: fired clay."""


def triangulate(surface: Surface) -> tuple[Points, Indices]:
    """Cut the faces into triangles.

    Parameters
    ----------
    surface
        Any surface; rings of fewer than three vertices have no area and give nothing.

    Returns
    -------
    vertices
        (V, 3) float64, the surface's own.
    triangles
        (T, 3) int32, n - 2 for a ring of n, in the order of the faces.
    """
    triangles, _ = face_triangles(surface)
    return surface.vertices, triangles


def face_triangles(surface: Surface) -> tuple[Indices, Indices]:
    """Cut the faces into triangles, and say of which face each is.

    Returns
    -------
    triangles
        (T, 3) int32.
    faces
        (T,) int32, ascending.
    """
    starts = surface.face_starts.astype(np.int64)
    lengths = np.diff(starts)
    triangles = [np.empty((0, 3), dtype=np.int64)]
    faces = [np.empty(0, dtype=np.int64)]
    for length in np.unique(lengths[lengths >= 3]):
        which = np.flatnonzero(lengths == length)
        rings = surface.face_vertices[starts[which][:, None] + np.arange(length)].astype(np.int64)
        if length == 3:
            parts = rings[:, None, :]
        elif length == 4:
            parts = _halved(surface.vertices, rings)
        else:
            parts = np.stack([_clipped(surface.vertices[ring], ring) for ring in rings])
        triangles.append(parts.reshape(-1, 3))
        faces.append(np.repeat(which, int(length) - 2))
    owner = np.concatenate(faces)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(triangles)[order].astype(np.int32), owner[order].astype(np.int32)


def newell_normals(corners: Points) -> Points:
    """Give the area vectors (..., 3) of rings (..., n, 3): along the normal, as long as the area; zero if folded."""
    local = corners - corners[..., :1, :]
    return np.asarray(0.5 * np.cross(local, np.roll(local, -1, axis=-2)).sum(axis=-2))


def _halved(vertices: Points, rings: NDArray[np.int64]) -> NDArray[np.int64]:
    """Cut quadrangles (m, 4) along the diagonal that folds less: within a reflex one, either in a flat convex one."""
    normals = newell_normals(vertices[rings])
    cuts = (np.array([[0, 1, 2], [0, 2, 3]]), np.array([[0, 1, 3], [1, 2, 3]]))
    worst = []
    for cut in cuts:
        parts = newell_normals(vertices[rings[:, cut]])
        worst.append(np.einsum("mtj,mj->mt", parts, normals).min(axis=1))
    scale = np.einsum("mj,mj->m", normals, normals)
    second = worst[1] > worst[0] + 1e-9 * scale
    return np.where(second[:, None, None], rings[:, cuts[1]], rings[:, cuts[0]])


def _clipped(corners: Points, ring: NDArray[np.int64]) -> NDArray[np.int64]:
    """Cut one ring (n,) by ear clipping in the plane of its Newell normal; a folded ring into a fan."""
    import mapbox_earcut

    count = len(ring)
    fan = np.stack([np.zeros(count - 2, np.int64), np.arange(1, count - 1), np.arange(2, count)], axis=1)
    normal = newell_normals(corners)
    drop = int(np.argmax(np.abs(normal)))
    if normal[drop] == 0.0 or not np.isfinite(normal).all():
        return ring[fan]
    across, up = (drop + 1) % 3, (drop + 2) % 3
    flat = np.ascontiguousarray(corners[:, [across, up] if normal[drop] > 0.0 else [up, across]])
    ears = mapbox_earcut.triangulate_float64(flat, np.array([count], dtype=np.uint32)).astype(np.int64).reshape(-1, 3)
    if len(ears) != count - 2:
        return ring[fan]
    a, b, c = flat[ears[:, 0]], flat[ears[:, 1]], flat[ears[:, 2]]
    turned = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]) < 0.0
    ears[turned] = ears[turned][:, ::-1]
    return ring[ears]


def to_trimesh(surface: Surface) -> trimesh.Trimesh:
    """Give a surface as a trimesh mesh, z up, vertices and their order kept."""
    import trimesh

    vertices, triangles = triangulate(surface)
    return trimesh.Trimesh(vertices=vertices, faces=triangles, process=False, validate=False)


def write_form(
    surface: Surface, path: Path, *, title: str = "", extras: Mapping[str, str | float | bool] | None = None
) -> None:
    """Write a surface to a file, whole or not at all.

    Parameters
    ----------
    surface
        What to write.
    path
        The file; its suffix chooses the format: ``.glb``, ``.obj``, ``.ply`` or ``.stl``.
    title, extras
        What the form is, kept in GLB (scene extras) and OBJ and PLY (comments); STL has no place for it.

    Raises
    ------
    InputError
        When the suffix is unknown, the surface has no face or is not finite, or the folder cannot be written to.
    """
    writer = WRITERS.get(path.suffix.lower())
    if writer is None:
        got = f"'{path.suffix}'" if path.suffix else "none"
        raise InputError(str(path), f"a form's suffix ({', '.join(WRITERS)})", got, "choose one of these")
    if not np.isfinite(surface.vertices).all():
        raise InputError(str(path), "a form with finite coordinates", "NaN or infinity")
    if not (np.diff(surface.face_starts) >= 3).any():
        raise InputError(str(path), "a form with faces to write", "none of three or more corners")
    words = {"title": title} if title else {}
    write_whole(path, writer(surface, {**words, **(extras or {})}))


def form_bytes(surface: Surface, suffix: str) -> bytes:
    """Give a surface as a file's content, by the suffix of the format: one of :data:`WRITERS`."""
    return WRITERS[suffix](surface, {})


def _glb(surface: Surface, extras: Mapping[str, Any]) -> bytes:
    import trimesh
    from trimesh.exchange.gltf import export_glb
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    vertices, triangles = triangulate(surface)
    turned = np.stack([vertices[:, 0], vertices[:, 2], -vertices[:, 1]], axis=1)
    finish = {"baseColorFactor": COLOUR, "metallicFactor": 0.0, "roughnessFactor": 0.85, "doubleSided": True}
    material = PBRMaterial(name="surface", **finish)
    visual = TextureVisuals(material=material)
    mesh = trimesh.Trimesh(vertices=turned, faces=triangles, process=False, validate=False, visual=visual)
    scene = trimesh.Scene(metadata=dict(extras))
    scene.add_geometry(mesh, node_name="surface", geom_name="surface")
    return bytes(export_glb(scene, include_normals=False))


def _obj(surface: Surface, extras: Mapping[str, Any]) -> bytes:
    lines = [*_comments("# ", extras), "o surface"]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in surface.vertices.tolist()]
    numbers = (surface.face_vertices.astype(np.int64) + 1).tolist()
    starts = surface.face_starts.tolist()
    rings = (numbers[start:end] for start, end in itertools.pairwise(starts))
    lines += [f"f {' '.join(map(str, ring))}" for ring in rings if len(ring) >= 3]
    return ("\n".join(lines) + "\n").encode()


def _ply(surface: Surface, extras: Mapping[str, Any]) -> bytes:
    vertices, triangles = triangulate(surface)
    lines = ["ply", "format binary_little_endian 1.0", *_comments("comment ", extras)]
    lines += [f"element vertex {len(vertices)}", *(f"property double {axis}" for axis in "xyz")]
    lines += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    rows = np.empty(len(triangles), dtype=[("count", "u1"), ("vertices", "<i4", 3)])
    rows["count"] = 3
    rows["vertices"] = triangles
    return ("\n".join(lines) + "\n").encode() + vertices.astype("<f8").tobytes() + rows.tobytes()


def _stl(surface: Surface, extras: Mapping[str, Any]) -> bytes:
    from trimesh.exchange.stl import export_stl

    del extras  # a binary STL file has no place for them
    return bytes(export_stl(to_trimesh(surface)))


def _comments(mark: str, extras: Mapping[str, Any]) -> list[str]:
    return [mark + " ".join(f"{key}: {value}".split()) for key, value in extras.items()]


WRITERS: Final[Mapping[str, Callable[[Surface, Mapping[str, Any]], bytes]]] = {
    ".glb": _glb,
    ".obj": _obj,
    ".ply": _ply,
    ".stl": _stl,
}
"""How each suffix is written; others than surfaces are added with their engines."""
