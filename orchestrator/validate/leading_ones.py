"""The parallel (1+1) EA on LeadingOnes: the denser the topology, the sooner the optimum (Lässig and Sudholt 2014)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, final

from islands.settings import Algorithm
from orchestrator.validate.case import Case, Outcomes, Verdict
from orchestrator.validate.means import compared
from orchestrator.validate.model import Model, Setting, first_reaching

BITS, ISLANDS, RUNS = 64, 16, 60
PATIENCE: Final = 3
"""A run is given up after so many times the published mean."""

EPOCH: Final = 64
"""Generations between the exchanges of islands that exchange nothing."""

PUBLISHED: Final[Mapping[str, float]] = {
    "unconnected": 2327,
    "ring": 345,
    "bidirectional_ring": 285,
    "torus": 255,
    "hypercube": 246,
    "complete": 235,
    "one island": 3644,
}
"""Mean generations until the optimum is found on any island, migration every generation; 60 runs each."""


@final
class LeadingOnes:
    """See the module's docstring."""

    name: Final = "leading_ones"
    all_end: Final = True

    def __init__(self, runs: int = RUNS) -> None:
        self.cases: Final = tuple(Case(name, runs) for name in PUBLISHED)
        self.comparisons: Final = len(self.cases)

    def run(self, case: str, seed: int, *, migration: bool) -> float | None:
        """Give the generation in which the optimum is found."""
        connected = migration and case not in ("unconnected", "one island")
        setting = Setting(
            islands=1 if case == "one island" else ISLANDS,
            population=1,
            topology=case if connected else "",
            algorithm=Algorithm(name="plus", crossover=0.0, mutation=1.0),
            fitness={"leading_ones": {"goal": "maximise"}},
            genome={"length": BITS},
            epoch=1 if connected else EPOCH,
        )
        found = first_reaching(Model(setting, seed), BITS, int(PATIENCE * PUBLISHED[case]))
        return None if found is None else float(found)

    def judge(self, outcomes: Mapping[str, Outcomes], comparisons: int) -> list[Verdict]:
        """Compare each mean."""
        return [compared(self.name, name, value, 0, outcomes[name], comparisons) for name, value in PUBLISHED.items()]
