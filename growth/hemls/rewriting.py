"""One application of rules to a map, and the joining of the branches that it leaves."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from growth.environment import Environment
from growth.hemls import _branches, _paths, _whole
from growth.hemls.map import HalfEdgeMap
from growth.hemls.program import Program
from growth.protocol import Budget, Failure

Ints = NDArray[np.int64]
LOOKS = 200
"""Edges that may be looked at to place chains and branches, for each edge of the budget: a rule of up to a hundred
brackets never comes near, one that draws a fan of thousands would take minutes."""

COINCIDENT = 1e-9
"""Points nearer than this share of the form's size coincide, and distances nearer to each other are equal."""


@dataclass(slots=True)
class Branches:
    """Branches that wait to be joined: the corner each lies in, heading and up (unit vectors), and label."""

    count: int = 0
    corner: NDArray[np.int32] = field(default_factory=lambda: np.zeros(0, dtype=np.int32))
    heading: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 3)))
    up: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 3)))
    label: NDArray[np.int32] = field(default_factory=lambda: np.zeros(0, dtype=np.int32))

    def reserve(self, more: int) -> None:
        """Make room for so many more branches."""
        room = self.count + more
        for name in ("corner", "heading", "up", "label"):
            old = getattr(self, name)
            new = np.zeros((room, *old.shape[1:]), dtype=old.dtype)
            new[: self.count] = old[: self.count]
            setattr(self, name, new)


@dataclass(slots=True)
class Rewriting:
    """The rewriting of one map by one program: what a derivation step does after the map has grown in size."""

    map: HalfEdgeMap
    program: Program
    environment: Environment
    budget: Budget
    branch_angle: float
    branch_distance: float
    n_labels: int
    branches: Branches = field(default_factory=Branches)
    chained: list[tuple[int, int]] = field(default_factory=list)

    def choose(self, group: tuple[int, int]) -> tuple[Ints, Ints]:
        """Give the edges that a group of rules rewrites now, in order of number, and the rule for each."""
        m, p = self.map, self.program
        edges, rules = np.empty(m.edges, dtype=np.int64), np.empty(m.edges, dtype=np.int64)
        n = _paths.choose_rules(m.prev, m.label, m.made, m.edges, *group, p.label, p.before, p.after, edges, rules)
        return edges[:n], rules[:n]

    def apply(self, edges: Ints, rules: Ints) -> Failure | None:
        """Replace edges by the successors of their rules and place the branches."""
        m, p = self.map, self.program
        uses = np.bincount(rules, minlength=len(p.label))
        more_vertices, more_edges = int(uses @ p.new_vertices), int(uses @ p.new_edges)
        more_branches = int(uses @ p.new_branches)
        if m.edges + more_edges > self.budget.elements:
            return over_budget("edges", m.edges + more_edges, self.budget.elements, "max_elements")
        if self.branches.count + more_branches > 4 * self.budget.elements:
            return over_budget(
                "branches", self.branches.count + more_branches, 4 * self.budget.elements, "max_elements"
            )
        looks = int(uses @ p.looks)
        if looks > LOOKS * self.budget.elements:
            return over_budget(
                "looks round the vertices of chains", looks, LOOKS * self.budget.elements, "max_elements"
            )
        m.reserve(m.vertices + more_vertices, m.edges + more_edges)
        self.branches.reserve(more_branches)
        return self._draw(edges, rules)

    def _draw(self, edges: Ints, rules: Ints) -> Failure | None:
        m, p, n = self.map, self.program, len(edges)
        normals = np.empty((m.faces, 3))
        _paths.face_normals(m.points, m.origin, m.face, m.edges, normals)
        vertex_base, edge_base = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
        frames, moved = np.empty((n, 9)), np.full(2 * m.edges, -1, dtype=np.int64)
        old_vertices = m.vertices
        m.vertices, m.edges = _paths.draw_paths(
            m.points, m.origin, m.next, m.prev, m.face, m.label, m.made, m.vertices, m.edges, normals, edges, rules,
            n, p.node_start, p.nodes, p.segment_start, p.segment_label, p.segment_flip, vertex_base, edge_base,
            frames, moved,
        )  # fmt: skip
        failure = release(self.map, self.environment, old_vertices)
        if failure is not None:
            return failure
        outs = np.full((n, p.widest), -1, dtype=np.int64)
        if p.widest:
            old_edges = m.edges
            m.edges = _branches.draw_chains(
                m.points, m.origin, m.next, m.prev, m.face, m.label, m.made, m.edges, edges, rules, n,
                p.segment_start, p.segment_flip, p.chain_start, p.chains, vertex_base, edge_base, frames,
                outs,
            )  # fmt: skip
            self.chained.append((old_edges, m.edges))
        b = self.branches
        if b.count:
            alive = np.ones(b.count, dtype=np.bool_)
            _branches.replace_branches(
                m.points, m.origin, m.prev, m.face, moved, b.count, b.corner, b.heading, b.up, alive
            )
            b.count = _branches.keep_alive(b.count, b.corner, b.heading, b.up, b.label, alive)
        if len(p.branch_node):
            b.count = _branches.place_branches(
                m.points, m.origin, m.prev, m.face, edges, rules, n, p.segment_start, p.segment_flip, p.branch_start,
                p.branch_node, p.branch_label, p.headings, edge_base, frames, outs, b.count, b.corner, b.heading,
                b.up, b.label,
            )  # fmt: skip
        return None

    def join(self) -> Failure | None:
        """Join what can be joined, the best pair first (Hemberg 2006, section 4.3, step 3)."""
        m, b = self.map, self.branches
        if b.count < 2:
            return None
        order, key, pairs = _branches.group_branches(m.face, b.corner, b.label, b.count, m.faces, self.n_labels)
        if pairs > self.budget.pairs:
            return over_budget("pairs of branches in one joining", pairs, self.budget.pairs, "max_pairs")
        size = _whole.extent(m.points, m.vertices)
        if not math.isfinite(size):
            return Failure("diverged", "a vertex left the range of numbers")
        first, second, bend, span = _branches.find_joints(
            m.points, m.origin, b.corner, b.heading, order, key, pairs, self.branch_angle, size * COINCIDENT,
            self.branch_distance,
        )  # fmt: skip
        if not len(first):
            return None
        best = self._best_first(first, second, bend, span / (size * COINCIDENT))
        m.reserve(m.vertices, m.edges + b.count // 2)
        alive = np.ones(b.count, dtype=np.bool_)
        m.edges, m.faces = _branches.join(
            m.points, m.origin, m.next, m.prev, m.face, m.label, m.made, m.vertices, m.edges, m.faces, b.count,
            b.corner, b.heading, b.up, b.label, alive, first[best], second[best],
        )  # fmt: skip
        b.count = _branches.keep_alive(b.count, b.corner, b.heading, b.up, b.label, alive)
        if m.edges > self.budget.elements:
            return over_budget("edges", m.edges, self.budget.elements, "max_elements")
        return None

    def _best_first(self, first: Ints, second: Ints, bend: Ints, span: NDArray[np.float64]) -> Ints:
        """Order pairs of branches by the sum of their angles, their distance, and their vertices.

        Distances that differ by rounding alone are equal, so that vertices decide and not the last bit. Several pairs
        can have the same ends: then the label decides, then the order in which branches were drawn.
        """
        m, b = self.map, self.branches
        # Distances, in parts of 1e-9 of the extent, are under 2^31.
        order = (bend << 32) + np.rint(span).astype(np.int64)
        ends = m.origin[b.corner[first]].astype(np.int64) * m.vertices + m.origin[b.corner[second]]
        best = np.lexsort((ends, order))
        ordered = ends[best]
        if np.any(ordered[1:] == ordered[:-1]):
            best = np.lexsort((second, first, b.label[first], ends, order))
        return best

    def finish(self) -> None:
        """Take away the branches that found no partner, and their chains."""
        m = self.map
        chained = np.concatenate([np.arange(a, b) for a, b in self.chained]) if self.chained else np.zeros(0, int)
        if len(chained) or self.program.widest:
            dead = np.zeros(m.edges, dtype=np.bool_)
            _whole.prune(m.next, m.prev, chained.astype(np.int64), dead)
            m.vertices, m.edges = _whole.compact(
                m.points, m.origin, m.next, m.prev, m.face, m.label, m.vertices, m.edges, dead
            )
        m.made[:] = False
        self.branches, self.chained = Branches(), []


def release(m: HalfEdgeMap, environment: Environment, first: int) -> Failure | None:
    """Move vertices from number ``first`` on that lie inside a hard boundary to the nearest point outside."""
    if not environment.has_hard or first >= m.vertices:
        return None
    moved = environment.release(m.points[first : m.vertices])
    if moved is None:
        return Failure("boundary", "a vertex inside a boundary has no place outside all of them")
    m.points[first : m.vertices] = moved
    return None


def over_budget(what: str, count: int, most: int, key: str) -> Failure:
    """Give the failure of a growth that would make too much."""
    return Failure("budget", f"{count} {what} where {key} allows {most}")
