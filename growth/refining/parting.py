"""Parting edges of more than two triangles, so that each body keeps its own."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from growth.refining.mesh import Mesh
from growth.surface import Points

Ints = NDArray[np.int64]
Side = TypeVar("Side", int, NDArray[np.int64])


def parted(mesh: Mesh) -> Mesh:
    """Give each edge two triangles at most, by parting vertices; the form stays as it is.

    Where bodies touch along an edge their triangles go in pairs with the solid between them, as seen round the edge; an
    edge whose fronts do not agree, or that an odd number of triangles share, is parted into sides of their own.

    Parameters
    ----------
    mesh
        Without triangles that have a corner twice.
    """
    count = len(mesh.triangles)
    starts, pairs, crossed = _sides(mesh)
    sides = np.concatenate([pairs, *(_paired(mesh, many, starts) for many in crossed)])
    # A side and the next corner of its triangle: the two ends of the edge, in both triangles.
    here = np.concatenate([sides, _next(sides)], axis=0)
    across = _matched(sides, starts)
    joined = coo_array((np.ones(len(here), dtype=np.int8), (here[:, 0], across)), shape=(3 * count, 3 * count))
    _, corner = connected_components(joined, directed=False)
    _, sample, numbers = np.unique(corner, return_index=True, return_inverse=True)
    return _halved(Mesh(mesh.vertices[starts[sample]], numbers.reshape(-1, 3).astype(np.int32)))


def _halved(mesh: Mesh) -> Mesh:
    """Cut edges that still have more than two triangles: each pair gets a middle of its own.

    A body may touch itself along an edge whose ends it needs whole.
    """
    while True:
        starts, _, crossed = _sides(mesh)
        if not crossed:
            return mesh
        vertices, triangles = list(mesh.vertices), mesh.triangles.tolist()
        touched: set[int] = set()
        for sides in crossed:
            faces = set((sides // 3).tolist())
            if faces & touched:
                continue  # in the next round
            touched |= faces
            pairs = _paired(mesh, sides, starts).tolist() or [[side] for side in sides.tolist()]
            for pair in pairs:
                middle = len(vertices)
                vertices.append(mesh.vertices[starts[[pair[0], _next(pair[0])]]].mean(axis=0))
                for side in pair:
                    face, at = divmod(side, 3)
                    one, two, third = (triangles[face][(at + step) % 3] for step in range(3))
                    triangles[face] = [one, middle, third]
                    triangles.append([middle, two, third])
        mesh = Mesh(np.array(vertices), np.array(triangles, dtype=np.int32))


def _sides(mesh: Mesh) -> tuple[Ints, Ints, list[Ints]]:
    """Sort the sides of triangles, three each, by their edges.

    Returns
    -------
    tuple
        The vertex at which each side starts (3t,); the two sides of each edge that has two (k, 2); and those of each
        edge that has more.
    """
    starts = mesh.triangles.reshape(-1).astype(np.int64)
    ends = np.roll(mesh.triangles, -1, axis=1).reshape(-1)
    keys = np.minimum(starts, ends) * len(mesh.vertices) + np.maximum(starts, ends)
    order = np.argsort(keys, kind="stable")
    _, first, uses = np.unique(keys[order], return_index=True, return_counts=True)
    twice = first[uses == 2]
    crossed = [order[at : at + many] for at, many in zip(first.tolist(), uses.tolist(), strict=True) if many > 2]
    return starts, np.stack([order[twice], order[twice + 1]], axis=1), crossed


def _next(sides: Side) -> Side:
    """Give the corner at which each side ends."""
    return sides - sides % 3 + (sides + 1) % 3


def _matched(
    sides: Ints,
    starts: Ints,
) -> Ints:
    """Find the second side's corner at the vertex of each start, and then of each end, of the first side."""
    first, second = sides[:, 0], sides[:, 1]
    same_way = starts[first] == starts[second]
    at_start = np.where(same_way, second, _next(second))
    at_end = np.where(same_way, _next(second), second)
    return np.concatenate([at_start, at_end])


def _paired(
    mesh: Mesh,
    sides: Ints,
    starts: Ints,
) -> Ints:
    """Pair the sides along one edge, (k, 2); none where they do not go in pairs."""
    none = np.empty((0, 2), dtype=np.int64)
    low = int(starts[sides].min())
    forward = starts[sides] == low
    if 2 * int(forward.sum()) != len(sides):
        return none
    turn = np.argsort(_angles(mesh, sides, starts, forward), kind="stable")
    ordered, ahead = sides[turn], forward[turn]
    if (ahead == np.roll(ahead, 1)).any():
        return none
    # The solid lies on the side from which a forward triangle's front looks away: before it, as angles go.
    return np.asarray(np.stack([ordered, np.roll(ordered, 1)], axis=1)[ahead])


def _angles(
    mesh: Mesh,
    sides: Ints,
    starts: Ints,
    forward: NDArray[np.bool_],
) -> Points:
    """Give the angles at which triangles stand round their common edge, from its lower vertex to its higher one."""
    one = int(np.flatnonzero(forward)[0])
    origin = mesh.vertices[starts[sides[one]]]
    axis = mesh.vertices[starts[_next(sides)[one]]] - origin
    axis = axis / max(float(np.linalg.norm(axis)), 1e-300)
    away = mesh.vertices[starts[_next(_next(sides))]] - origin
    away = away - np.outer(away @ axis, axis)
    across = away[0] / max(float(np.linalg.norm(away[0])), 1e-300)
    return np.asarray(np.arctan2(away @ np.cross(axis, across), away @ across))
