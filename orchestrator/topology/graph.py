"""Edges read from a graph file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Final, final

from pydantic import StringConstraints

from genome.errors import InputError
from genome.mishaps import one_line
from genome.settings import Settings, describe
from islands.kinds.protocol import Keep
from orchestrator.topology.files import UNTOLD, Read, read_graph
from orchestrator.topology.protocol import Ground, Link

MOST: Final = 60
"""The longest name of a node that a message tells."""


@final
class Graph(Settings):
    """The graph of a file; an undirected one has its edges both ways.

    Nodes are members by name, or all of them by place, from 0. An edge's attribute ``weight`` takes the place of the
    channel's weight.

    Attributes
    ----------
    file
        Its name, relative to the experiment; the suffix says how it is written.
    directed
        Of files that do not tell it themselves: edge lists and adjacency lists.
    """

    file: Annotated[str, StringConstraints(min_length=1)]
    directed: bool | None = None

    def links(self, ground: Ground) -> list[Link]:
        """Read the edges.

        Raises
        ------
        InputError
            When the file cannot be read, or is about other nodes than the members.
        """
        path = self._path(ground.base)
        if self.directed is not None and path.suffix not in UNTOLD:
            got = f"'{path.suffix}', which tells it itself"
            raise InputError("directed", f"a file of {' or '.join(UNTOLD)}", got, "remove the key")
        read = read_graph(path, directed=bool(self.directed), most=ground.count)
        places = _places(read, ground)
        links: dict[tuple[int, int], Link] = {}
        for source, target, weight in read.edges:
            ends = places[source], places[target]
            for start, end in (ends,) if read.directed else (ends, ends[::-1]):
                _check(source, target, weight, loop=start == end, repeated=(start, end) in links, file=self.file)
                links[start, end] = Link(start, end, _probability(weight))
        return list(links.values())

    def kept(self, base: Path, keep: Keep) -> Mapping[str, object]:
        """Keep the file with the run; give the parameters with the copy's name in place of its own."""
        path = self._path(base)
        copy = self.model_copy(update={"file": keep("graphs", path.name, path.read_bytes())})
        return copy.model_dump(mode="json", exclude_none=True)

    def _path(self, base: Path) -> Path:
        path = base / self.file
        try:
            what = "" if path.is_file() else "a folder" if path.is_dir() else "not there"
        except OSError as error:
            raise InputError("file", "a graph file", f"{describe(self.file)} ({error.strerror})") from None
        if what:
            got = f"{describe(self.file)}, which is {what}"
            raise InputError("file", "a graph file", got, f"it is looked for in {base}")
        return path


def _places(read: Read, ground: Ground) -> dict[str, int]:
    """Give the place of each node: by the members' names where labels or nodes are such names, else by number."""
    names = {name: place for place, name in enumerate(ground.names)}
    called = dict(zip(read.nodes, read.labels, strict=True)) if any(label in names for label in read.labels) else {}
    if not called and not any(node in names for node in read.nodes):
        names = {str(place): place for place in range(ground.count)}
    places: dict[str, int] = {}
    taken: set[int] = set()
    for node in read.nodes:
        name = called.get(node, node)
        if name not in names or names[name] in taken:
            shown = ", ".join(ground.names[:4]) + (", ..." if ground.count > 4 else "")
            expected = f"nodes that are members ({shown}), or their places from 0 to {ground.count - 1}"
            got = f"the node {describe(name)}{' again' if name in names else ''}"
            raise InputError("file", expected, got, "rename it, or change 'among'")
        places[node] = names[name]
        taken.add(names[name])
    return places


def _check(source: str, target: str, weight: object, *, loop: bool, repeated: bool, file: str) -> None:
    edge = f"{one_line(source, MOST)} - {one_line(target, MOST)} in {describe(file)}"
    if loop:
        raise InputError("file", "edges between two islands", edge, "a channel to itself carries nothing")
    if repeated:
        remedy = "remove one of them, or let the graph be directed"
        raise InputError("file", "each edge once", f"{edge} again", remedy)
    if weight is not None and (type(weight) not in (int, float) or not 0 <= weight <= 1):  # type: ignore[operator]
        raise InputError("file", "weights from 0 to 1", f"{describe(weight)} of {edge}", "a weight is a probability")


def _probability(weight: object) -> float | None:
    """Give a weight that was checked."""
    return float(weight) if isinstance(weight, (int, float)) else None
