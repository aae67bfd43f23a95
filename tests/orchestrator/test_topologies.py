"""Topologies: what every one of them promises, and what each of them is."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from genome.errors import InputError
from orchestrator.topology.protocol import Ground
from orchestrator.topology.registry import OPEN, TOPOLOGIES, edges_of, links_of

ROOT = Path(__file__).resolve().parents[2]
FIXED = [name for name in TOPOLOGIES if name not in ("random", "edges", "graph")]
CONNECTED = [name for name in FIXED if name != "unconnected"]
SYMMETRIC = [name for name in FIXED if name != "ring"]
COUNTS = (1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 16, 27, 32)
HERE = "x.yaml: channels.0.topology"


def digraph(name: str, count: int, **parameters) -> nx.DiGraph:
    graph = nx.DiGraph()
    graph.add_nodes_from(range(count))
    graph.add_edges_from(edges_of(name, count, HERE, **parameters))
    return graph


def fitting(name: str) -> list[int]:
    """The counts that a topology takes with its defaults."""
    counts = []
    for count in COUNTS:
        try:
            edges_of(name, count, HERE)
        except InputError:
            continue
        counts.append(count)
    return counts


@pytest.mark.parametrize("name", FIXED)
def test_edges_ascend_without_loops_or_repetitions_and_join_places_that_are_there(name) -> None:
    assert fitting(name)
    for count in fitting(name):
        edges = edges_of(name, count, HERE)
        assert edges == sorted(set(edges))
        assert all(source != target for source, target in edges)
        assert all(type(end) is int and 0 <= end < count for edge in edges for end in edge)


@pytest.mark.parametrize("name", FIXED)
def test_one_island_alone_has_no_edges(name) -> None:
    assert edges_of(name, 1, HERE) == []
    for parameters in ({"rows": 2, "columns": 4}, {"rows": 3}):
        if name in ("torus", "grid"):
            assert edges_of(name, 1, HERE, **parameters) == []


@pytest.mark.parametrize("name", CONNECTED)
def test_every_island_reaches_every_other(name) -> None:
    for count in fitting(name):
        assert nx.is_strongly_connected(digraph(name, count))


@pytest.mark.parametrize("name", SYMMETRIC)
def test_undirected_ones_have_both_directions(name) -> None:
    for count in fitting(name):
        edges = set(edges_of(name, count, HERE))
        assert {(target, source) for source, target in edges} == edges


SAME = {
    "ring": lambda n: nx.cycle_graph(n, nx.DiGraph),
    "bidirectional_ring": lambda n: nx.cycle_graph(n).to_directed(),
    "line": lambda n: nx.path_graph(n).to_directed(),
    "star": lambda n: nx.star_graph(n - 1).to_directed(),
    "wheel": lambda n: nx.wheel_graph(n).to_directed(),
    "complete": lambda n: nx.complete_graph(n).to_directed(),
    "unconnected": lambda n: nx.empty_graph(n, nx.DiGraph),
}


@pytest.mark.parametrize("name", SAME)
def test_equal_to_networkx_place_by_place(name) -> None:
    for count in fitting(name):
        if count > 2:
            assert sorted(SAME[name](count).edges) == edges_of(name, count, HERE)


@pytest.mark.parametrize(("rows", "columns"), [(2, 2), (2, 3), (2, 4), (3, 3), (4, 4), (3, 5), (5, 3)])
def test_lattices_are_those_of_networkx(rows, columns) -> None:
    for name, periodic in (("grid", False), ("torus", True)):
        reference = nx.grid_2d_graph(rows, columns, periodic=periodic)
        reference.remove_edges_from(list(nx.selfloop_edges(reference)))
        numbered = nx.relabel_nodes(reference, {(r, c): r * columns + c for r, c in reference}).to_directed()
        assert sorted(numbered.edges) == edges_of(name, rows * columns, HERE, rows=rows, columns=columns)
        assert edges_of(name, rows * columns, HERE, rows=rows) == sorted(numbered.edges)
        assert edges_of(name, rows * columns, HERE, columns=columns) == sorted(numbered.edges)


@pytest.mark.parametrize(("count", "rows"), [(4, 2), (6, 2), (8, 2), (9, 3), (12, 3), (16, 4), (24, 4), (1000, 25)])
def test_lattices_are_nearest_to_square_by_themselves(count, rows) -> None:
    assert edges_of("torus", count, HERE) == edges_of("torus", count, HERE, rows=rows)
    assert edges_of("grid", count, HERE) == edges_of("grid", count, HERE, rows=rows)


@pytest.mark.parametrize("digits", range(6))
def test_the_hypercube_joins_places_that_differ_in_one_digit(digits) -> None:
    graph = digraph("hypercube", 2**digits)
    if digits:
        assert nx.is_isomorphic(graph.to_undirected(), nx.hypercube_graph(digits))
    assert all((source ^ target).bit_count() == 1 for source, target in graph.edges)


@pytest.mark.parametrize("branching", [1, 2, 3])
@pytest.mark.parametrize("count", COUNTS)
def test_the_tree_is_a_full_tree_cut_short(branching, count) -> None:
    reference = nx.full_rary_tree(branching, count).to_directed()
    assert sorted(reference.edges) == edges_of("tree", count, HERE, branching=branching)


@pytest.mark.parametrize("attach", [1, 2, 5])
def test_barabasi_albert_attaches_each_newcomer_to_so_many(attach) -> None:
    graph = digraph("barabasi_albert", 40, attach=attach, seed=3).to_undirected()
    assert graph.number_of_edges() == attach + attach * (40 - attach - 1)
    assert min(degree for _, degree in graph.degree) >= 1
    assert all(len([other for other in graph[place] if other < place]) == attach for place in range(attach + 1, 40))


def test_watts_strogatz_without_rewiring_is_the_lattice_and_keeps_the_number_of_edges_with_it() -> None:
    lattice = nx.watts_strogatz_graph(20, 6, 0.0).to_directed()
    assert edges_of("watts_strogatz", 20, HERE, neighbours=6, rewiring=0.0) == sorted(lattice.edges)
    rewired = edges_of("watts_strogatz", 20, HERE, neighbours=6, rewiring=0.5, seed=1)
    assert len(rewired) == 20 * 6
    assert rewired != sorted(lattice.edges)


def test_erdos_renyi_has_edges_as_likely_as_asked_for() -> None:
    assert edges_of("erdos_renyi", 12, HERE, probability=1.0) == edges_of("complete", 12, HERE)
    pairs = 60 * 59 / 2
    counts = [len(edges_of("erdos_renyi", 60, HERE, probability=0.3, seed=seed)) / 2 for seed in range(40)]
    deviation = (pairs * 0.3 * 0.7 / len(counts)) ** 0.5
    assert abs(sum(counts) / len(counts) - 0.3 * pairs) < 4 * deviation


DRAWN = ("barabasi_albert", "watts_strogatz", "erdos_renyi")


@pytest.mark.parametrize("name", DRAWN)
def test_drawn_graphs_follow_from_their_seed_alone(name) -> None:
    def drawn(run: int, channel: int, **parameters) -> list:
        ground = Ground(tuple(map(str, range(64))), seed=run, channel=channel)
        return links_of(name, parameters, ground, HERE)

    assert drawn(1, 0) == drawn(1, 0)
    assert len({tuple(drawn(seed, channel)) for seed in (1, 2) for channel in (0, 1)}) == 4
    assert drawn(1, 0, seed=5) == drawn(2, 3, seed=5) != drawn(1, 0, seed=6)


@pytest.mark.parametrize("seed", range(20))
def test_a_graph_that_leaves_islands_out_is_drawn_again(seed) -> None:
    # Of 16 islands at this probability about one graph in five is connected.
    graph = digraph("erdos_renyi", 16, probability=0.18, seed=seed)
    assert nx.is_strongly_connected(graph)


def test_what_is_drawn_hangs_on_no_hash_seed() -> None:
    code = (
        "from orchestrator.topology.registry import edges_of\n"
        f"print([edges_of(name, 30, '', seed=9) for name in {DRAWN!r}])"
    )
    told = [
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)},
        ).stdout
        for seed in ("0", "1", "4711")
    ]  # fmt: skip
    assert told[0].strip()
    assert len(set(told)) == 1
    assert told[0].strip() == str([edges_of(name, 30, "", seed=9) for name in DRAWN])


MISFITS = [
    ("hypercube", 7, {}, "topology: expected 4 or 8 islands, got 7"),
    ("hypercube", 3, {}, "expected 2 or 4 islands, got 3"),
    ("torus", 7, {}, "expected 6 (2 x 3) or 8 (2 x 4) islands, got 7; or take topology: bidirectional_ring"),
    ("torus", 2, {}, "expected 4 (2 x 2) islands, got 2"),
    ("torus", 13, {}, "expected 12 (3 x 4) or 14 (2 x 7) islands, got 13"),
    ("grid", 5, {}, "expected 4 (2 x 2) or 6 (2 x 3) islands, got 5; or take topology: line"),
    ("torus", 8, {"rows": 3, "columns": 3}, "topology: expected 3 x 3 = 9 islands, got 8; change rows or columns"),
    ("grid", 8, {"rows": 3}, "topology.rows: expected rows that divide 8 islands: 2, 4, got 3"),
    ("grid", 8, {"columns": 8}, "topology.columns: expected columns that divide 8 islands: 2, 4, got 8"),
    ("grid", 8, {"rows": 1}, "topology.rows: expected greater than or equal to 2, got 1"),
    ("torus", 7, {"rows": 7}, "topology.rows: expected rows that divide 7 islands, got 7; take 6 (2 x 3) or"),
    ("wheel", 3, {}, "expected 4 or more islands, got 3"),
    ("wheel", 2, {}, "expected 4 or more islands, got 2"),
    ("watts_strogatz", 16, {"neighbours": 3}, "neighbours: expected an even number, at most 14 for 16 islands, got 3"),
    ("watts_strogatz", 4, {}, "neighbours: expected an even number, at most 2 for 4 islands, got 4"),
    ("watts_strogatz", 2, {}, "topology: expected 3 or more islands, got 2; or take topology: line"),
    ("watts_strogatz", 9, {"rewiring": 1.1}, "rewiring: expected less than or equal to 1, got 1.1"),
    ("barabasi_albert", 4, {"attach": 4}, "topology.attach: expected at most 3 for 4 islands, got 4"),
    ("erdos_renyi", 50, {"probability": 0.001}, "every one of 50 islands is reached, got none such among 200 drawn"),
    ("erdos_renyi", 50, {"probability": 0.0}, "probability: expected greater than 0, got 0.0"),
    ("tree", 4, {"branching": 0}, "branching: expected greater than or equal to 1, got 0"),
    ("tree", 4, {"branchings": 2}, "branchings: expected a known key, got 'branchings'; did you mean 'branching'?"),
    ("ring", 4, {"rows": 2}, "topology: expected parameters that 'ring' takes, got an unexpected keyword argument"),
    ("edges", 4, {}, "topology.edges: expected a value for 'edges', got nothing"),
    ("edges", 4, {"edges": [[0, 1], [1, 1]]}, "topology.edges.1: expected two islands, got '1' twice"),
    ("edges", 4, {"edges": [[0, 1], [0, 1]]}, "topology.edges.1: expected each edge once, got 0 -> 1 again, as edge 0"),
    ("edges", 4, {"edges": [[0, 4]]}, "topology.edges.0: expected a member's name, or its place from 0 to 3, got 4"),
    ("edges", 4, {"edges": [[-1, 2]]}, "its place from 0 to 3, got -1"),
    (
        "edges",
        4,
        {"edges": [["a", 1]]},
        "edges.0: expected a member of the channel, by name or place, got 'a'",
    ),
    ("edges", 4, {"edges": [[0, 1, 1.5]]}, "topology.edges.0: expected a weight from 0 to 1, got 1.5"),
    ("edges", 4, {"edges": [[0, 1, True]]}, "topology.edges.0: expected a weight from 0 to 1, got True"),
    ("edges", 4, {"edges": [[0, 1, 0.5, 2]]}, "topology.edges.0: expected a list of two islands, and a weight"),
    ("edges", 4, {"edges": [[True, 1]]}, "topology.edges.0: expected a list of two islands"),
    ("edges", 4, {"edges": "a b"}, "topology.edges: expected a list, got 'a b'"),
]


@pytest.mark.parametrize(("name", "count", "parameters", "message"), MISFITS)
def test_what_does_not_fit_is_told_with_what_would(name, count, parameters, message) -> None:
    with pytest.raises(InputError) as caught:
        edges_of(name, count, HERE, **parameters)
    assert message in str(caught.value)
    assert str(caught.value).startswith(HERE)


@given(st.integers(2, 300))
def test_the_numbers_that_would_fit_do(count) -> None:
    for name in ("torus", "grid", "hypercube", "wheel"):
        try:
            edges_of(name, count, HERE)
        except InputError as error:
            proposed = [
                int(number) for number in re.findall(r"(\d+)(?: \(|$| or)", error.expected.split(" islands")[0])
            ]
            assert proposed
            for other in proposed:
                assert edges_of(name, other, HERE)


def test_edges_are_named_by_island_or_place_and_weighted() -> None:
    ground = Ground(("a", "b", "c"))
    links = links_of("edges", {"edges": [["c", "a", 0.5], [0, "b"], ["b", 2, 1]]}, ground, HERE)
    assert links == [(0, 1, None), (1, 2, 1.0), (2, 0, 0.5)]
    assert links_of("edges", {"edges": []}, ground, HERE) == []


def test_every_open_topology_is_one_of_the_project() -> None:
    assert set(OPEN) < set(TOPOLOGIES)


def test_the_page_s_table_tells_degrees_and_diameters_of_sixteen_islands() -> None:
    text = (ROOT / "docs" / "topologies.md").read_text(encoding="utf-8")
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]
    told = {row[0].strip("`"): row[2:5] for row in rows if row[0].strip("`") in TOPOLOGIES}
    assert list(told) == list(TOPOLOGIES)
    for name in (
        "ring",
        "bidirectional_ring",
        "line",
        "star",
        "wheel",
        "torus",
        "grid",
        "hypercube",
        "complete",
        "tree",
    ):
        graph = digraph(name, 16)
        degrees = sorted({degree for _, degree in graph.out_degree})
        degree = str(degrees[0]) if len(degrees) == 1 else f"{degrees[0]} to {degrees[-1]}"
        assert told[name] == [degree, str(graph.number_of_edges()), str(nx.diameter(graph))], name
