"""Graph files as networkx writes them: read as names and numbers, with nothing unpickled, evaluated or expanded.

GraphML, GML, GEXF and node-link JSON are read by networkx. XML that declares a document type is refused before it gets
there, so that no entity is ever expanded. Edge lists and adjacency lists are read here, for the sake of line numbers.
What is too large to be a graph of the islands is refused before it is parsed.
"""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Callable, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any, Final, NamedTuple
from xml.parsers import expat

from genome.errors import InputError
from genome.mishaps import one_line, told
from genome.settings import describe

UNTOLD: Final = (".edgelist", ".adjlist")
"""Suffixes of files that do not tell whether their graph is directed."""


MEBIBYTE: Final = 2**20
MOST: Final = 16 * MEBIBYTE
"""The largest file that is read, in bytes."""
MOST_GML: Final = 4 * MEBIBYTE
"""The largest GML file, which is slow to read."""
MOST_ATTRIBUTES: Final = 10_000
"""The longest attributes of one edge in an edge list, in characters."""


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


def read_graph(path: Path, *, directed: bool, most: int) -> Read:
    """Read a graph file by its suffix.

    Parameters
    ----------
    path
        The file; it is there.
    directed
        Whether the edges of a file that does not tell are directed.
    most
        Nodes that it may have.

    Raises
    ------
    InputError
        With ``file`` as its place: for another suffix, or a file that is broken or too large.
    """
    if path.suffix not in _READERS:
        known = ", ".join(_READERS)
        raise InputError("file", f"a graph file ({known})", f"'{path.name}'", "nothing else is read, nor unpickled")
    what, reader = _READERS[path.suffix]
    try:
        return reader(_content(path), directed, most)
    except _BrokenError as error:
        place = f"'{path.name}', line {error.line}" if error.line else f"'{path.name}'"
        raise InputError("file", what, f"{place}: {one_line(str(error))}", "write it anew") from None
    except OSError as error:
        raise InputError("file", what, f"'{path.name}' ({error.strerror or error})") from None
    except Exception as error:  # networkx's readers raise whatever a malformed file leads them to
        raise InputError(
            "file", what, f"'{path.name}', which cannot be read ({told(error)})", "write it anew"
        ) from error


def _content(path: Path) -> bytes:
    limit = MOST_GML if path.suffix == ".gml" else MOST
    with path.open("rb") as file:
        content = file.read(limit + 1)
    if len(content) > limit:
        problem = f"more than {limit // MEBIBYTE} MiB"
        raise _BrokenError(problem)
    return content


def _graphml(content: bytes, directed: bool, most: int) -> Read:
    import networkx as nx

    del directed
    _refuse_broken_xml(content, most)
    return _of(nx.read_graphml(BytesIO(content)))


def _gexf(content: bytes, directed: bool, most: int) -> Read:
    import networkx as nx

    del directed
    _refuse_broken_xml(content, most)
    graph = nx.read_gexf(BytesIO(content), node_type=str)
    return _of(graph)._replace(labels=tuple(str(data.get("label", node)) for node, data in graph.nodes(data=True)))


def _gml(content: bytes, directed: bool, most: int) -> Read:
    import networkx as nx

    del directed
    text = _text(content)
    # What stands in quotes is no node.
    _refuse_more(sum(found[0][0] != '"' for found in re.finditer(r'"[^"]*"|\bnode\s*\[', text)), most)
    lines = text.splitlines()
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


def _node_link(content: bytes, directed: bool, most: int) -> Read:
    import networkx as nx

    del directed
    try:
        data = json.loads(_text(content))
    except json.JSONDecodeError as error:
        raise _BrokenError(error.msg, error.lineno) from None
    if not isinstance(data, Mapping) or not isinstance(data.get("nodes"), list):
        raise _BrokenError("no object with 'nodes' and 'edges'")
    _refuse_more(len(data["nodes"]), most)
    keys = [key for key in ("edges", "links") if isinstance(data.get(key), list)]
    if len(keys) != 1:
        raise _BrokenError("both 'edges' and 'links'" if keys else "neither 'edges' nor 'links'")
    return _of(nx.node_link_graph(dict(data), directed=False, multigraph=False, edges=keys[0]))


def _edge_list(content: bytes, directed: bool, most: int) -> Read:
    """Read lines of two nodes and, if they are there, a weight or a dictionary of attributes as networkx writes it."""
    nodes: dict[str, None] = {}
    edges: list[tuple[str, str, object]] = []
    for number, line in enumerate(_text(content).splitlines(), 1):
        # A comment begins before the attributes or after them: a sign within them is one of theirs.
        begin = line.find("{") if "{" in line.partition("#")[0] else len(line)
        end = line.rfind("}") + 1 if "}" in line[begin:] else begin
        words = line[:begin].partition("#")[0].split()
        data = line[begin:end] + line[end:].partition("#")[0].rstrip()
        if not words:
            continue
        if len(words) < 2:
            raise _BrokenError(f"{describe(line.strip())}, where two nodes stand", number)
        edges.append((words[0], words[1], _weight(" ".join(words[2:]), data, number)))
        nodes.update({words[0]: None, words[1]: None})
        _refuse_more(len(nodes), most, number)
    return Read(tuple(nodes), tuple(edges), directed)


def _adjacency(content: bytes, directed: bool, most: int) -> Read:
    """Read lines of a node and those that it has edges to."""
    nodes: dict[str, None] = {}
    edges: list[tuple[str, str, object]] = []
    seen: set[tuple[str, str]] = set()  # an undirected list may tell of an edge at both of its ends
    for number, (source, *targets) in _lines(content):
        nodes.update(dict.fromkeys((source, *targets)))
        _refuse_more(len(nodes), most, number)
        edges.extend((source, target, None) for target in targets if (source, target) not in seen)
        if not directed:
            seen.update((target, source) for target in targets if target != source)
    return Read(tuple(nodes), tuple(edges), directed)


_READERS: Final[Mapping[str, tuple[str, Callable[[bytes, bool, int], Read]]]] = {
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


def _refuse_more(nodes: int, most: int, line: int | None = None) -> None:
    """Refuse a graph of more nodes than it may have."""
    if nodes > most:
        problem = f"more nodes than there are islands, {most}"
        raise _BrokenError(problem, line)


def _refuse_broken_xml(content: bytes, most: int) -> None:
    """Parse XML for its form alone, with its line numbers; refuse a document type, a second graph, too many nodes."""
    counts = {"node": 0, "graph": 0}

    def declares(*_: object) -> None:
        problem = "a document type, which graph files do without"
        raise _BrokenError(problem, parser.CurrentLineNumber)

    def begins(name: str, attributes: object) -> None:
        del attributes
        if (kind := name.rpartition(":")[2]) in counts:
            counts[kind] += 1
            _refuse_more(counts["node"], most, parser.CurrentLineNumber)
            if counts["graph"] > 1:
                problem = "a second graph, of which networkx would read the first alone"
                raise _BrokenError(problem, parser.CurrentLineNumber)

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = declares
    parser.StartElementHandler = begins
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


def _lines(content: bytes) -> list[tuple[int, list[str]]]:
    """Give the words of the lines that say something, with the lines' numbers, without comments."""
    lines = ((number, line.partition("#")[0].split()) for number, line in enumerate(_text(content).splitlines(), 1))
    return [(number, words) for number, words in lines if words]


def _weight(number: str, attributes: str, line: int) -> object:
    """Give the weight of an edge, of a plain number or of attributes, which hold values alone."""
    try:
        if not attributes:
            return float(number) if number else None
        found = ast.literal_eval(attributes) if len(attributes) <= MOST_ATTRIBUTES and not number else None
        if isinstance(found, dict):
            return found.get("weight")
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        pass
    text = one_line(f"{number} {attributes}".strip(), 60)
    raise _BrokenError(f"'{text}', where a weight or nothing stands", line)
