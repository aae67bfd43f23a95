"""The topologies by name. A new one is one file here and one line of ``TOPOLOGIES``."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from operator import index
from pathlib import Path
from typing import Any, Final, cast

from evaluators.plugins import find_function, guarded
from genome.errors import InputError
from genome.settings import Settings, describe, validated
from islands.kinds.protocol import Keep
from orchestrator.topology.protocol import FromFile, Ground, Link, Parameters, Topology, located

TOPOLOGIES: Final = {
    "unconnected": "orchestrator.topology.unconnected:unconnected",
    "ring": "orchestrator.topology.ring:ring",
    "bidirectional_ring": "orchestrator.topology.bidirectional_ring:bidirectional_ring",
    "line": "orchestrator.topology.line:line",
    "star": "orchestrator.topology.star:star",
    "wheel": "orchestrator.topology.wheel:wheel",
    "torus": "orchestrator.topology.torus:Torus",
    "grid": "orchestrator.topology.grid:Grid",
    "hypercube": "orchestrator.topology.hypercube:hypercube",
    "complete": "orchestrator.topology.complete:complete",
    "tree": "orchestrator.topology.tree:Tree",
    "barabasi_albert": "orchestrator.topology.barabasi_albert:BarabasiAlbert",
    "watts_strogatz": "orchestrator.topology.watts_strogatz:WattsStrogatz",
    "erdos_renyi": "orchestrator.topology.erdos_renyi:ErdosRenyi",
    "random": "orchestrator.topology.random:Random",
    "edges": "orchestrator.topology.edges:Edges",
    "graph": "orchestrator.topology.graph:Graph",
}
"""Built topologies and where they stand; imported when first used."""

OPEN: Final = ("edges", "graph", "barabasi_albert", "watts_strogatz", "erdos_renyi")
"""Built topologies that may leave an island without an incoming edge, as a plug-in may."""

GROUP: Final = "atoll.topologies"


Simple = Callable[[int], Any]
"""A topology without parameters, or with those that it has been given."""


def resolve_topology(name: str, where: str) -> Callable[..., Any]:
    """Give the topology of this name, import path or entry point: a settings model, or a function.

    Raises
    ------
    InputError
        When there is none, or what is there cannot be called.
    """
    return find_function(name, where, "topology", TOPOLOGIES, GROUP)


def with_parameters(name: str, parameters: Parameters, where: str) -> Settings | Simple:
    """Give a topology with its parameters: a settings model of them, or a function of the number of islands.

    Raises
    ------
    InputError
        When there is no such topology, or it has no such parameters.
    """
    found = resolve_topology(name, where)
    if isinstance(found, type) and issubclass(found, Settings):
        source, separator, key = where.rpartition(": ")
        return validated(found, parameters, source if separator else where, tuple(key.split(".")) if separator else ())
    with guarded(where, "a topology", describe(name)):
        try:
            inspect.signature(found).bind(2, **parameters)
        except TypeError as error:
            got = str(error).removeprefix("got ")
            raise InputError(where, f"parameters that {describe(name)} takes", got) from None
        except ValueError:  # a function of C without a signature
            pass
    simple: Simple = partial(found, **parameters)
    return simple


def links_of(name: str, parameters: Parameters, ground: Ground, where: str) -> list[Link]:
    """Give the edges of a topology, ascending.

    Parameters
    ----------
    name
        By which the experiment calls it.
    parameters
        As the experiment has them.
    ground
        The islands.
    where
        The place in the experiment, for messages.

    Raises
    ------
    InputError
        When there is no such topology, it does not fit the islands, or a plug-in's gives edges that cannot be.
    """
    topology: object = with_parameters(name, parameters, where)
    try:
        with guarded("", f"a topology of {ground.count} islands", describe(name)):
            lay = topology.links if isinstance(topology, Topology) else partial(_simply, cast("Simple", topology))
            return sorted(lay(ground)) if name in TOPOLOGIES else _checked(name, lay(ground), ground, where)
    except InputError as error:
        raise error if error.where.startswith(where) else located(error, where) from None


def edges_of(name: str, count: int, where: str, **parameters: Any) -> list[tuple[int, int]]:  # noqa: ANN401
    """Give the edges of a topology among so many islands that are known by their places alone; see ``links_of``."""
    ground = Ground(tuple(str(place) for place in range(count)))
    return [(link.source, link.target) for link in links_of(name, parameters, ground, where)]


def kept(name: str, parameters: Parameters, base: Path, keep: Keep, where: str) -> Mapping[str, object]:
    """Keep with the run the file that a topology reads; give its parameters with the copy's name."""
    topology: object = with_parameters(name, parameters, where)
    return topology.kept(base, keep) if isinstance(topology, FromFile) else parameters


def _simply(topology: Simple, ground: Ground) -> list[Link]:
    return [Link(*edge) for edge in topology(ground.count)]


def _checked(name: str, given: Sequence[Link], ground: Ground, where: str) -> list[Link]:
    """Check what a plug-in gives: pairs of places, with a weight as a third if need be; each once."""
    links: dict[tuple[int, int], Link] = {}
    for edge in given:
        try:
            source, target, weight = index(edge.source), index(edge.target), edge.weight
            link = Link(source, target, weight if weight is None else float(weight))
        except (TypeError, ValueError):
            got = f"{describe(name)} with {describe(tuple(edge))}"
            raise InputError(where, "edges: two places, and a weight if need be", got) from None
        inside = 0 <= source < ground.count and 0 <= target < ground.count
        if source == target or not inside or not 0 <= (1.0 if link.weight is None else link.weight) <= 1:
            got = f"{describe(name)} with {source} -> {target}"
            got += "" if link.weight is None else f" of weight {link.weight}"
            raise InputError(where, f"edges between two of {ground.count} islands", got)
        if (source, target) in links:
            raise InputError(where, "each edge once", f"{describe(name)} with {source} -> {target} again")
        links[source, target] = link
    return [links[ends] for ends in sorted(links)]
