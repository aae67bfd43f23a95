"""Space syntax: figures of small graphs, and what networkx and scipy find in random ones."""

import itertools
import math

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import shortest_path

from evaluators.space_syntax import analyse, d_value, of_edges, of_matrix
from genome.errors import InputError

PATH = [(0, 1), (1, 2), (2, 3), (3, 4)]
GRID = [(a, b) for a, b in itertools.combinations(range(9), 2) if abs(a // 3 - b // 3) + abs(a % 3 - b % 3) == 1]
STAR = [(0, leaf) for leaf in range(1, 6)]


def syntax(edges, count):
    return analyse(of_edges(edges, count))


@st.composite
def graphs(draw):
    """Edges in any direction, some twice, and a number of spaces; often in several parts."""
    count = draw(st.integers(0, 14))
    ends = st.integers(0, max(count - 1, 0))
    edges = draw(st.lists(st.tuples(ends, ends), max_size=25)) if count else []
    return edges, count


class TestFigures:
    def test_d_values(self):
        assert round(d_value(5), 4) == 0.3520
        assert round(d_value(10), 4) == 0.3056
        assert [d_value(k) for k in (0, 1, 2)] == [None, None, None]
        assert all(0 < d_value(k + 1) < d_value(k) for k in range(5, 400))

    def test_a_path_of_five(self):
        found = syntax(PATH, 5)
        assert found.total_depth.tolist() == [10, 7, 6, 7, 10]
        assert found.mean_depth.tolist() == [2.5, 1.75, 1.5, 1.75, 2.5]
        assert found.ra.tolist() == pytest.approx([1, 1 / 2, 1 / 3, 1 / 2, 1])
        assert found.rra[0] == pytest.approx(2.841, abs=5e-4)
        assert found.connectivity.tolist() == [1, 2, 2, 2, 1]
        assert found.control.tolist() == [0.5, 1.5, 1.0, 1.5, 0.5]
        assert found.choice.tolist() == [0, 3, 4, 3, 0]
        assert found.choice_share.tolist() == pytest.approx([0, 1 / 2, 2 / 3, 1 / 2, 0])

    def test_a_grid_of_nine(self):
        corner, edge, centre = 0.887, 1.267, 2.218
        expected = [corner, edge, corner, edge, centre, edge, corner, edge, corner]
        assert syntax(GRID, 9).integration.tolist() == pytest.approx(expected, abs=5e-4)

    def test_the_centre_of_a_star_is_integrated_without_bound(self):
        found = syntax(STAR, 6)
        assert found.integration[0] == math.inf
        assert found.rra[0] == 0
        assert (found.integration[1:] == 1 / found.rra[1:]).all()
        assert found.choice.tolist() == [10, 0, 0, 0, 0, 0]
        assert found.choice_share[0] == 1
        assert found.control.tolist() == pytest.approx([5, 0.2, 0.2, 0.2, 0.2, 0.2])

    def test_a_cycle_shares_its_shortest_paths(self):
        assert syntax([(0, 1), (1, 2), (2, 3), (3, 0)], 4).choice.tolist() == [0.5] * 4

    def test_a_diamond_is_what_rra_compares_with(self):
        """From the root on the levels hold 1, 2, 4, 2 and 1 spaces."""
        levels = [[0], [1, 2], [3, 4, 5, 6], [7, 8], [9]]
        down = [(a, b) for upper, lower in itertools.pairwise(levels) for a in upper for b in lower]
        assert syntax(down, 10).ra[0] == pytest.approx(d_value(10))


class TestWithoutValue:
    def test_two_spaces_and_one(self):
        found = syntax([(0, 1)], 3)
        assert found.mean_depth.tolist() == [1, 1, None]
        for values in (found.ra, found.rra, found.integration, found.choice_share):
            assert values.tolist() == [None, None, None]
            assert values.data.tolist() == [0, 0, 0]  # no NaN beneath the mask
        assert found.control.tolist() == [1, 1, 0]
        assert not found.connected

    def test_no_spaces(self):
        found = syntax([], 0)
        assert found.connected
        assert found.rra.tolist() == found.choice.tolist() == found.sizes.tolist() == []

    def test_parts_are_measured_as_if_alone(self):
        apart = [*PATH, *[(a + 5, b + 5) for a, b in GRID]]
        both, path, grid = syntax(apart, 14), syntax(PATH, 5), syntax(GRID, 9)
        assert not both.connected
        assert both.component.tolist() == [0] * 5 + [1] * 9
        assert both.sizes.tolist() == [5, 9]
        names = (
            "total_depth",
            "mean_depth",
            "ra",
            "rra",
            "integration",
            "connectivity",
            "control",
            "choice",
            "choice_share",
        )
        for name in names:
            assert getattr(both, name).tolist() == getattr(path, name).tolist() + getattr(grid, name).tolist()

    def test_components_are_numbered_by_their_first_spaces(self):
        assert syntax([(3, 0), (4, 1)], 5).component.tolist() == [0, 1, 2, 0, 1]


class TestAgainstPeers:
    @settings(max_examples=200)
    @given(given_graph=graphs())
    def test_networkx_and_scipy_agree(self, given_graph):
        edges, count = given_graph
        found = syntax(edges, count)
        peer = nx.Graph([(a, b) for a, b in edges if a != b])
        peer.add_nodes_from(range(count))
        between = nx.betweenness_centrality(peer, normalized=False) if count else {}
        assert found.choice.tolist() == pytest.approx([between[i] for i in range(count)], abs=1e-12)
        assert found.connectivity.tolist() == [peer.degree(i) for i in range(count)]
        assert found.control.tolist() == pytest.approx([sum(1 / peer.degree(j) for j in peer[i]) for i in range(count)])
        parts = {frozenset(part) for part in nx.connected_components(peer)}
        assert {frozenset(np.flatnonzero(found.component == c).tolist()) for c in range(found.sizes.size)} == parts
        if count:
            far = shortest_path(nx.to_scipy_sparse_array(peer, nodelist=range(count)), unweighted=True)
            assert found.total_depth.tolist() == np.where(np.isinf(far), 0, far).sum(axis=1).tolist()

    @settings(max_examples=50)
    @given(given_graph=graphs(), data=st.data())
    def test_the_order_of_edges_and_spaces_does_not_matter(self, given_graph, data):
        edges, count = given_graph
        order = data.draw(st.permutations(range(count)))
        moved = [(order[b], order[a]) for a, b in reversed(edges)]
        before, after = syntax(edges, count), syntax(moved, count)
        for name in ("total_depth", "rra", "integration", "choice"):
            values = getattr(after, name).tolist()
            assert [values[order[i]] for i in range(count)] == pytest.approx(
                getattr(before, name).tolist(), nan_ok=False
            )


class TestGraphs:
    def test_matrices_and_edges_make_the_same(self):
        one_way = coo_array(([1.0, 2.0, 0.0], ([0, 2, 3], [1, 1, 0])), shape=(4, 4))
        from_matrix, from_edges = of_matrix(one_way), of_edges([(1, 0), (1, 2), (2, 1), (3, 3)], 4)
        assert from_matrix.starts.tolist() == from_edges.starts.tolist() == [0, 1, 3, 4, 4]
        assert from_matrix.neighbours.tolist() == from_edges.neighbours.tolist() == [1, 0, 2, 1]
        assert one_way.nnz == 3  # left as it was

    EDGES = "graph: expected edges"

    @pytest.mark.parametrize(
        ("make", "message"),
        [
            (lambda: of_edges([(0, 1, 2)], 3), f"{EDGES} as (m, 2) integers, got int64 of shape (1, 3)"),
            (lambda: of_edges([(0.5, 1)], 3), f"{EDGES} as (m, 2) integers, got float64 of shape (1, 2)"),
            (
                lambda: of_edges([(0, 1), (1, 3)], 3),
                f"{EDGES} between spaces 0 to 2, got one between [1, 3]; number the spaces from 0",
            ),
            (
                lambda: of_edges([(-1, 0)], 3),
                f"{EDGES} between spaces 0 to 2, got one between [-1, 0]; number the spaces from 0",
            ),
            (
                lambda: of_matrix(np.zeros((2, 3)), "house"),
                "house: expected a square matrix of connections, got one of shape (2, 3)",
            ),
        ],
    )
    def test_others_are_refused(self, make, message):
        with pytest.raises(InputError) as caught:
            make()
        assert str(caught.value) == message
