"""A rewrite system made ready for the kernels: rules in the order of their groups, templates as flat arrays."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from growth.hemls.rules import System
from growth.hemls.template import Template, draw_all

Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Program:
    """What the kernels read; ``*_start`` arrays say where a rule's part of the array after them begins.

    Attributes
    ----------
    groups
        (first, one past last) rule of each group, groups in the order of their first rule.
    label, before, after
        (R,) int64: predecessor and context labels, -1 for none.
    node_start, nodes
        (R + 1,) int64 and (n, 3) float64.
    segment_start, segment_label, segment_flip
        (R + 1,), (s,) int64 and (s,) bool.
    chain_start, chains
        (R + 1,) and (c, 4) int64: from node, to node, label, reversed.
    branch_start, branch_node, branch_label, headings
        (R + 1,), (b,), (b,) int64 and (b, 3) float64.
    """

    groups: tuple[tuple[int, int], ...]
    label: Ints
    before: Ints
    after: Ints
    node_start: Ints
    nodes: NDArray[np.float64]
    segment_start: Ints
    segment_label: Ints
    segment_flip: NDArray[np.bool_]
    chain_start: Ints
    chains: Ints
    branch_start: Ints
    branch_node: Ints
    branch_label: Ints
    headings: NDArray[np.float64]

    @cached_property
    def widest(self) -> int:
        """The most nodes that a template has, 0 where no rule has chains."""
        return int(np.diff(self.node_start).max()) if len(self.chains) else 0

    @cached_property
    def new_vertices(self) -> Ints:
        """(R,) vertices that each rule adds to an edge."""
        return np.diff(self.node_start) - 2

    @cached_property
    def new_edges(self) -> Ints:
        """(R,) edges that each rule adds to an edge, joined ones not counted."""
        return np.diff(self.segment_start) - 1 + np.diff(self.chain_start)

    @cached_property
    def looks(self) -> Ints:
        """(R,) edges that are looked at to place what a rule draws: at most all chains, for each chain and branch."""
        chains, branches = np.diff(self.chain_start), np.diff(self.branch_start)
        return np.asarray((chains + 2) * (chains + branches))

    @cached_property
    def new_branches(self) -> Ints:
        """(R,) branches that each rule draws."""
        return np.diff(self.branch_start)


def compile_system(system: System) -> Program:
    """Draw a system's rules and lay them out group by group."""
    first: dict[int, int] = {}
    for rule in system.rules:
        first.setdefault(rule.label, len(first))
    order = sorted(range(len(system.rules)), key=lambda i: first[system.rules[i].label])
    rules = [system.rules[i] for i in order]
    drawn = draw_all(system)
    templates = [drawn[i] for i in order]
    labels = [rule.label for rule in rules]
    bounds = [i for i in range(len(rules)) if i == 0 or labels[i] != labels[i - 1]] + [len(rules)]
    return Program(
        groups=tuple(itertools.pairwise(bounds)),
        label=_ints(labels),
        before=_ints([-1 if rule.before is None else rule.before for rule in rules]),
        after=_ints([-1 if rule.after is None else rule.after for rule in rules]),
        **_flat(templates),
    )


def _flat(templates: Sequence[Template]) -> dict[str, Any]:
    segments = [segment for template in templates for segment in template.segments]
    branches = [branch for template in templates for branch in template.branches]
    chains = [chain for template in templates for chain in template.chains]
    return {
        "node_start": _starts([len(t.nodes) for t in templates]),
        "nodes": np.vstack([t.nodes for t in templates]),
        "segment_start": _starts([len(t.segments) for t in templates]),
        "segment_label": _ints([label for label, _ in segments]),
        "segment_flip": np.array([flip for _, flip in segments], dtype=np.bool_),
        "chain_start": _starts([len(t.chains) for t in templates]),
        "chains": _ints(chains).reshape(-1, 4),
        "branch_start": _starts([len(t.branches) for t in templates]),
        "branch_node": _ints([node for node, _ in branches]),
        "branch_label": _ints([label for _, label in branches]),
        "headings": np.vstack([t.headings for t in templates]),
    }


def _ints(values: Sequence[object]) -> Ints:
    return np.array(values, dtype=np.int64)


def _starts(lengths: Sequence[int]) -> Ints:
    return np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
