"""Graph files: read in every format that networkx writes, refused in a line when broken, kept with the run."""

from __future__ import annotations

import json
from pathlib import Path

import networkx as nx
import pytest

from experiments import bits, write
from genome.errors import InputError
from orchestrator.loading import load_experiment
from orchestrator.run import prepare
from orchestrator.topology.protocol import Ground, Link
from orchestrator.topology.registry import links_of

HERE = "x.yaml: channels.0.topology"
NAMES = ("north", "south", "east", "west")
WRITERS = {
    "graphml": nx.write_graphml,
    "gml": nx.write_gml,
    "gexf": nx.write_gexf,
    "json": lambda graph, path: path.write_text(json.dumps(nx.node_link_data(graph, edges="edges"))),
    "edgelist": nx.write_edgelist,
    "adjlist": nx.write_adjlist,
}
UNTOLD = ("edgelist", "adjlist")
WEIGHTLESS = ("adjlist",)


def links(folder: Path, name: str, names: tuple[str, ...] = NAMES, **parameters) -> list[Link]:
    return links_of("graph", {"file": name, **parameters}, Ground(names, folder), HERE)


def pairs(found: list[Link]) -> list[tuple[str, str]]:
    return [(NAMES[link.source], NAMES[link.target]) for link in found]


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_directed_graph_is_read_as_it_is(tmp_path, suffix) -> None:
    graph = nx.DiGraph([("north", "south"), ("south", "east"), ("east", "north"), ("west", "north")])
    graph.edges["south", "east"]["weight"] = 0.25
    WRITERS[suffix](graph, tmp_path / f"g.{suffix}")
    found = links(tmp_path, f"g.{suffix}", **({"directed": True} if suffix in UNTOLD else {}))
    assert sorted(pairs(found)) == sorted(graph.edges)
    weights = {(NAMES[link.source], NAMES[link.target]): link.weight for link in found if link.weight is not None}
    assert weights == ({} if suffix in WEIGHTLESS else {("south", "east"): 0.25})


@pytest.mark.parametrize("suffix", WRITERS)
def test_an_undirected_graph_has_its_edges_both_ways(tmp_path, suffix) -> None:
    graph = nx.Graph([("north", "south"), ("south", "east"), ("east", "west")])
    graph.edges["south", "east"]["weight"] = 0.5
    WRITERS[suffix](graph, tmp_path / f"g.{suffix}")
    found = links(tmp_path, f"g.{suffix}")
    assert sorted(pairs(found)) == sorted(graph.to_directed().edges)
    if suffix not in WEIGHTLESS:
        assert {link.weight for link in found if {link.source, link.target} == {1, 2}} == {0.5}


@pytest.mark.parametrize("suffix", WRITERS)
def test_nodes_may_be_places(tmp_path, suffix) -> None:
    WRITERS[suffix](nx.path_graph(4), tmp_path / f"g.{suffix}")
    found = [(link.source, link.target) for link in links(tmp_path, f"g.{suffix}")]
    assert found == [(0, 1), (1, 0), (1, 2), (2, 1), (2, 3), (3, 2)]


def test_labels_name_the_nodes_of_gml_and_gexf(tmp_path) -> None:
    (tmp_path / "g.gml").write_text(
        'graph [\n  directed 1\n  node [ id 7 label "west" ]\n  node [ id 9 label "east" ]\n'
        "  edge [ source 7 target 9 ]\n]\n", encoding="utf-8",
    )  # fmt: skip
    assert pairs(links(tmp_path, "g.gml")) == [("west", "east")]
    (tmp_path / "g.gexf").write_text(
        '<gexf xmlns="http://www.gexf.net/1.2draft" version="1.2"><graph defaultedgetype="directed"><nodes>'
        '<node id="0" label="west"/><node id="1" label="east"/></nodes><edges>'
        '<edge id="0" source="0" target="1"/></edges></graph></gexf>', encoding="utf-8",
    )  # fmt: skip
    assert pairs(links(tmp_path, "g.gexf")) == [("west", "east")]
    (tmp_path / "p.gml").write_text("graph [ node [ id 0 ] node [ id 3 ] edge [ source 0 target 3 ] ]\n")
    assert pairs(links(tmp_path, "p.gml")) == [("north", "west"), ("west", "north")]


def test_edge_lists_may_hold_comments_and_plain_weights(tmp_path) -> None:
    (tmp_path / "g.edgelist").write_text("# mine\nnorth south 0.5\n\nsouth  east  # one more\neast west {}\n")
    found = links(tmp_path, "g.edgelist", directed=True)
    assert pairs(found) == [("north", "south"), ("south", "east"), ("east", "west")]
    assert [link.weight for link in found] == [0.5, None, None]


def test_edge_lists_hold_attributes_as_networkx_writes_them(tmp_path) -> None:
    graph = nx.DiGraph()
    graph.add_edge("north", "south", colour="red {dark}", weight=0.25)
    graph.add_edge("south", "east", span=(1, 2.5), none=None)
    nx.write_edgelist(graph, tmp_path / "g.edgelist")
    with (tmp_path / "g.edgelist").open("a") as file:
        file.write("east west {'colour': '#ff0000', 'weight': 1} # {'weight': 0}\nwest north # {'weight': 0}\n")
    found = links(tmp_path, "g.edgelist", directed=True)
    weights = {(NAMES[link.source], NAMES[link.target]): link.weight for link in found}
    assert weights == {
        ("north", "south"): 0.25,
        ("south", "east"): None,
        ("east", "west"): 1.0,
        ("west", "north"): None,
    }


@pytest.mark.parametrize("suffix", WRITERS)
def test_what_is_too_large_to_be_a_graph_of_islands_is_not_read(tmp_path, suffix) -> None:
    limit = 4 if suffix == "gml" else 16
    (tmp_path / f"g.{suffix}").write_bytes(b" " * (limit * 2**20 + 1))
    with pytest.raises(InputError, match=rf"topology\.file: expected .*, got 'g\.{suffix}': more than {limit} MiB"):
        links(tmp_path, f"g.{suffix}")
    if suffix in UNTOLD:
        (tmp_path / f"g.{suffix}").write_bytes(b" " * (limit * 2**20))
        assert links(tmp_path, f"g.{suffix}") == []


def test_a_label_may_say_what_it_likes(tmp_path) -> None:
    labels = ["node [1]", "node [2]", "node [3]", "node [4]"]
    nx.write_gml(nx.path_graph(labels), tmp_path / "g.gml")
    assert len(links(tmp_path, "g.gml", tuple(labels))) == 6


def test_a_name_that_no_file_can_have_is_blamed_on_its_key(tmp_path) -> None:
    with pytest.raises(
        InputError, match=r"topology\.file: expected a graph file, got 'x{56}\.\.\. \(File name too long\)$"
    ):
        links(tmp_path, "x" * 300 + ".gml")


def test_an_undirected_adjacency_list_may_tell_of_an_edge_at_both_ends(tmp_path) -> None:
    (tmp_path / "g.adjlist").write_text("north south east\nsouth north\neast north\n")
    assert len(links(tmp_path, "g.adjlist")) == 4
    assert len(links(tmp_path, "g.adjlist", directed=True)) == 4


BOMB = (
    '<?xml version="1.0"?>\n<!DOCTYPE lolz [\n <!ENTITY a "aaaaaaaaaa">\n <!ENTITY b "&a;&a;&a;&a;&a;&a;&a;">\n]>\n'
    '<graphml><graph edgedefault="directed"><node id="&b;"/></graph></graphml>\n'
)
FETCH = '<!DOCTYPE x SYSTEM "file:///etc/hostname">\n<graphml/>\n'
BROKEN = [
    ("g.graphml", BOMB, "'g.graphml', line 2: a document type, which graph files do without"),
    ("g.gexf", BOMB, "'g.gexf', line 2: a document type"),
    ("g.graphml", FETCH, "'g.graphml', line 1: a document type"),
    ("g.graphml", "<graphml>\n<graph>\n</graphml>", "expected a GraphML file, got 'g.graphml', line 3: mismatched tag"),
    ("g.graphml", "", "'g.graphml', line 1: no element found"),
    ("g.graphml", '<graphml>\n<graph edgedefault="directed"/>\n<graph edgedefault="directed"/></graphml>',
     "'g.graphml', line 3: a second graph, of which networkx would read the first alone"),
    ("g.graphml", "<graphml><graph>" + "<node id='x'/>" * 4 + "\n<node id='x'/></graph></graphml>",
     "'g.graphml', line 2: more nodes than there are islands, 4"),
    ("g.gexf", f"<gexf><graph><nodes>{'<node/>' * 5}", "'g.gexf', line 1: more nodes than there are islands, 4"),
    ("g.gml", "graph [ " + "node [ ] " * 5 + "]", "'g.gml': more nodes than there are islands, 4"),
    ("g.json", json.dumps({"nodes": [{"id": n} for n in range(5)], "edges": []}), "'g.json': more nodes than there ar"),
    ("g.edgelist", "a b\nc d\ne a\n", "'g.edgelist', line 3: more nodes than there are islands, 4"),
    ("g.adjlist", "a b c\nd e\n", "'g.adjlist', line 2: more nodes than there are islands, 4"),
    ("g.json", '{"nodes": [], "edges": [], "links": []}', "'g.json': both 'edges' and 'links'"),
    ("g.edgelist", "north south {'weight': 0.5\n", "line 1: '{'weight': 0.5', where a weight or nothing stands"),
    ("g.edgelist", "north south 0.5}\n", "line 1: '0.5}', where a weight or nothing stands"),
    ("g.edgelist", "north south {0.5}\n", "line 1: '{0.5}', where a weight or nothing stands"),
    ("g.edgelist", "north south 1 {}\n", "line 1: '1 {}', where a weight or nothing stands"),
    ("g.edgelist", "north south {'x': " + "[" * 300 + "}\n", "where a weight or nothing stands"),
    ("g.edgelist", "north south {'x': '" + "y" * 10_000 + "'}\n", "yyy…', where a weight or nothing stands"),
    ("g.edgelist", "north south {'weight': '0.5'}\n", "expected weights from 0 to 1, got '0.5' of north - south"),
    ("g.edgelist", "north south nan\n", "expected weights from 0 to 1, got nan of north - south"),
    ("g.edgelist", f"{'n' * 500} south\n", f"got the node '{'n' * 56}...; rename it"),
    ("g.graphml", "<svg/>", "expected a GraphML file, got 'g.graphml', which cannot be read"),
    ("g.gexf", "<gexf", "expected a GEXF file, got 'g.gexf', line 1: unclosed token"),
    ("g.gexf", "<gexf/>", "expected a GEXF file, got 'g.gexf', which cannot be read"),
    ("g.gml", "graph [\n  node [ id 0 label ? ]\n]", "expected a GML file, got 'g.gml', line 2: "),
    ("g.gml", "nothing", "expected a GML file, got 'g.gml'"),
    ("g.gml", "\xff", "expected a GML file, got 'g.gml'"),
    ("g.json", "{\n \"nodes\": [,]\n}", "expected a node-link JSON file, got 'g.json', line 2: Expecting value"),
    ("g.json", "[]", "'g.json': no object with 'nodes' and 'edges'"),
    ("g.json", '{"nodes": []}', "'g.json': neither 'edges' nor 'links'"),
    ("g.json", '{"nodes": [{"id": "north"}], "edges": [{"source": "north"}]}', "'g.json', which cannot be read (KeyEr"),
    ("g.json", "[" * 100_000, "'g.json', which cannot be read (RecursionError"),
    ("g.edgelist", "north south\nnorth\n", "expected an edge list, got 'g.edgelist', line 2: 'north', where two nodes"),
    ("g.edgelist", "north south much\n", "'g.edgelist', line 1: 'much', where a weight or nothing stands"),
    ("g.edgelist", "north south {'weight': __import__('os')}\n", "line 1: '{'weight': __import__('os')}', where a wei"),
    ("g.edgelist", "north south 1.2.3\n", "line 1: '1.2.3', where a weight or nothing stands"),
    ("g.edgelist", "north south 1.5\n", "expected weights from 0 to 1, got 1.5 of north - south in 'g.edgelist'"),
    ("g.edgelist", "north south -1\n", "expected weights from 0 to 1, got -1.0 of"),
    ("g.edgelist", "north north\n", "expected edges between two islands, got north - north in 'g.edgelist'"),
    ("g.edgelist", "north south\nsouth north\n", "expected each edge once, got south - north in 'g.edgelist' again"),
    ("g.edgelist", "north nowhere\n", "expected nodes that are members (north, south, east, west), or their places fr"),
    ("g.edgelist", "0 4\n", "got the node '4'; rename it, or change 'among'"),
    ("g.edgelist", "north 1\n", "got the node '1'"),
    ("g.json", json.dumps({"nodes": [{"id": "north"}, {"id": "south"}], "edges": [
        {"source": "north", "target": "south", "weight": "heavy"}]}), "expected weights from 0 to 1, got 'heavy' of n"),
    ("g.json", json.dumps({"nodes": [{"id": "north"}, {"id": "south"}], "edges": [
        {"source": "north", "target": "south", "weight": True}]}), "expected weights from 0 to 1, got True of north -"),
    ("g.pickle", "", "expected a graph file (.graphml, .gml, .gexf, .json, .edgelist, .adjlist), got 'g.pickle'; noth"),
    ("graph", "", "expected a graph file (.graphml"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "content", "message"), BROKEN)
def test_a_broken_file_is_told_in_a_line(tmp_path, name, content, message) -> None:
    (tmp_path / name).write_bytes(content.encode("latin-1"))
    with pytest.raises(InputError) as caught:
        links(tmp_path, name)
    assert str(caught.value).startswith(f"{HERE}.file: ")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there_and_a_direction_that_is_told_twice(tmp_path) -> None:
    with pytest.raises(InputError, match=r"topology\.file: expected a graph file, got 'g\.gml', which is not there"):
        links(tmp_path, "g.gml")
    (tmp_path / "g.gml").mkdir()
    with pytest.raises(InputError, match=r"got 'g\.gml', which is a folder"):
        links(tmp_path, "g.gml")
    (tmp_path / "g.json").write_text("{}")
    with pytest.raises(
        InputError, match=r"topology\.directed: expected a file of \.edgelist or \.adjlist, got '\.json'"
    ):
        links(tmp_path, "g.json", directed=True)
    with pytest.raises(InputError, match=r"topology\.file: expected a text that is not empty, got ''$"):
        links(tmp_path, "")


def experiment(folder: Path) -> Path:
    nx.write_graphml(
        nx.DiGraph([("north-0", "north-1"), ("north-1", "south"), ("south", "north-0")]), folder / "g.graphml"
    )
    (folder / "more").mkdir()
    nx.write_graphml(nx.DiGraph([("south", "north-0"), ("north-0", "north-1"), ("north-1", "south")]),
                     folder / "more" / "g.graphml")  # fmt: skip
    data = bits(channels=[
        {"topology": {"name": "graph", "file": "g.graphml"}},
        {"topology": {"name": "graph", "file": "more/g.graphml"}, "every": 2},
    ])  # fmt: skip
    data["islands"]["north"]["count"] = 2
    return write(folder, data)


def test_the_error_names_the_line_of_the_experiment(tmp_path) -> None:
    path = experiment(tmp_path)
    (tmp_path / "g.graphml").write_text("<graphml>\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        prepare(load_experiment(path))
    line = next(n for n, text in enumerate(path.read_text().splitlines(), 1) if "g.graphml" in text)
    assert str(caught.value).startswith(
        f"{path}:{line}: channels.0.topology.file: expected a GraphML file, got 'g.graphml'"
    )


def test_graph_files_are_kept_with_the_run_which_runs_again_without_them(tmp_path) -> None:
    from experiments import Silent, run
    from orchestrator.digest import digest
    from orchestrator.run import make_backend, run_experiment

    path = experiment(tmp_path)
    outcome = run(tmp_path, json.loads(path.read_text()))
    kept = sorted(path.name for path in (outcome.folder / "graphs").iterdir())
    assert kept == ["g-2.graphml", "g.graphml"]
    (tmp_path / "g.graphml").unlink()
    (tmp_path / "more" / "g.graphml").unlink()
    loaded = load_experiment(outcome.folder / "experiment.yaml")
    again = run_experiment(loaded, make_backend(loaded, None), tmp_path / "again", None, Silent())
    assert digest(again.folder / "log") == digest(outcome.folder / "log")
