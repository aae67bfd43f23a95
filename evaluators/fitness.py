"""How scores become one fitness: goals and weights. Fitness is maximised, here and everywhere in Atoll."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal, Self

from pydantic import Field, model_validator

from genome.errors import InputError
from genome.settings import Settings

_LARGEST = 1e300
"""A term is kept below this, so that no sum of terms is infinite or NaN."""


class Goal(Settings):
    """What is wanted of one criterion.

    ``target`` wants a ``value``; ``maximise`` and ``minimise`` divide by a ``scale``.
    """

    goal: Literal["target", "maximise", "minimise"]
    value: float | None = None
    weight: float = Field(default=1.0, ge=0)
    scale: float = Field(default=1.0, gt=0)

    @model_validator(mode="after")
    def _used(self) -> Self:
        if self.goal == "target":
            if self.value is None:
                raise InputError("", "a value for the goal 'target'", "none", "add value: ...")
            if self.scale != 1:
                raise InputError("", "no scale with the goal 'target'", f"{self.scale}", "use the weight")
        elif self.value is not None:
            expected, remedy = f"no value with the goal '{self.goal}'", "did you mean goal: target?"
            raise InputError("", expected, f"{self.value}", remedy)
        return self


def term(score: float, goal: Goal) -> float:
    """Give what one criterion adds to the fitness (semantics, section 1).

    Parameters
    ----------
    score
        F, finite.
    goal
        With weight w: ``target`` T gives -w |F - T| / (|T| + 1), ``maximise`` w F / scale, ``minimise`` -w F / scale.

    Returns
    -------
    float
        Finite: cut off at 1e300 either way.
    """
    if goal.goal == "target":
        target = goal.value if goal.value is not None else 0.0
        worth = -goal.weight * (abs(score - target) / (abs(target) + 1))
    else:
        worth = (goal.weight if goal.goal == "maximise" else -goal.weight) * (score / goal.scale)
    if math.isnan(worth):  # a weight of 0 times a quotient beyond the largest float
        return 0.0
    return min(max(worth, -_LARGEST), _LARGEST)


def total(scores: Mapping[str, float], goals: Mapping[str, Goal]) -> float:
    """Add the terms of all goals (Hemberg 2006, section 5.3, with goals).

    Parameters
    ----------
    scores
        Finite scores by criterion; those without a goal do not count.
    goals
        A goal for each criterion that counts; each must have a score.

    Returns
    -------
    float
        The fitness, finite; 0 without goals. The sum is exactly rounded: the order of the goals does not matter.
    """
    return math.fsum(term(scores[name], goal) for name, goal in goals.items())
