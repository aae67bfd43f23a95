"""Hot loops over a whole map that change its size, its numbering or nothing; the layout is that of ``_paths.py``."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Corners = NDArray[np.int32]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

EXTERIOR = -1


@njit(cache=True)
def enlarge(points: Reals, n_vertices: int, scale: float, target: Reals) -> None:
    """Write the places to which vertices move as the surface grows about the mean of its vertices (section 4.3)."""
    cx, cy, cz = 0.0, 0.0, 0.0
    for v in range(n_vertices):
        cx, cy, cz = cx + points[v, 0], cy + points[v, 1], cz + points[v, 2]
    cx, cy, cz = cx / n_vertices, cy / n_vertices, cz / n_vertices
    for v in range(n_vertices):
        target[v, 0] = points[v, 0] + (scale - 1.0) * (points[v, 0] - cx)
        target[v, 1] = points[v, 1] + (scale - 1.0) * (points[v, 1] - cy)
        target[v, 2] = points[v, 2] + (scale - 1.0) * (points[v, 2] - cz)


@njit(cache=True)
def extent(points: Reals, n_vertices: int) -> float:
    """Give the largest extent along an axis; not a number where a vertex is not."""
    most = 0.0
    for axis in range(3):
        low = high = points[0, axis]
        for v in range(n_vertices):
            x = points[v, axis]
            if not math.isfinite(x):
                return np.nan
            low, high = min(low, x), max(high, x)
        most = max(most, high - low)
    return most


@njit(cache=True)
def farther_than(points: Reals, limit: float) -> bool:
    """Tell whether a coordinate is not a number or larger than ``limit``."""
    for v in range(points.shape[0]):
        for axis in range(3):
            if not abs(points[v, axis]) < limit:
                return True
    return False


@njit(cache=True)
def prune(nxt: Corners, prev: Corners, chained: Ints, dead: Flags) -> None:
    """Take out dangling chains, outermost first; ``chained`` lists their edges in the order made.

    A chain that carries a joined edge stays as far as that edge needs it.
    """
    for i in range(chained.size - 1, -1, -1):
        e = chained[i]
        for out in range(2 * e, 2 * e + 2):
            back = out ^ 1
            if nxt[out] == back and not dead[e]:
                before, after = prev[out], nxt[back]
                nxt[before], prev[after] = after, before
                dead[e] = True


@njit(cache=True)
def compact(
    points: Reals, origin: Corners, nxt: Corners, prev: Corners, face: Corners, label: Corners, n_vertices: int,
    n_edges: int, dead: Flags,
) -> tuple[int, int]:  # fmt: skip
    """Renumber vertices and edges, in order, without dead edges and lonely vertices; give the new numbers."""
    new_edge = np.full(n_edges, -1, dtype=np.int64)
    used = np.zeros(n_vertices, dtype=np.bool_)
    edges = 0
    for e in range(n_edges):
        if not dead[e]:
            new_edge[e] = edges
            used[origin[2 * e]] = used[origin[2 * e + 1]] = True
            edges += 1
    new_vertex = np.full(n_vertices, -1, dtype=np.int64)
    vertices = 0
    for v in range(n_vertices):
        if used[v]:
            new_vertex[v] = vertices
            points[vertices] = points[v]
            vertices += 1
    for e in range(n_edges):
        if dead[e]:
            continue
        to = new_edge[e]
        label[to] = label[e]
        for side in range(2):
            h, g = 2 * e + side, 2 * to + side
            origin[g] = new_vertex[origin[h]]
            face[g] = face[h]
            nxt[g] = 2 * new_edge[nxt[h] >> 1] + (nxt[h] & 1)
            prev[g] = 2 * new_edge[prev[h] >> 1] + (prev[h] & 1)
    return vertices, edges


@njit(cache=True)
def rings(origin: Corners, nxt: Corners, face: Corners, n_edges: int, n_faces: int) -> tuple[Corners, Corners]:
    """List the vertices of each face's loop, from the lowest half-edge on, as (starts, vertices)."""
    first = np.full(n_faces, -1, dtype=np.int64)
    starts = np.zeros(n_faces + 1, dtype=np.int32)
    for h in range(2 * n_edges - 1, -1, -1):
        f = face[h]
        if f != EXTERIOR:
            first[f] = h
            starts[f + 1] += 1
    for f in range(n_faces):
        starts[f + 1] += starts[f]
    vertices = np.empty(starts[n_faces], dtype=np.int32)
    for f in range(n_faces):
        h, place = first[f], starts[f]
        while True:
            vertices[place] = origin[h]
            place += 1
            h = nxt[h]
            if h == first[f]:
                break
    return starts, vertices
