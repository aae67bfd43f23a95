"""Making one body of several that touch or overlap: a boolean union, exact but for welds where edges alone touch."""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from growth.protocol import Failure
from growth.refining.lab import filtered
from growth.refining.mesh import Mesh, joined_at_places, quality
from growth.refining.parting import parted
from growth.surface import Indices, Points

THIN: Final = 0.001
"""Of the diagonal: half the width of a weld."""

ROUNDS: Final = 4
"""Welds may touch what they did not touch before."""

_CORNERS: Final = np.array(list(product((-1.0, 1.0), repeat=3)))
_SIDES: Final = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]], dtype=np.int32,
)  # fmt: skip
"""A box's corners, and its triangles with their fronts outward."""


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
    ends = np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]])
    edges, uses = np.unique(np.sort(ends, axis=1), axis=0, return_counts=True)
    crossed = edges[uses > 2]
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
    boxes = [_box(mesh.vertices[first], mesh.vertices[last], half) for first, last in edges]
    boxes += [mesh.vertices[corner] + half * _CORNERS for corner in corners]
    vertices = np.concatenate([mesh.vertices, *boxes])
    starts = len(mesh.vertices) + len(_CORNERS) * np.arange(len(boxes), dtype=np.int32)
    return Mesh(vertices, np.concatenate([mesh.triangles, *(_SIDES + start for start in starts)]))


def _box(start: Points, end: Points, half: float) -> Points:
    """Give the corners (8, 3) of a box about an edge, which it is longer than by ``half`` at both ends."""
    along = (end - start) / max(float(np.linalg.norm(end - start)), 1e-300)
    across = np.cross(along, np.eye(3)[int(np.abs(along).argmin())])
    across /= np.linalg.norm(across)
    axes = np.stack([along, across, np.cross(along, across)])
    reach = np.array([0.5 * float(np.linalg.norm(end - start)) + half, half, half])
    return np.asarray(0.5 * (start + end) + (_CORNERS * reach) @ axes)
