"""The figures of a deme at the end of a generation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from islands.individual import Individual
from islands.records import Generation


def figures(
    deme: Sequence[Individual[Any]],
    generation: int,
    epoch: int,
    evaluations: int,
    diversity: float | None,
    wall_ms: float,
) -> Generation:
    """Make a generation's row: figures over the valid members, summed exactly so that no order matters."""
    fitness = [member.fitness for member in deme if member.fitness is not None]
    if not fitness:
        return Generation(generation, epoch, evaluations, None, None, None, None, diversity, len(deme), wall_ms)
    mean = math.fsum(fitness) / len(fitness)
    std = math.sqrt(math.fsum((value - mean) ** 2 for value in fitness) / len(fitness))
    best, worst, invalid = max(fitness), min(fitness), len(deme) - len(fitness)
    return Generation(generation, epoch, evaluations, best, mean, std, worst, diversity, invalid, wall_ms)
