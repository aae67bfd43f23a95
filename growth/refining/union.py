"""Making one body of several that touch or overlap: a boolean union, exact but for welds where edges alone touch."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from growth.protocol import Failure
from growth.refining.lab import filtered
from growth.refining.mesh import Mesh, joined_at_places, quality, sides
from growth.refining.parting import parted
from growth.surface import Indices, Points

THIN: Final = 0.001
"""Of the diagonal: half the width of a weld."""

ROUNDS: Final = 4
"""Welds may touch what they did not touch before."""


def united(mesh: Mesh) -> Mesh | Failure:
    """Join the bodies of a mesh, closed with fronts outward, hollows inward, where they overlap or share faces.

    Where only an edge or a corner is shared a weld joins them: a box about it, twice :data:`THIN` wide.

    Returns
    -------
    Mesh or Failure
        Watertight also for programs that join corners at one place, as they must for STL files. A failure has the
        reason ``refining``: some body is open or turned inside out, or there is an edge that no weld helps.
    """
    for _ in range(ROUNDS):
        found = _union(mesh)
        if isinstance(found, Failure):
            return found
        one = joined_at_places(found)
        edges, corners = touching(one)
        if not len(edges) and not len(corners):
            break
        mesh = _welded(one, edges, corners, THIN * one.diagonal)
    told = quality(one)
    if told.watertight and told.volume > 0.0:
        return one
    got = f"{told.open_edges} open edges, {told.crossings} crossings, a volume of {told.volume:g}"
    return Failure("refining", f"union: {got}")


def touching(mesh: Mesh) -> tuple[Indices, Indices]:
    """Find where bodies touch, or one touches itself, without sharing a face.

    Parameters
    ----------
    mesh
        With one corner at each place.

    Returns
    -------
    The edges (e, 2) of more than two triangles, and the corners (c,) elsewhere at which alone bodies meet.
    """
    edges, uses = np.unique(np.sort(sides(mesh.triangles), axis=1), axis=0, return_counts=True)
    crossed = edges[uses > 2].astype(np.int32)
    # A corner of several bodies is parted into one for each.
    places, times = np.unique(_rows(parted(mesh).vertices), return_counts=True)
    twice = np.isin(_rows(mesh.vertices), places[times > 1])
    twice[crossed] = False
    return crossed, np.flatnonzero(twice).astype(np.int32)


def _rows(places: Points) -> NDArray[np.void]:
    """Give each place (n, 3) as one value."""
    return np.ascontiguousarray(places + 0.0).view([(axis, np.float64) for axis in "xyz"]).reshape(-1)


def _union(mesh: Mesh) -> Mesh | Failure:
    # With itself: what counts is how often a place is wound round, so that overlaps within one mesh go.
    return filtered(
        mesh,
        ("generate_copy_of_current_mesh", {}),
        ("generate_boolean_union", {"first_mesh": 0, "second_mesh": 1}),
    )


def _welded(mesh: Mesh, edges: Indices, corners: Indices, half: float) -> Mesh:
    """Lay boxes over edges, and about corners."""
    import trimesh

    box = trimesh.creation.box((2.0, 2.0, 2.0))
    unit, faces = np.asarray(box.vertices), np.asarray(box.faces, dtype=np.int32)
    welds = [_along(unit, mesh.vertices[first], mesh.vertices[last], half) for first, last in edges]
    welds += [mesh.vertices[corner] + half * unit for corner in corners]
    starts = len(mesh.vertices) + len(unit) * np.arange(len(welds), dtype=np.int32)
    triangles = np.concatenate([mesh.triangles, *(faces + start for start in starts)])
    return Mesh(np.concatenate([mesh.vertices, *welds]), triangles)


def _along(unit: Points, start: Points, end: Points, half: float) -> Points:
    """Lay the corners (8, 3) of a cube from -1 to 1 about an edge, which they reach over by ``half`` at both ends."""
    along = (end - start) / max(float(np.linalg.norm(end - start)), 1e-300)
    across = np.cross(along, np.eye(3)[int(np.abs(along).argmin())])
    across /= np.linalg.norm(across)
    axes = np.stack([along, across, np.cross(along, across)])
    reach = np.array([0.5 * float(np.linalg.norm(end - start)) + half, half, half])
    return np.asarray(0.5 * (start + end) + (unit * reach) @ axes)
