"""Cleaning: no vertex or triangle twice, none without area, no edge of more than two, and fronts that agree."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from growth.protocol import Failure
from growth.refining.lab import filtered, length
from growth.refining.mesh import CLOSE, Mesh, pieces, sides, volumes
from growth.refining.parting import parted

if TYPE_CHECKING:
    from growth.refining.recipe import RefineSettings


def clean(mesh: Mesh, settings: RefineSettings) -> Mesh | Failure:
    """Repair a mesh: what stands twice goes, edges of more than two triangles are parted, and fronts agree.

    Pieces that bound a volume have their fronts outward afterwards. A piece with one side, as a Moebius strip, keeps an
    edge at which fronts do not agree.
    """
    del settings
    whole = filtered(
        mesh,
        ("meshing_merge_close_vertices", {"threshold": length(CLOSE * mesh.diagonal)}),
        ("meshing_remove_duplicate_faces", {}),
        ("meshing_remove_null_faces", {}),
        ("meshing_remove_unreferenced_vertices", {}),
    )
    if isinstance(whole, Failure):
        return whole
    apart = parted(whole)
    found = filtered(apart, ("meshing_re_orient_faces_coherently", {}))
    return found if isinstance(found, Failure) else outward(found)


def outward(mesh: Mesh) -> Mesh:
    """Turn the closed pieces whose fronts look inward, but for those within another: they are its hollows.

    A piece that bounds no volume keeps its fronts.
    """
    piece = pieces(mesh.triangles, len(mesh.vertices))
    opened = np.zeros(int(piece.max(initial=-1)) + 1, dtype=bool)
    opened[piece[_at_open_edges(mesh)]] = True
    inward = (np.bincount(piece, weights=volumes(mesh)) < 0.0) & ~opened
    for number in np.flatnonzero(inward).tolist():
        inward[number] = not _within_another(mesh, piece, number, opened | inward)
    return Mesh(mesh.vertices, np.where(inward[piece][:, None], mesh.triangles[:, ::-1], mesh.triangles))


def _within_another(
    mesh: Mesh,
    piece: np.ndarray[tuple[int], np.dtype[np.int32]],
    number: int,
    others: np.ndarray[tuple[int], np.dtype[np.bool_]],
) -> bool:
    """Tell whether a piece lies in one of those with fronts outward; ``others`` are not."""
    import trimesh

    place = mesh.vertices[mesh.triangles[piece == number][:1, 0]]
    around = mesh.triangles[~others[piece]]
    if not len(around):
        return False
    body = trimesh.Trimesh(mesh.vertices, around, process=False, validate=False)
    return bool(body.contains(place)[0])


def _at_open_edges(mesh: Mesh) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Give the triangles that have an edge of their own."""
    _, edge, uses = np.unique(np.sort(sides(mesh.triangles), axis=1), axis=0, return_inverse=True, return_counts=True)
    alone = np.flatnonzero(uses[edge.reshape(-1)] == 1)
    return np.unique(alone % len(mesh.triangles))
