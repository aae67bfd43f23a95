"""An archipelago of bit strings in this process: the engine's islands and edges, and nothing around them."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, final

from islands.island import Advance, Island, State
from islands.kinds.bits import BitsKind
from islands.migration.channel import Channel, Edge, Packet
from islands.migration.routes import Routes
from islands.settings import Algorithm
from islands.spec import IslandSpec
from orchestrator.topology.registry import edges_of


@dataclass(frozen=True, slots=True)
class Setting:
    """One archipelago of like islands.

    Attributes
    ----------
    islands, population
        How many islands, and members of each.
    topology
        By name; empty for one without channels.
    algorithm, genome, growth, fitness
        As in an experiment of the kind ``bits``.
    channel
        Settings of the channel that differ from the usual ones.
    epoch
        Generations between two exchanges.
    """

    islands: int
    population: int
    topology: str
    algorithm: Algorithm
    fitness: Mapping[str, Any]
    genome: Mapping[str, Any]
    growth: Mapping[str, Any] = field(default_factory=dict)
    channel: Mapping[str, Any] = field(default_factory=dict)
    epoch: int = 1


@final
class Model:
    """The islands of one run and where they stand.

    Parameters
    ----------
    setting
        What to model.
    seed
        Of all its streams.
    """

    def __init__(self, setting: Setting, seed: int) -> None:
        specs = [_spec(setting, number) for number in range(setting.islands)]
        routes = Routes(_edges(setting, specs), (), seed)
        biology = BitsKind().build(specs[0], time.perf_counter)
        self._epoch: Final = setting.epoch
        self.islands: Final = tuple(Island(spec, biology, seed, routes, _no_clock, _no_pulse) for spec in specs)
        self.states: list[State[int]] = []
        self._packets: tuple[Packet, ...] = ()

    def begin(self) -> list[Advance[int]]:
        """Make the first populations."""
        return self._took([island.begin() for island in self.islands])

    def advance(self) -> list[Advance[int]]:
        """Deliver what was sent, and let every island breed one epoch."""
        arrivals: dict[int, list[Packet]] = {}
        for packet in self._packets:
            arrivals.setdefault(packet.target, []).append(packet)
        pairs = zip(self.islands, self.states, strict=True)
        return self._took(
            [island.advance(state, self._epoch, arrivals.get(island.spec.number, ())) for island, state in pairs]
        )

    def _took(self, steps: list[Advance[int]]) -> list[Advance[int]]:
        self.states = [step.state for step in steps]
        self._packets = tuple(packet for step in steps for packet in step.departures if packet.migrants)
        return steps


def bests(model: Model, most: int) -> Iterator[tuple[int, float]]:
    """Run a model and give, generation by generation, the best fitness on any island; at most so many generations."""
    steps = model.begin()
    while True:
        for rows in zip(*(step.records.generations for step in steps), strict=True):
            if rows[0].generation > most:
                return
            yield rows[0].generation, max(row.best for row in rows if row.best is not None)
        steps = model.advance()


def first_reaching(model: Model, fitness: float, most: int) -> int | None:
    """Give the generation in which any island first reaches a fitness; ``None`` after so many generations."""
    return next((generation for generation, best in bests(model, most) if best >= fitness), None)


def _spec(setting: Setting, number: int) -> IslandSpec:
    return IslandSpec(
        name=f"island-{number}",
        group="island",
        number=number,
        species="bits",
        kind="bits",
        population=setting.population,
        genome=setting.genome,
        growth=setting.growth,
        fitness=setting.fitness,
        algorithm=setting.algorithm,
        source="atoll validate",
        base=".",
    )


def _edges(setting: Setting, specs: list[IslandSpec]) -> list[Edge]:
    if not setting.topology:
        return []
    channel = Channel(0, "migrants", accept="better", **setting.channel)
    return [
        Edge(channel, source, target, specs[source].name, specs[target].name)
        for source, target in edges_of(setting.topology, len(specs), "atoll validate")
    ]


def _no_clock() -> float:
    return 0.0


def _no_pulse() -> None:
    pass
