"""Takeover times: how long one best individual takes to fill all demes when nothing varies, topology by topology.

Each generation of a deme of 20 is filled by binary tournaments, the best is put back where it was lost, and every so
many generations each edge brings a copy of its source's best in place of one that is worse. The best starts on island 0
(after Giacobini, Tomassini, Tettamanzi and Alba 2005; Luque and Alba 2010).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, final

from islands.individual import Individual
from islands.island import Advance
from islands.settings import Algorithm
from orchestrator.validate.case import Case, Outcomes, Verdict
from orchestrator.validate.means import compared
from orchestrator.validate.model import Model, Setting

ISLANDS, DEME, RUNS = 8, 20, 200
PATIENCE: Final = 3
"""A run is given up after so many times the published mean."""

PUBLISHED: Final[Mapping[tuple[str, int], float]] = {
    ("complete", 1): 3.9,
    ("hypercube", 1): 6.2,
    ("torus", 1): 6.2,
    ("star", 1): 7.2,
    ("bidirectional_ring", 1): 8.0,
    ("line", 1): 12.0,
    ("ring", 1): 12.2,
    ("complete", 5): 12.5,
    ("hypercube", 5): 19.7,
    ("torus", 5): 19.8,
    ("star", 5): 14.1,
    ("bidirectional_ring", 5): 25.7,
    ("line", 5): 41.7,
    ("ring", 5): 41.6,
}
"""Mean generations by topology and interval; 200 runs each."""

PANMICTIC: Final = 10.85
"""The same for one deme of 160."""


@final
class Takeover:
    """See the module's docstring."""

    name: Final = "takeover"
    all_end: Final = True

    def __init__(self, runs: int = RUNS) -> None:
        self._published = {f"{name}, every {every}": value for (name, every), value in PUBLISHED.items()}
        self._published["one deme"] = PANMICTIC
        self.cases: Final = tuple(Case(name, runs) for name in self._published)
        self.comparisons: Final = len(self.cases)

    def run(self, case: str, seed: int, *, migration: bool) -> float | None:
        """Give the generation after which, its migrants let in, every member is a copy of the best."""
        topology, _, every = case.partition(", every ")
        if not every:
            return _taken_over(Model(_setting(1, ISLANDS * DEME, "", 1), seed), self._published[case])
        setting = _setting(ISLANDS, DEME, topology if migration else "", int(every))
        return _taken_over(Model(setting, seed), self._published[case])

    def judge(self, outcomes: Mapping[str, Outcomes], comparisons: int) -> list[Verdict]:
        """Compare each mean."""
        return [
            compared(self.name, name, value, 2 if name == "one deme" else 1, outcomes[name], comparisons)
            for name, value in self._published.items()
        ]


def _setting(islands: int, deme: int, topology: str, every: int) -> Setting:
    # A string of one bit that never flips is a label: 1 is the best.
    return Setting(
        islands=islands,
        population=deme,
        topology=topology,
        algorithm=Algorithm(elite=1, elitism="restore", tournament=2, crossover=0.0, mutation=0.0),
        fitness={"ones": {"goal": "maximise"}},
        genome={"length": 1, "flip": 0.0},
        channel={"every": every},
    )


def _taken_over(model: Model, published: float) -> float | None:
    model.begin()
    for island, state in enumerate(model.states):
        model.states[island] = state.with_deme(
            tuple(_labelled(member, best=island == place == 0) for place, member in enumerate(state.deme))
        )
    members = sum(len(state.deme) for state in model.states)
    there = 1
    for generation in range(int(PATIENCE * published)):
        steps = model.advance()
        # What stands at the gate after a generation joins at the start of the next step, which tells who was let in:
        # each took the place of a member that was worse.
        if there + _joined(steps) == members:
            return float(generation)
        there = sum(member.fitness == 1.0 for state in model.states for member in state.deme)
    return None


def _labelled(member: Individual[int], *, best: bool) -> Individual[int]:
    value = float(best)
    return Individual(member.id, int(best), value, (("ones", value),), "")


def _joined(steps: list[Advance[int]]) -> int:
    return sum(row.accepted for step in steps for row in step.records.crossings)
