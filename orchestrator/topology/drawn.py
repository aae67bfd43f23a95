"""Graphs that are drawn at random once for a run: what the families of them share."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, Final

from pydantic import Field

from genome.errors import InputError
from islands.streams import ARCHIPELAGO, Purpose, stream
from orchestrator.topology.protocol import Ground, Link, as_links, both_ways

if TYPE_CHECKING:
    import networkx as nx

TRIES: Final = 200
"""Graphs that are drawn in search of one in which every island is reached."""

Seed = Annotated[int, Field(ge=0, lt=2**63)]


def drawn(ground: Ground, seed: int | None, draw: Callable[[int], nx.Graph[Any]], remedy: str) -> list[Link]:
    """Draw a graph; where every island is to be reached, again until it is connected.

    Parameters
    ----------
    ground
        The islands.
    seed
        The topology's own; without, the graph follows from the run's seed and the channel.
    draw
        Makes an undirected graph of the places from a seed.
    remedy
        What to do when no graph is connected.

    Returns
    -------
    The edges, both ways.

    Raises
    ------
    InputError
        When none of ``TRIES`` graphs is connected.
    """
    import networkx as nx

    keys = (ground.channel,) if seed is None else ()
    rng = stream(ground.seed if seed is None else seed, ARCHIPELAGO, Purpose.TOPOLOGY, 0, *keys)
    for _ in range(TRIES):
        graph = draw(int(rng.integers(2**31)))
        if not ground.reach or nx.is_connected(graph):
            return as_links(both_ways(graph.edges()))
    got = f"none such among {TRIES} drawn"
    raise InputError("", f"a graph in which every one of {ground.count} islands is reached", got, remedy)
