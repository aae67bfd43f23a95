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


@njit(cache=True, inline="always")
def _turn(
    ux: float, uy: float, uz: float, ax: float, ay: float, az: float, bx: float, by: float, bz: float,
) -> float:  # fmt: skip
    """Give a measure in [0, 4) of the angle from a to b, counter-clockwise about u, that grows with it.

    A quarter turn counts 1. Only the order of two measures from the same a is used, and this one needs no arc tangent.
    A direction along u has no bearing: then it is -1.
    """
    cross = ux * (ay * bz - az * by) + uy * (az * bx - ax * bz) + uz * (ax * by - ay * bx)
    a_up = ax * ux + ay * uy + az * uz
    b_up = bx * ux + by * uy + bz * uz
    dot = ax * bx + ay * by + az * bz - a_up * b_up
    size = abs(dot) + abs(cross)
    if not size * size > (DIRECTION * (ax * ax + ay * ay + az * az)) * (DIRECTION * (bx * bx + by * by + bz * bz)):
        return -1.0
    share = cross / size
    if dot < 0.0:
        return 2.0 - share
    return share if cross >= 0.0 else 4.0 + share


@njit(cache=True, inline="always")
def _leaving(points: Reals, origin: Corners, h: int) -> tuple[float, float, float]:
    """Give the direction in which half-edge ``h`` leaves its vertex, not normalised."""
    a, b = origin[h], origin[h ^ 1]
    return points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]


@njit(cache=True, inline="always")
def _wedge(
    points: Reals, origin: Corners, prev: Corners, first: int, dx: float, dy: float, dz: float, ux: float, uy: float,
    uz: float,
) -> int:  # fmt: skip
    """Give the corner at the origin of half-edge ``first`` that a direction points into.

    -1 for a direction along u and one that no corner holds, -2 for one along an edge. Where the surface is folded
    and several corners hold it, the first one counter-clockwise from ``first`` counts.
    """
    corner, found = first, -1
    ex, ey, ez = _leaving(points, origin, first)
    turn = _turn(ux, uy, uz, dx, dy, dz, ex, ey, ez)
    while True:
        if 0.0 <= turn < DIRECTION or turn > 4.0 - DIRECTION:
            return -2
        following = prev[corner] ^ 1
        ex, ey, ez = _leaving(points, origin, following)
        beyond = _turn(ux, uy, uz, dx, dy, dz, ex, ey, ez)
        # Measured from the direction, edges that follow each other turn on, but for the two that have it in between.
        if found < 0 and turn >= 0.0 and (0.0 <= beyond < turn - DIRECTION or following == corner):
            found = corner
        corner, turn = following, beyond
        if corner == first:
            return found


@njit(cache=True)
def _width(
    points: Reals, origin: Corners, corner: int, following: int, ux: float, uy: float, uz: float,
) -> float:  # fmt: skip
    """Give the measure from an edge to the next: 4 at the end of a chain, 0 for one direction, -1 for no bearing."""
    if following == corner:
        return 4.0
    ax, ay, az = _leaving(points, origin, corner)
    bx, by, bz = _leaving(points, origin, following)
    width = _turn(ux, uy, uz, ax, ay, az, bx, by, bz)
    # Which of two edges that lie on each other comes first is rounding, not a full turn.
    return 0.0 if width > 4.0 - DIRECTION else width


@njit(cache=True, inline="always")
def _leaving_node(
    i: int, r: int, node: int, m: int, edges: Ints, edge_base: Ints, segment_start: Ints, segment_flip: Flags,
    outs: Ints,
) -> int:  # fmt: skip
    """Give a half-edge that leaves a template's node on the map, -1 where the node was dropped."""
    if node > m:
        return outs[i, node]
    j = min(node, m - 1)
    part = edges[i] if j == 0 else edge_base[i] + j - 1
    flip = 1 if segment_flip[segment_start[r] + j] else 0
    along = 2 * part + flip
    return along if node < m else along ^ 1


@njit(cache=True)
def draw_chains(
    points: Reals, origin: Corners, nxt: Corners, prev: Corners, face: Corners, label: Corners, made: Flags,
    n_edges: int, edges: Ints, rules: Ints, count: int, segment_start: Ints, segment_flip: Flags, chain_start: Ints,
    chains: Ints, vertex_base: Ints, edge_base: Ints, frames: Reals, outs: Ints,
) -> int:  # fmt: skip
    """Link the edges of bracketed chains into the regions that they point into.

    ``outs`` (count, widest template), -1 at first, receives for each chained node a half-edge that leaves it; -1
    stays where the chain was dropped since it points into the exterior or along an edge. Gives the new number of edges.
    """
    for i in range(count):
        r = rules[i]
        m = segment_start[r + 1] - segment_start[r]
        ux, uy, uz = frames[i, 6], frames[i, 7], frames[i, 8]
        for c in range(chain_start[r], chain_start[r + 1]):
            start, end, name, flip = chains[c, 0], chains[c, 1], chains[c, 2], chains[c, 3]
            leaving = _leaving_node(i, r, start, m, edges, edge_base, segment_start, segment_flip, outs)
            if leaving < 0:
                continue
            a, b = origin[leaving], vertex_base[i] + end - 2
            dx, dy, dz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
            corner = _wedge(points, origin, prev, leaving, dx, dy, dz, ux, uy, uz)
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
            outs[i, end] = back
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
        ux, uy, uz = frames[i, 6], frames[i, 7], frames[i, 8]
        for b in range(branch_start[r], branch_start[r + 1]):
            leaving = _leaving_node(i, r, branch_node[b], m, edges, edge_base, segment_start, segment_flip, outs)
            if leaving < 0 or not length > 0.0:
                continue
            ahead, side, above = headings[b, 0] / length, headings[b, 1], headings[b, 2]
            dx = ahead * frames[i, 0] + side * frames[i, 3] + above * ux
            dy = ahead * frames[i, 1] + side * frames[i, 4] + above * uy
            dz = ahead * frames[i, 2] + side * frames[i, 5] + above * uz
            found = _wedge(points, origin, prev, leaving, dx, dy, dz, ux, uy, uz)
            if found < 0 or face[found] == EXTERIOR:
                continue
            heading[n_branches, 0], heading[n_branches, 1], heading[n_branches, 2] = dx, dy, dz
            branch_up[n_branches, 0], branch_up[n_branches, 1], branch_up[n_branches, 2] = ux, uy, uz
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
        dx, dy, dz = heading[b, 0], heading[b, 1], heading[b, 2]
        found = _wedge(points, origin, prev, h, dx, dy, dz, branch_up[b, 0], branch_up[b, 1], branch_up[b, 2])
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
    at_a = _between(heading[a, 0], heading[a, 1], heading[a, 2], dx, dy, dz)
    return at_a, _between(heading[b, 0], heading[b, 1], heading[b, 2], -dx, -dy, -dz), distance


@njit(cache=True)
def _between(hx: float, hy: float, hz: float, dx: float, dy: float, dz: float) -> float:
    """Give the angle between two vectors in degrees, accurate near zero."""
    cx, cy, cz = hy * dz - hz * dy, hz * dx - hx * dz, hx * dy - hy * dx
    return math.degrees(math.atan2(math.sqrt(cx * cx + cy * cy + cz * cz), hx * dx + hy * dy + hz * dz))


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
        at_u, at_w = corner[a], corner[b]
        if not (alive[a] and alive[b]) or face[at_u] != face[at_w]:
            continue
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
        # Give the new face to the shorter of the two loops, walked in step.
        p, q = nxt[there], nxt[back]
        while p != there and q != back:
            p, q = nxt[p], nxt[q]
        h = start = back if q == back else there
        while True:
            face[h] = n_faces
            h = nxt[h]
            if h == start:
                break
        n_faces += 1
        alive[a] = alive[b] = False
        b = head[origin[at_u]]
        while b >= 0:
            if alive[b] and corner[b] == at_u:
                _divide_corner(points, origin, prev, corner, heading, branch_up, alive, b, at_u, there)
            b = chain[b]
        b = head[origin[at_w]]
        while b >= 0:
            if alive[b] and corner[b] == at_w:
                _divide_corner(points, origin, prev, corner, heading, branch_up, alive, b, at_w, back)
            b = chain[b]
    return n_edges, n_faces


@njit(cache=True)
def _divide_corner(
    points: Reals, origin: Corners, prev: Corners, corner: Corners, heading: Reals, branch_up: Reals, alive: Flags,
    b: int, old: int, new: int,
) -> None:  # fmt: skip
    """Move a branch of the corner ``old`` that lies beyond the new half-edge ``new`` into the corner of ``new``.

    A branch along the new half-edge lies in neither half and goes.
    """
    ox, oy, oz = _leaving(points, origin, old)
    nx, ny, nz = _leaving(points, origin, new)
    dx, dy, dz = heading[b, 0], heading[b, 1], heading[b, 2]
    ux, uy, uz = branch_up[b, 0], branch_up[b, 1], branch_up[b, 2]
    width = _width(points, origin, old, prev[new] ^ 1, ux, uy, uz)
    turn = _turn(ux, uy, uz, ox, oy, oz, dx, dy, dz)
    cut = _turn(ux, uy, uz, ox, oy, oz, nx, ny, nz)
    if min(width, turn, cut) < 0.0:
        alive[b] = False
        return
    turn, cut = _beside(turn, width), _beside(cut, width)
    alive[b] = abs(turn - cut) > DIRECTION
    if turn > cut:
        corner[b] = new


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
