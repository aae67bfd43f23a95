"""A run in one thread that is steered: what a driver does with a desk, without hosts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from archipelagos import ticking

from islands.biologies import Biologies
from islands.island import Island
from islands.migration.channel import Packet
from islands.migration.routes import Routes
from islands.records import Records
from islands.state import State
from orchestrator.plan import Plan
from orchestrator.steering.command import Command
from orchestrator.steering.journal import interventions_at


class Steered:
    """Steps all islands of a plan in step, each in the epochs in which it is there."""

    def __init__(self, plan: Plan, seed: int, generations: int = 2) -> None:
        self.plan, self.seed, self.generations = plan, seed, generations
        self.states: dict[int, State[Any]] = {}
        self.packets: list[Packet] = []
        self.records: dict[tuple[int, int], Records] = {}
        self.epoch = -1
        self.remake(plan)

    def remake(self, plan: Plan) -> None:
        """Take a changed plan, as hosts do when the structure changes: states stay, islands are made anew."""
        ticks = ticking()
        self.plan = plan
        build = Biologies(lambda: next(ticks))
        self.routes = Routes(plan.edges, plan.redrawn, self.seed)
        self.islands = {
            spec.number: Island(
                spec, build(spec), self.seed, self.routes, lambda: next(ticks), lambda: None, None, build
            )
            for spec in plan.islands
        }

    def step(self, commands: Iterable[Command] = ()) -> None:
        self.epoch += 1
        epoch, told = self.epoch, interventions_at(commands, self.epoch)
        sent: list[Packet] = []
        for number, isle in self.islands.items():
            if not isle.spec.is_there(epoch):
                self.states.pop(number, None)
                continue
            if epoch == isle.spec.since:
                made = isle.begin(epoch)
            else:
                came = [one for one in self.packets if one.target == number]
                awaited = {(edge.channel.number, edge.source) for edge in self.routes.incoming(number, epoch - 1)}
                assert {(one.channel, one.source) for one in came} == awaited, "it waits for what comes, and no more"
                made = isle.advance(self.states[number], self.generations, came, told)
            self.states[number] = made.state
            self.records[number, epoch] = made.records
            sent += made.departures
        self.packets = sent

    def born(self) -> Mapping[tuple[int, int], list[tuple[Any, ...]]]:
        return {
            key: [(row.id, row.genotype, row.fitness) for row in records.born] for key, records in self.records.items()
        }
