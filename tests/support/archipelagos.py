"""Small archipelagos of bit strings for tests."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

from bits import BitsKind

from islands.island import Island
from islands.migration.channel import Channel, Edge
from islands.migration.routes import Redrawn, Routes
from islands.records import Records
from islands.settings import Algorithm
from islands.spec import IslandSpec

LENGTH = 24


def spec(number: int = 0, **changes: Any) -> IslandSpec:
    settings: dict[str, Any] = {
        "name": f"isle-{number}",
        "group": "isle",
        "number": number,
        "species": "bits",
        "kind": "bits:BitsKind",
        "population": 12,
        "genome": {"length": LENGTH, "rate": 0.05},
        "growth": {},
        "fitness": {"ones": {"goal": "maximise"}},
        "algorithm": Algorithm(elite=2),
        "source": "test.yaml",
        "base": ".",
    }
    return IslandSpec(**{**settings, **changes})


def ticking() -> Iterator[float]:
    """A clock for tests: each look at it a millisecond later."""
    return (tick / 1000 for tick in itertools.count())


def island(
    number: int = 0,
    edges: tuple[Edge, ...] = (),
    seed: int = 5,
    kind: Any = BitsKind,
    adapters: Any = None,
    redrawn: tuple[Redrawn, ...] = (),
    **changes: Any,
) -> Island[Any]:
    ticks = ticking()
    made = spec(number, **changes)
    biology = kind().build(made, lambda: next(ticks))
    routes = Routes(edges, redrawn, seed)
    return Island(made, biology, seed, routes, lambda: next(ticks), lambda: None, adapters)


def edge(channel: Channel, source: int, target: int, **changes: Any) -> Edge:
    return Edge(channel, source, target, f"isle-{source}", f"isle-{target}", **changes)


def without_clock(records: Records) -> Records:
    """Give records that a clock did not touch."""
    born = tuple(row._replace(growth_ms=0, evaluation_ms=0) for row in records.born)
    rescored = tuple(row._replace(evaluation_ms=0) for row in records.rescored)
    generations = tuple(row._replace(wall_ms=0) for row in records.generations)
    return Records(born, rescored, generations, records.crossings, records.notes)


def ring(count: int, channel: Channel) -> tuple[Edge, ...]:
    return tuple(
        Edge(channel, place, (place + 1) % count, f"isle-{place}", f"isle-{(place + 1) % count}")
        for place in range(count)
    )
