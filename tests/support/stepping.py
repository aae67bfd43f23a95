"""An experiment's islands, stepped epoch by epoch without hosts: what each takes in is what was sent before."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from archipelagos import without_clock

from islands.checkpoint import Kept, Restored
from islands.island import Island
from islands.kinds.registry import resolve_kind
from islands.migration.adapters import adapters_into
from islands.migration.channel import Packet
from islands.migration.routes import Routes
from islands.records import Records
from islands.tally import Tally
from orchestrator.loading import Loaded
from orchestrator.plan import Plan, make_plan


def islands_of(loaded: Loaded) -> tuple[Plan, list[Island[Any]]]:
    plan, seed = make_plan(loaded), loaded.experiment.seed
    ticks = itertools.count()
    routes = Routes(plan.edges, plan.redrawn, seed)
    made = []
    for spec in plan.islands:
        strangers = [
            (edge.adapter, plan.islands[edge.source])
            for edge in plan.edges
            if edge.adapter and edge.target == spec.number
        ]
        biology = resolve_kind(spec.kind, "test").build(spec, lambda: next(ticks) / 1000)
        adapters = adapters_into(spec, strangers, "test")
        made.append(Island(spec, biology, seed, routes, lambda: next(ticks) / 1000, lambda: None, adapters))
    return plan, made


@dataclass
class Stepping:
    """Where the islands are: their states, what is on its way, and the records of the epochs stepped here."""

    plan: Plan
    islands: Sequence[Island[Any]]
    generations: int
    states: dict[int, Any] = field(default_factory=dict)
    pending: list[Packet] = field(default_factory=list)
    records: list[tuple[int, int, Records]] = field(default_factory=list)
    tally: Tally = field(init=False)

    def __post_init__(self) -> None:
        self.tally = Tally(self.plan.islands)

    @classmethod
    def of(cls, loaded: Loaded) -> Stepping:
        plan, islands = islands_of(loaded)
        return cls(plan, islands, loaded.experiment.epoch)

    @property
    def epoch(self) -> int:
        return next(iter(self.states.values())).epoch if self.states else -1

    def on(self, epochs: int) -> Stepping:
        for _ in range(epochs):
            epoch, sent = self.epoch + 1, []
            for island in self.islands:
                number = island.spec.number
                arrivals = [packet for packet in self.pending if packet.target == number]
                step = island.advance(self.states[number], self.generations, arrivals) if epoch else island.begin()
                self.tally.add(number, step)
                self.records.append((epoch, number, without_clock(step.records)))
                sent.append((number, step))
            self.states = {number: step.state for number, step in sent}
            self.pending = [packet for _, step in sent for packet in step.departures]
        return self

    def kept(self, numbers: Sequence[int]) -> list[Kept]:
        champions = self.tally.champions(self.epoch)
        return [
            Kept(self.islands[one], self.states[one], [p for p in self.pending if p.target == one], champions[one])
            for one in numbers
        ]

    def restore(self, found: Mapping[int, Restored]) -> Stepping:
        self.states = {number: one.state for number, one in found.items()}
        self.pending = [packet for one in found.values() for packet in one.pending]
        self.tally.restore({number: one.champion for number, one in found.items()})
        return self
