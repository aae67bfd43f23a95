"""Hot loops that place branches and join them, compiled by Numba; the layout is that of ``_paths.py``.

A corner is named by the half-edge that leaves its vertex: it lies between that half-edge and the one before it in the
face's loop, to their left.
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
DIRECTION = 1e-9
"""Directions nearer to each other than this, in the measure of ``_turn``, are one."""
TIE = 1e-6
"""Angles are compared to this many degrees."""


@njit(cache=True)
def _turn(up: Reals, ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> float:
    """Give a measure in [0, 4) of the angle from a to b, counter-clockwise about ``up``, that grows with it.

    A quarter turn counts 1. Only the order of two measures from the same a is used, and this one needs no arc tangent.
    A direction along ``up`` has no bearing: then it is -1.
    """
    cross = up[0] * (ay * bz - az * by) + up[1] * (az * bx - ax * bz) + up[2] * (ax * by - ay * bx)
    a_up = ax * up[0] + ay * up[1] + az * up[2]
    b_up = bx * up[0] + by * up[1] + bz * up[2]
    dot = ax * bx + ay * by + az * bz - a_up * b_up
    size = abs(dot) + abs(cross)
    if not size * size > (DIRECTION * (ax * ax + ay * ay + az * az)) * (DIRECTION * (bx * bx + by * by + bz * bz)):
        return -1.0
    share = cross / size
    if dot < 0.0:
        return 2.0 - share
    return share if cross >= 0.0 else 4.0 + share


@njit(cache=True)
def _leaving(points: Reals, origin: Corners, h: int) -> tuple[float, float, float]:
    """Give the direction in which half-edge ``h`` leaves its vertex, not normalised."""
    a, b = origin[h], origin[h ^ 1]
    return points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]


@njit(cache=True)
def _wedge(
    points: Reals, origin: Corners, prev: Corners, first: int, dx: float, dy: float, dz: float, up: Reals,
) -> int:  # fmt: skip
    """Give the corner at the origin of half-edge ``first`` that a direction points into.

    -1 for a direction along ``up`` and one that no corner holds, -2 for one along an edge. Where the surface is folded
    and several corners hold it, the first one counter-clockwise from ``first`` counts.
    """
    corner, found = first, -1
    ex, ey, ez = _leaving(points, origin, first)
    turn = _turn(up, dx, dy, dz, ex, ey, ez)
    while True:
        if 0.0 <= turn < DIRECTION or turn > 4.0 - DIRECTION:
            return -2
        following = prev[corner] ^ 1
        ex, ey, ez = _leaving(points, origin, following)
        beyond = _turn(up, dx, dy, dz, ex, ey, ez)
        # Measured from the direction, edges that follow each other turn on, but for the two that have it in between.
        if found < 0 and turn >= 0.0 and (0.0 <= beyond < turn - DIRECTION or following == corner):
            found = corner
        corner, turn = following, beyond
        if corner == first:
            return found


@njit(cache=True)
def _width(points: Reals, origin: Corners, corner: int, following: int, up: Reals) -> float:
    """Give the measure from an edge to the next: 4 at the end of a chain, 0 for one direction, -1 for no bearing."""
    if following == corner:
        return 4.0
    ax, ay, az = _leaving(points, origin, corner)
    bx, by, bz = _leaving(points, origin, following)
    width = _turn(up, ax, ay, az, bx, by, bz)
    # Which of two edges that lie on each other comes first is rounding, not a full turn.
    return 0.0 if width > 4.0 - DIRECTION else width


@njit(cache=True)
def _leaving_node(
    i: int, r: int, node: int, m: int, edges: Ints, edge_base: Ints, segment_start: Ints, segment_flip: Flags,
    chain_out: Ints,
) -> int:  # fmt: skip
    """Give a half-edge that leaves a template's node on the map, -1 where the node was dropped."""
    if node > m:
        return chain_out[node]
    j = min(node, m - 1)
    part = edges[i] if j == 0 else edge_base[i] + j - 1
    flip = 1 if segment_flip[segment_start[r] + j] else 0
    along = 2 * part + flip
    return along if node < m else along ^ 1


@njit(cache=True)
def draw_chains(
    points: Reals, origin: Corners, nxt: Corners, prev: Corners, face: Corners, label: Corners, made: Flags,
    n_edges: int, edges: Ints, rules: Ints, count: int, segment_start: Ints, segment_flip: Flags, chain_start: Ints,
    chains: Ints, vertex_base: Ints, edge_base: Ints, frames: Reals, chain_out: Ints, outs: Ints,
) -> int:  # fmt: skip
    """Link the edges of bracketed chains into the regions that they point into.

    ``outs`` (count, widest template) receives for each chained node a half-edge that leaves it, -1 where the chain
    was dropped since it points into the exterior or along an edge. Gives the new number of edges.
    """
    for i in range(count):
        r = rules[i]
        m = segment_start[r + 1] - segment_start[r]
        chain_out[:] = -1
        up = frames[i, 6:9]
        for c in range(chain_start[r], chain_start[r + 1]):
            start, end, name, flip = chains[c, 0], chains[c, 1], chains[c, 2], chains[c, 3]
            leaving = _leaving_node(i, r, start, m, edges, edge_base, segment_start, segment_flip, chain_out)
            if leaving < 0:
                continue
            a, b = origin[leaving], vertex_base[i] + end - 2
            dx, dy, dz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
            corner = _wedge(points, origin, prev, leaving, dx, dy, dz, up)
            if corner < 0 or face[corner] == EXTERIOR:
                continue
            out, back = 2 * n_edges + flip, 2 * n_edges + 1 - flip
            origin[out], origin[back] = a, b
            face[out] = face[back] = face[corner]
            before = prev[corner]
            nxt[before], prev[out] = out, before
            nxt[out], prev[back] = back, out
            nxt[back], prev[corner] = corner, back
            label[n_edges], made[n_edges] = name, True
            n_edges += 1
            chain_out[end] = back
        outs[i] = chain_out
    return n_edges


@njit(cache=True)
def place_branches(
    points: Reals, origin: Corners, prev: Corners, face: Corners, edges: Ints, rules: Ints, count: int,
    segment_start: Ints, segment_flip: Flags, branch_start: Ints, branch_node: Ints, branch_label: Ints,
    headings: Reals, edge_base: Ints, frames: Reals, outs: Ints, n_branches: int, corner: Corners, heading: Reals,
    branch_up: Reals, branch_name: Corners,
) -> int:  # fmt: skip
    """Put each branch into the corner that its heading points into; one that points into the exterior is dropped.

    Appends to the branch arrays from ``n_branches`` on and gives the new number of branches.
    """
    for i in range(count):
        r = rules[i]
        m = segment_start[r + 1] - segment_start[r]
        length = math.sqrt(frames[i, 0] ** 2 + frames[i, 1] ** 2 + frames[i, 2] ** 2)
        for b in range(branch_start[r], branch_start[r + 1]):
            leaving = _leaving_node(i, r, branch_node[b], m, edges, edge_base, segment_start, segment_flip, outs[i])
            if leaving < 0 or not length > 0.0:
                continue
            for axis in range(3):
                heading[n_branches, axis] = (
                    headings[b, 0] * frames[i, axis] / length
                    + headings[b, 1] * frames[i, 3 + axis]
                    + headings[b, 2] * frames[i, 6 + axis]
                )
                branch_up[n_branches, axis] = frames[i, 6 + axis]
            d = heading[n_branches]
            found = _wedge(points, origin, prev, leaving, d[0], d[1], d[2], branch_up[n_branches])
            if found < 0 or face[found] == EXTERIOR:
                continue
            corner[n_branches], branch_name[n_branches] = found, branch_label[b]
            n_branches += 1
    return n_branches


@njit(cache=True)
def replace_branches(
    points: Reals, origin: Corners, prev: Corners, face: Corners, moved: Ints, n_branches: int, corner: Corners,
    heading: Reals, branch_up: Reals, alive: Flags,
) -> None:  # fmt: skip
    """Follow the corners of branches left from earlier rules through a rewriting.

    A branch stays in its region. ``alive`` (n_branches,) bool is cleared for one that an edge now lies along.
    """
    for b in range(n_branches):
        h = corner[b]
        if h < moved.shape[0] and moved[h] >= 0:
            h = moved[h]
        d = heading[b]
        found = _wedge(points, origin, prev, h, d[0], d[1], d[2], branch_up[b])
        corner[b] = found if found >= 0 and face[found] == face[h] else h
        alive[b] = found != -2


@njit(cache=True)
def _joint(
    points: Reals, origin: Corners, corner: Corners, heading: Reals, a: int, b: int, least: float,
) -> tuple[float, float, float]:  # fmt: skip
    """Give the two angles in degrees between a branch and the segment to the other, and the distance.

    Points no farther apart than ``least`` coincide: the segment between them has no direction.
    """
    p, q = origin[corner[a]], origin[corner[b]]
    dx, dy, dz = points[q, 0] - points[p, 0], points[q, 1] - points[p, 1], points[q, 2] - points[p, 2]
    distance = math.sqrt(dx * dx + dy * dy + dz * dz)
    if p == q or not distance > least:
        return 180.0, 180.0, 0.0
    return _between(heading[a], dx, dy, dz), _between(heading[b], -dx, -dy, -dz), distance


@njit(cache=True)
def _between(h: Reals, dx: float, dy: float, dz: float) -> float:
    """Give the angle between two vectors in degrees, accurate near zero."""
    cx, cy, cz = h[1] * dz - h[2] * dy, h[2] * dx - h[0] * dz, h[0] * dy - h[1] * dx
    return math.degrees(math.atan2(math.sqrt(cx * cx + cy * cy + cz * cz), h[0] * dx + h[1] * dy + h[2] * dz))


@njit(cache=True)
def group_branches(
    face: Corners, corner: Corners, branch_name: Corners, n_branches: int, n_faces: int, n_labels: int,
) -> tuple[Ints, Ints, int]:  # fmt: skip
    """Sort branches by region and label; give the order, and the number of pairs that share both."""
    key = np.empty(n_branches, dtype=np.int64)
    for b in range(n_branches):
        key[b] = np.int64(face[corner[b]]) * n_labels + branch_name[b]
    if n_faces * n_labels > 8 * n_branches + 64:
        order = np.argsort(key, kind="mergesort")
    else:
        order = np.empty(n_branches, dtype=np.int64)
        place = np.zeros(n_faces * n_labels + 1, dtype=np.int64)
        for b in range(n_branches):
            place[key[b] + 1] += 1
        for i in range(n_faces * n_labels):
            place[i + 1] += place[i]
        for b in range(n_branches):
            order[place[key[b]]] = b
            place[key[b]] += 1
    pairs, run = 0, 1
    for i in range(1, n_branches + 1):
        if i < n_branches and key[order[i]] == key[order[i - 1]]:
            run += 1
        else:
            pairs += run * (run - 1) // 2
            run = 1
    return order, key, pairs


@njit(cache=True)
def find_joints(
    points: Reals, origin: Corners, corner: Corners, heading: Reals, order: Ints, key: Ints, pairs: int,
    branch_angle: float, least: float, limit: float,
) -> tuple[Ints, Ints, Ints, Reals]:  # fmt: skip
    """Find the pairs of branches that may join (Hemberg 2006, section 4.3, step 3).

    Returns
    -------
    tuple
        First and second branch (first at the lower vertex), the sum of their angles in steps of ``TIE`` degrees, and
        their distance.
    """
    first, second = np.empty(pairs, dtype=np.int64), np.empty(pairs, dtype=np.int64)
    bend, span = np.empty(pairs, dtype=np.int64), np.empty(pairs, dtype=np.float64)
    found, start = 0, 0
    for i in range(1, order.size + 1):
        if i < order.size and key[order[i]] == key[order[start]]:
            continue
        for j in range(start, i):
            for k in range(j + 1, i):
                a, b = order[j], order[k]
                at_a, at_b, distance = _joint(points, origin, corner, heading, a, b, least)
                if at_a < branch_angle - TIE and at_b < branch_angle - TIE and distance <= limit:
                    low = origin[corner[a]] < origin[corner[b]]
                    first[found], second[found] = (a, b) if low else (b, a)
                    bend[found], span[found] = np.int64(round((at_a + at_b) / TIE)), distance
                    found += 1
        start = i
    return first[:found], second[:found], bend[:found], span[:found]


@njit(cache=True)
def join(
    points: Reals, origin: Corners, nxt: Corners, prev: Corners, face: Corners, label: Corners, made: Flags,
    n_vertices: int, n_edges: int, n_faces: int, n_branches: int, corner: Corners, heading: Reals, branch_up: Reals,
    branch_name: Corners, alive: Flags, firsts: Ints, seconds: Ints,
) -> tuple[int, int]:  # fmt: skip
    """Join pairs of branches, best first; each joined edge splits its region.

    Parameters are as everywhere in this file; ``alive`` (n_branches,) bool is cleared for branches that joined or that
    a joined edge lies along.
    Gives the new numbers of edges and faces.
    """
    head = np.full(n_vertices, -1, dtype=np.int64)
    chain = np.full(n_branches, -1, dtype=np.int64)
    for b in range(n_branches - 1, -1, -1):
        v = origin[corner[b]]
        chain[b], head[v] = head[v], b
    for i in range(firsts.size):
        a, b = firsts[i], seconds[i]
        if not (alive[a] and alive[b]) or face[corner[a]] != face[corner[b]]:
            continue
        at_u, at_w = corner[a], corner[b]
        before_u, before_w = prev[at_u], prev[at_w]
        f = face[at_u]
        there, back = 2 * n_edges, 2 * n_edges + 1
        origin[there], origin[back] = origin[at_u], origin[at_w]
        nxt[before_u], prev[there] = there, before_u
        nxt[there], prev[at_w] = at_w, there
        nxt[before_w], prev[back] = back, before_w
        nxt[back], prev[at_u] = at_u, back
        face[there] = face[back] = f
        label[n_edges], made[n_edges] = branch_name[a], False
        n_edges += 1
        _claim_shorter_loop(nxt, face, there, back, n_faces)
        n_faces += 1
        alive[a] = alive[b] = False
        _divide_corner(points, origin, prev, corner, heading, branch_up, alive, head, chain, at_u, there)
        _divide_corner(points, origin, prev, corner, heading, branch_up, alive, head, chain, at_w, back)
    return n_edges, n_faces


@njit(cache=True)
def _claim_shorter_loop(nxt: Corners, face: Corners, one: int, other: int, new_face: int) -> None:
    """Give the new face to the shorter of two loops, walked in step; to that of ``other`` where they are equal."""
    p, q = nxt[one], nxt[other]
    while p != one and q != other:
        p, q = nxt[p], nxt[q]
    start = other if q == other else one
    h = start
    while True:
        face[h] = new_face
        h = nxt[h]
        if h == start:
            return


@njit(cache=True)
def _divide_corner(
    points: Reals, origin: Corners, prev: Corners, corner: Corners, heading: Reals, branch_up: Reals, alive: Flags,
    head: Ints, chain: Ints, old: int, new: int,
) -> None:  # fmt: skip
    """Move branches of the corner ``old`` that lie beyond the new half-edge ``new`` into the corner of ``new``.

    A branch along the new half-edge lies in neither half and goes.
    """
    following = prev[new] ^ 1
    ox, oy, oz = _leaving(points, origin, old)
    nx, ny, nz = _leaving(points, origin, new)
    b = head[origin[old]]
    while b >= 0:
        if alive[b] and corner[b] == old:
            up, d = branch_up[b], heading[b]
            width = _width(points, origin, old, following, up)
            turn, cut = _turn(up, ox, oy, oz, d[0], d[1], d[2]), _turn(up, ox, oy, oz, nx, ny, nz)
            if min(width, turn, cut) < 0.0:
                alive[b] = False
            else:
                turn, cut = _beside(turn, width), _beside(cut, width)
                alive[b] = abs(turn - cut) > DIRECTION
                if turn > cut:
                    corner[b] = new
        b = chain[b]


@njit(cache=True)
def _beside(turn: float, width: float) -> float:
    """Make the measure of a direction outside a corner negative where the corner's first edge is the nearer one.

    A joined edge bends away from its heading and can leave its corner; what lies in the corner is then beyond it.
    """
    if turn > width and 2.0 * _degrees(turn) > 360.0 + _degrees(width):
        return turn - 4.0
    return turn


@njit(cache=True)
def _degrees(turn: float) -> float:
    """Give the angle that a measure of ``_turn`` stands for."""
    quarter = math.floor(turn)
    return 90.0 * quarter + math.degrees(math.atan2(turn - quarter, 1.0 - turn + quarter))


@njit(cache=True)
def keep_alive(
    n_branches: int, corner: Corners, heading: Reals, branch_up: Reals, branch_name: Corners, alive: Flags,
) -> int:  # fmt: skip
    """Close the gaps that joined branches left; give the number that remain."""
    kept = 0
    for b in range(n_branches):
        if alive[b]:
            corner[kept], branch_name[kept] = corner[b], branch_name[b]
            heading[kept], branch_up[kept] = heading[b], branch_up[b]
            kept += 1
    return kept
