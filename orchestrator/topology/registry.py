"""The topologies by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, cast

from evaluators.plugins import find_function
from genome.errors import InputError

Topology = Callable[[int], list[tuple[int, int]]]

TOPOLOGIES: Final = {"ring": "orchestrator.topology.ring:ring"}
"""Built topologies and where they stand."""

LATER: Final = (
    "unconnected",
    "bidirectional_ring",
    "line",
    "star",
    "wheel",
    "torus",
    "grid",
    "hypercube",
    "complete",
    "tree",
    "barabasi_albert",
    "watts_strogatz",
    "erdos_renyi",
    "random",
    "edges",
)
"""Topologies that the experiment format knows and that are not built yet."""

GROUP: Final = "atoll.topologies"


def edges_of(name: str, count: int, where: str) -> list[tuple[int, int]]:
    """Give the edges of a topology by name, import path or entry point.

    Raises
    ------
    InputError
        When there is no such topology, or a plug-in's gives edges that cannot be.
    """
    topology = cast("Topology", find_function(name, where, "topology", TOPOLOGIES, GROUP, LATER))
    edges = sorted({(int(source), int(target)) for source, target in topology(count)})
    for source, target in edges:
        if source == target or not (0 <= source < count and 0 <= target < count):
            raise InputError(where, f"edges between two of {count} islands", f"'{name}' with {source} -> {target}")
    return edges
