"""The invariants of a surface's map, checked one by one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from growth.hemls.map import HalfEdgeMap


def violations(m: HalfEdgeMap) -> list[str]:
    """Give every invariant that a map between two steps breaks, as sentences; empty for a sound map.

    Checked are: ``next`` and ``prev`` undo each other and keep the face, each half-edge starts where the one before
    it ends, each region is one loop, no edge lies with both sides in one region or in the exterior, no vertex is
    lonely or dangling, vertices are finite, and V - E + F = 1.
    """
    h = np.arange(2 * m.edges)
    nxt, prev, face, origin = (getattr(m, name)[: 2 * m.edges] for name in ("next", "prev", "face", "origin"))
    found: list[str] = []
    if not (np.array_equal(prev[nxt], h) and np.array_equal(nxt[prev], h)):
        return ["next and prev do not undo each other"]
    if not np.array_equal(face[nxt], face):
        found.append("a loop runs through two faces")
    if not np.array_equal(origin[nxt], origin[h ^ 1]):
        found.append("a half-edge does not start where the one before it ends")
    if np.any(face[0::2] == face[1::2]):
        found.append("an edge has the same face on both sides")
    loops = _count_loops(nxt)
    if loops != m.faces + 1 or set(np.unique(face).tolist()) != set(range(-1, m.faces)):
        found.append(f"{loops} loops for {m.faces} regions and one exterior")
    degree = np.bincount(origin, minlength=m.vertices)
    if len(degree) != m.vertices or degree.min() < 2:
        found.append("a vertex is lonely or dangling")
    if m.vertices - m.edges + m.faces != 1:
        found.append(f"V - E + F = {m.vertices - m.edges + m.faces}")
    if not np.isfinite(m.points[: m.vertices]).all():
        found.append("a vertex is not finite")
    return found


def _count_loops(nxt: NDArray[np.int32]) -> int:
    seen = np.zeros(len(nxt), dtype=bool)
    loops = 0
    for start in range(len(nxt)):
        if not seen[start]:
            loops += 1
            h = start
            while not seen[h]:
                seen[h] = True
                h = int(nxt[h])
    return loops
