"""Graph files as networkx writes them: read as names and numbers, with nothing unpickled, evaluated or expanded.

GraphML, GML, GEXF and node-link JSON are read by networkx. XML that declares a document type is refused before it gets
there, so that no entity is ever expanded. Edge lists and adjacency lists are read here, for the sake of line numbers.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any, Final, NamedTuple
from xml.parsers import expat

from genome.errors import InputError
from genome.mishaps import one_line, told

UNTOLD: Final = (".edgelist", ".adjlist")
"""Suffixes of files that do not tell whether their graph is directed."""


class Read(NamedTuple):
    """A graph as the file has it.

    Attributes
    ----------
    nodes
        Their names, as texts.
    edges
        Source, target, and the attribute ``weight``, whatever it is; ``None`` where there is none.
    directed
        Whether the edges are directed.
    labels
        For each node what it is called besides; empty where nodes have no labels.
    """

    nodes: tuple[str, ...]
    edges: tuple[tuple[str, str, object], ...]
    directed: bool
    labels: tuple[str, ...] = ()


class _BrokenError(Exception):
    """What is wrong with a file, and in which line, where that is known."""

    def __init__(self, problem: str, line: int | None = None) -> None:
        super().__init__(problem)
        self.line = line


def read_graph(path: Path, *, directed: bool) -> Read:
    """Read a graph file by its suffix.

    Parameters
    ----------
    path
        The file; it is there.
    directed
        Whether the edges of a file that does not tell are directed.

    Raises
    ------
    InputError
        With ``file`` as its place: for another suffix, or a file that is broken.
    """
    if path.suffix not in _READERS:
        known = ", ".join(_READERS)
        raise InputError("file", f"a graph file ({known})", f"'{path.name}'", "nothing else is read, nor unpickled")
    what, reader = _READERS[path.suffix]
    try:
        return reader(path.read_bytes(), directed)
    except _BrokenError as error:
        place = f"'{path.name}', line {error.line}" if error.line else f"'{path.name}'"
        raise InputError("file", what, f"{place}: {one_line(str(error))}", "write it anew") from None
    except OSError as error:
        raise InputError("file", what, f"'{path.name}' ({error.strerror or error})") from None
    except Exception as error:  # networkx's readers raise whatever a malformed file leads them to
        raise InputError(
            "file", what, f"'{path.name}', which cannot be read ({told(error)})", "write it anew"
        ) from error


def _graphml(content: bytes, directed: bool) -> Read:
    import networkx as nx

    del directed
    _refuse_broken_xml(content)
    return _of(nx.read_graphml(BytesIO(content)))


def _gexf(content: bytes, directed: bool) -> Read:
    import networkx as nx

    del directed
    _refuse_broken_xml(content)
    graph = nx.read_gexf(BytesIO(content), node_type=str)
    return _of(graph)._replace(labels=tuple(str(data.get("label", node)) for node, data in graph.nodes(data=True)))


def _gml(content: bytes, directed: bool) -> Read:
    import networkx as nx

    del directed
    lines = _text(content).splitlines()
    try:
        try:
            return _of(nx.parse_gml(lines, label="label"))
        except nx.NetworkXError as error:
            if "has no 'label' attribute" not in str(error):
                raise
            return _of(nx.parse_gml(lines, label="id"))
    except nx.NetworkXError as error:
        found = re.search(r"\((\d+), \d+\)", str(error))
        raise _BrokenError(str(error), int(found[1]) if found else None) from None


def _node_link(content: bytes, directed: bool) -> Read:
    import networkx as nx

    del directed
    try:
        data = json.loads(_text(content))
    except json.JSONDecodeError as error:
        raise _BrokenError(error.msg, error.lineno) from None
    if not isinstance(data, Mapping) or not isinstance(data.get("nodes"), list):
        raise _BrokenError("no object with 'nodes' and 'edges'")
    key = next((key for key in ("edges", "links") if isinstance(data.get(key), list)), None)
    if key is None:
        raise _BrokenError("neither 'edges' nor 'links'")
    return _of(nx.node_link_graph(dict(data), directed=False, multigraph=False, edges=key))


def _edge_list(content: bytes, directed: bool) -> Read:
    """Read lines of two nodes and, if there is one, a weight: a number, or as networkx writes it."""
    nodes: dict[str, None] = {}
    edges: list[tuple[str, str, object]] = []
    for number, line in _lines(content):
        source, _, rest = line.partition(" ")
        target, _, data = rest.strip().partition(" ")
        if not target:
            raise _BrokenError(f"'{line}', where two nodes stand", number)
        edges.append((source, target, _weight(data.strip(), number)))
        nodes.update({source: None, target: None})
    return Read(tuple(nodes), tuple(edges), directed)


def _adjacency(content: bytes, directed: bool) -> Read:
    """Read lines of a node and those that it has edges to."""
    nodes: dict[str, None] = {}
    edges: list[tuple[str, str, object]] = []
    seen: set[tuple[str, str]] = set()  # an undirected list may tell of an edge at both of its ends
    for _, line in _lines(content):
        source, *targets = line.split(" ")
        nodes.update(dict.fromkeys((source, *targets)))
        edges.extend((source, target, None) for target in targets if (source, target) not in seen)
        if not directed:
            seen.update((target, source) for target in targets if target != source)
    return Read(tuple(nodes), tuple(edges), directed)


_READERS: Final[Mapping[str, tuple[str, Callable[[bytes, bool], Read]]]] = {
    ".graphml": ("a GraphML file", _graphml),
    ".gml": ("a GML file", _gml),
    ".gexf": ("a GEXF file", _gexf),
    ".json": ("a node-link JSON file", _node_link),
    ".edgelist": ("an edge list", _edge_list),
    ".adjlist": ("an adjacency list", _adjacency),
}


def _of(graph: Any) -> Read:  # noqa: ANN401 - networkx has no types of its own
    """Give what is read of a networkx graph."""
    edges = tuple((str(source), str(target), data.get("weight")) for source, target, data in graph.edges(data=True))
    return Read(tuple(str(node) for node in graph.nodes), edges, bool(graph.is_directed()))


def _refuse_broken_xml(content: bytes) -> None:
    """Parse XML for its form alone, with its line numbers, and refuse what declares a document type."""

    def declares(*_: object) -> None:
        problem = "a document type, which graph files do without"
        raise _BrokenError(problem, parser.CurrentLineNumber)

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = declares
    try:
        parser.Parse(content, True)  # noqa: FBT003 - it takes no keywords
    except expat.ExpatError as error:
        raise _BrokenError(expat.errors.messages[error.code], error.lineno) from None


def _text(content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise _BrokenError("bytes that are not UTF-8", line) from None


def _lines(content: bytes) -> list[tuple[int, str]]:
    """Give the lines that say something, with their numbers: without comments, and with single spaces."""
    lines = ((number, line.partition("#")[0].split()) for number, line in enumerate(_text(content).splitlines(), 1))
    return [(number, " ".join(words)) for number, words in lines if words]


def _weight(data: str, line: int) -> float | None:
    found = re.fullmatch(r"(?:\{\s*(?:['\"]weight['\"]\s*:)?)?\s*(-?[0-9.]+(?:[eE][-+]?[0-9]+)?)?\s*\}?", data)
    try:
        if found is not None:
            return float(found[1]) if found[1] is not None else None
    except ValueError:
        pass
    raise _BrokenError(f"'{data}', where a weight or nothing stands", line)
