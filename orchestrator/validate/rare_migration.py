"""Rare migration on a deceptive function: islands that meet now and then beat those that never or always do.

On ``lolz`` half of the islands run into a dead end at each block. Islands that never meet are lost one by one; with
migration in every generation all follow whoever leads, into dead ends too; rare migration saves the stuck before the
next block (Lässig and Sudholt 2010, "The benefit of migration in parallel evolutionary algorithms").
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, final

from islands.settings import Algorithm
from orchestrator.validate.case import Case, Outcomes, Verdict
from orchestrator.validate.model import Model, Setting, first_reaching
from orchestrator.validate.statistics import difference, share_interval

BLOCKS, BLOCK, ZEROS = 6, 6, 3
ISLANDS, RUNS, GENERATIONS = 16, 40, 1500
INTERVALS: Final[Mapping[str, int]] = {"rare": 50, "never": 0, "always": 1}
"""Generations between exchanges, on a ring."""


@final
class RareMigration:
    """See the module's docstring."""

    name: Final = "rare_migration"
    all_end: Final = False
    comparisons: Final = 2

    def __init__(self, runs: int = RUNS) -> None:
        self.cases: Final = tuple(Case(name, runs) for name in INTERVALS)

    def run(self, case: str, seed: int, *, migration: bool) -> float | None:
        """Give the generation in which the optimum is found, if it is."""
        interval = INTERVALS[case] if migration else 0
        setting = Setting(
            islands=ISLANDS,
            population=1,
            topology="ring" if interval else "",
            algorithm=Algorithm(name="plus", crossover=0.0, mutation=1.0),
            fitness={"lolz": {"goal": "maximise"}},
            genome={"length": BLOCKS * BLOCK},
            growth={"block": BLOCK, "zeros": ZEROS},
            epoch=interval or INTERVALS["rare"],
        )
        found = first_reaching(Model(setting, seed), BLOCKS * BLOCK, GENERATIONS)
        return None if found is None else float(found)

    def judge(self, outcomes: Mapping[str, Outcomes], comparisons: int) -> list[Verdict]:
        """See whether rare migration finds the optimum more often: by the differences of the shares of runs."""
        found = {
            name: share_interval(sum(value is not None for value in values), len(values), comparisons)
            for name, values in outcomes.items()
        }
        rare, verdicts = found["rare"], []
        for name in INTERVALS:
            if name != "rare":
                gain = difference(rare, found[name])
                detail = f"found in {rare.estimate:.2f} of the runs against {found[name].estimate:.2f}"
                row = (gain.estimate, gain.low, gain.high, len(outcomes["rare"]))
                case = f"rare less {name}"
                verdicts.append(Verdict(self.name, case, "more than 0", *row, ok=gain.low > 0, detail=detail))
        return verdicts
