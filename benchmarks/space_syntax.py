"""Space syntax of a plan of 1,000 spaces, against the same figures by networkx.

The plan is a Delaunay triangulation of random points, of whose edges three in five are doors, and which hangs together.
Both sides start from the list of edges. Limit: at least five times as fast.
"""

from __future__ import annotations

import networkx as nx
import numpy as np
from scipy.spatial import Delaunay

from benchmarks.timing import best_of
from evaluators.space_syntax import SpaceSyntax, analyse, d_value, of_edges

SPACES = 1_000
DOORS = 0.6
LIMIT = 5.0


def plan() -> np.ndarray:
    """Give the doors: (m, 2) int64. A spanning tree of the triangulation is kept whole."""
    rng = np.random.default_rng(6)
    corners = Delaunay(rng.random((SPACES, 2))).simplices
    sides = np.unique(
        np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1), axis=0
    )
    tree = nx.minimum_spanning_edges(nx.Graph(sides.tolist()), data=False)
    kept = sides[rng.random(len(sides)) < DOORS].tolist()
    return np.unique(np.sort(np.array([*kept, *tree]), axis=1), axis=0)


def by_networkx(doors: np.ndarray) -> dict[str, list[float]]:
    """Give depth, RRA, control and choice of each space."""
    graph = nx.Graph(doors.tolist())
    size = d_value(SPACES)
    assert size is not None
    found: dict[str, list[float]] = {"total_depth": [], "rra": [], "control": []}
    between = nx.betweenness_centrality(graph, normalized=False)
    for space in range(SPACES):
        depth = sum(nx.single_source_shortest_path_length(graph, space).values())
        found["total_depth"].append(depth)
        found["rra"].append(2.0 * (depth / (SPACES - 1) - 1.0) / (SPACES - 2) / size)
        found["control"].append(sum(1.0 / graph.degree(near) for near in graph[space]))
    return {**found, "choice": [between[space] for space in range(SPACES)]}


def main() -> bool:
    """Print the ratio; tell whether it is within its limit."""
    doors = plan()

    def ours() -> SpaceSyntax:
        return analyse(of_edges(doors, SPACES))

    found, expected = ours(), by_networkx(doors)
    assert all(np.allclose(getattr(found, name), values) for name, values in expected.items())
    own, theirs = best_of(ours, lambda: by_networkx(doors), rounds=3)
    print(f"space_syntax: {SPACES} spaces, {len(doors)} doors in {own * 1e3:.1f} ms, networkx {theirs * 1e3:.0f} ms")
    print(f"space_syntax: {theirs / own:.0f} times as fast (at least {LIMIT:g})")
    return theirs / own >= LIMIT


if __name__ == "__main__":
    raise SystemExit(not main())
