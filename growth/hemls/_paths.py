"""Hot loops that choose rules and replace edges by the paths of their templates, compiled by Numba.

All kernels of this folder share one layout. Half-edge ``2 e`` runs from the start of edge ``e`` to its end, ``2 e + 1``
back. Faces run counter-clockwise; the exterior is face -1. Kernels that call each other stand in one file, since
Numba's cache does not see changes in another.
"""

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
def face_normals(points: Reals, origin: Corners, face: Corners, n_edges: int, normals: Reals) -> None:
    """Write the unit normal of each face, zero where it has no area, into ``normals`` (F, 3) (Newell).

    An area that rounding alone could make (of two edges that lie on each other, say) is none: its normal is noise.
    """
    normals[:] = 0.0
    squares = np.zeros(normals.shape[0])
    # Measured from a vertex of the map, areas keep their digits wherever the map lies.
    ox, oy, oz = points[0, 0], points[0, 1], points[0, 2]
    for h in range(2 * n_edges):
        f = face[h]
        if f == EXTERIOR:
            continue
        a, b = origin[h], origin[h ^ 1]
        ax, ay, az = points[a, 0] - ox, points[a, 1] - oy, points[a, 2] - oz
        bx, by, bz = points[b, 0] - ox, points[b, 1] - oy, points[b, 2] - oz
        normals[f, 0] += (ay - by) * (az + bz)
        normals[f, 1] += (az - bz) * (ax + bx)
        normals[f, 2] += (ax - bx) * (ay + by)
        squares[f] += (ax - bx) ** 2 + (ay - by) ** 2 + (az - bz) ** 2
    for f in range(normals.shape[0]):
        size = math.sqrt(normals[f, 0] ** 2 + normals[f, 1] ** 2 + normals[f, 2] ** 2)
        if size > 1e-9 * squares[f]:
            normals[f] /= size
        else:
            normals[f] = 0.0


@njit(cache=True, inline="always")
def _frame(
    points: Reals, origin: Corners, face: Corners, normals: Reals, edge: int, frames: Reals, i: int,
) -> float:  # fmt: skip
    """Write the heading (with the edge's length), left and up of an edge into ``frames[i]`` (9,)."""
    s, t = origin[2 * edge], origin[2 * edge + 1]
    hx, hy, hz = points[t, 0] - points[s, 0], points[t, 1] - points[s, 1], points[t, 2] - points[s, 2]
    length = math.sqrt(hx * hx + hy * hy + hz * hz)
    ux, uy, uz = 0.0, 0.0, 0.0
    for side in range(2):
        f = face[2 * edge + side]
        if f != EXTERIOR:
            ux, uy, uz = ux + normals[f, 0], uy + normals[f, 1], uz + normals[f, 2]
    if ux * ux + uy * uy + uz * uz < 1e-18:
        f = max(face[2 * edge], face[2 * edge + 1]) if face[2 * edge] == EXTERIOR else face[2 * edge]
        ux, uy, uz = normals[f, 0], normals[f, 1], normals[f, 2]
    frames[i, 0], frames[i, 1], frames[i, 2] = hx, hy, hz
    if length > 0.0:
        hx, hy, hz = hx / length, hy / length, hz / length
    else:
        hx, hy, hz = 1.0, 0.0, 0.0
    along = ux * hx + uy * hy + uz * hz
    ux, uy, uz = ux - along * hx, uy - along * hy, uz - along * hz
    size = math.sqrt(ux * ux + uy * uy + uz * uz)
    if size < 1e-9:
        # No region tells where up is: take z, or y for an edge that runs along z.
        if abs(hz) < 0.9:
            ux, uy, uz = -hz * hx, -hz * hy, 1.0 - hz * hz
        else:
            ux, uy, uz = -hy * hx, 1.0 - hy * hy, -hy * hz
        size = math.sqrt(ux * ux + uy * uy + uz * uz)
    ux, uy, uz = ux / size, uy / size, uz / size
    frames[i, 3], frames[i, 4], frames[i, 5] = uy * hz - uz * hy, uz * hx - ux * hz, ux * hy - uy * hx
    frames[i, 6], frames[i, 7], frames[i, 8] = ux, uy, uz
    return length


@njit(cache=True)
def choose_rules(
    prev: Corners, label: Corners, made: Flags, n_edges: int, first_rule: int, last_rule: int, rule_label: Ints,
    before: Ints, after: Ints, edges: Ints, rules: Ints,
) -> int:  # fmt: skip
    """Choose the rule for each edge whose label the rules ``first_rule`` to ``last_rule`` (one group) rewrite.

    The rule with most matching context wins, the earlier where they are equal (Hemberg 2006, section 4.5). Writes
    edges and rules and gives their number.
    """
    count = 0
    for e in range(n_edges):
        if made[e] or label[e] != rule_label[first_rule]:
            continue
        best, most = -1, -1
        for r in range(first_rule, last_rule):
            matching = 0
            if before[r] >= 0:
                matching += 1 if _has_neighbour(prev, label, 2 * e, before[r]) else -9
            if after[r] >= 0:
                matching += 1 if _has_neighbour(prev, label, 2 * e + 1, after[r]) else -9
            if matching > most:
                best, most = r, matching
        if best >= 0:
            edges[count], rules[count] = e, best
            count += 1
    return count


@njit(cache=True)
def _has_neighbour(prev: Corners, label: Corners, h: int, wanted: int) -> bool:
    """Tell whether another edge with label ``wanted`` meets the origin of half-edge ``h``."""
    other = prev[h] ^ 1
    while other != h:
        if label[other >> 1] == wanted:
            return True
        other = prev[other] ^ 1
    return False


@njit(cache=True)
def draw_paths(
    points: Reals, origin: Corners, nxt: Corners, prev: Corners, face: Corners, label: Corners, made: Flags,
    n_vertices: int, n_edges: int, normals: Reals, edges: Ints, rules: Ints, count: int, node_start: Ints,
    nodes: Reals, segment_start: Ints, segment_label: Ints, segment_flip: Flags, vertex_base: Ints, edge_base: Ints,
    frames: Reals, moved: Ints,
) -> tuple[int, int]:  # fmt: skip
    """Replace each chosen edge by the path of its template.

    The edge's own number goes to the first segment, the others get new ones in order; vertices of chains are made
    here too but not linked. ``moved`` maps half-edges to those that leave the same corner afterwards. Gives the new
    numbers of vertices and edges.
    """
    first_edge = n_edges
    for i in range(count):
        r, start = rules[i], origin[2 * edges[i]]
        length = _frame(points, origin, face, normals, edges[i], frames, i)
        vertex_base[i], edge_base[i] = n_vertices, n_edges
        m = segment_start[r + 1] - segment_start[r]
        n_edges += m - 1
        first = node_start[r]
        for j in range(first, node_start[r + 1]):
            if j not in (first, first + m):
                x, y, z = nodes[j, 0], length * nodes[j, 1], length * nodes[j, 2]
                for axis in range(3):
                    points[n_vertices, axis] = (
                        points[start, axis] + x * frames[i, axis] + (y * frames[i, 3 + axis] + z * frames[i, 6 + axis])
                    )
                n_vertices += 1
    _link_paths(
        origin, nxt, prev, face, label, made, edges, rules, count, segment_start, segment_label, segment_flip,
        vertex_base, first_edge, moved,
    )  # fmt: skip
    return n_vertices, n_edges


@njit(cache=True)
def _link_paths(
    origin: Corners, nxt: Corners, prev: Corners, face: Corners, label: Corners, made: Flags, edges: Ints, rules: Ints,
    count: int, segment_start: Ints, segment_label: Ints, segment_flip: Flags, vertex_base: Ints, n_edges: int,
    moved: Ints,
) -> None:  # fmt: skip
    """Put segments in the place of edges, through the vertices made for each."""
    for i in range(count):
        edge, base, first = edges[i], vertex_base[i], segment_start[rules[i]]
        h, m = 2 * edge, segment_start[rules[i] + 1] - first
        s, t = origin[h], origin[h + 1]
        out_of, back_into = nxt[h], prev[h + 1]
        left, right, kept = face[h], face[h + 1], label[edge]
        ahead, behind = prev[h], nxt[h + 1]
        for j in range(m):
            part = edge if j == 0 else n_edges + j - 1
            flip = 1 if segment_flip[first + j] else 0
            along, back = 2 * part + flip, 2 * part + 1 - flip
            origin[along] = s if j == 0 else base + j - 1
            origin[back] = t if j == m - 1 else base + j
            face[along], face[back] = left, right
            name = segment_label[first + j]
            label[part] = kept if name < 0 else name
            made[part] = True
            nxt[ahead], prev[along] = along, ahead
            nxt[back], prev[behind] = behind, back
            if j == 0:
                moved[h] = along
            ahead, behind = along, back
        n_edges += m - 1
        nxt[ahead], prev[out_of] = out_of, ahead
        nxt[back_into], prev[behind] = behind, back_into
        moved[h + 1] = behind
