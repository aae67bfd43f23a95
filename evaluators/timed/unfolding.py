"""A timed form as it unfolds: its drawings at times one after the other. What its criteria see."""

from __future__ import annotations

import time as clocks
from dataclasses import dataclass
from typing import final

import numpy as np

from evaluators.timed.settings import TimedForm
from genome.timed import TimedSystem
from growth.protocol import Clock, Failure
from growth.timed import begin
from growth.timed.drawing import Drawing
from growth.timed.tables import Floats
from growth.timed.turtle import draw


@final
@dataclass(frozen=True, slots=True, eq=False)
class Unfolding:
    """A timed form at n times, one or more.

    Attributes
    ----------
    times
        (n,) float64, ascending, in the system's own unit.
    drawings
        The form at each of them.
    """

    times: Floats
    drawings: tuple[Drawing, ...]

    @property
    def form(self) -> Drawing:
        """The drawing at the last time: what criteria of form judge."""
        return self.drawings[-1]


def unfold(
    system: TimedSystem, growth: TimedForm, seed: int = 0, clock: Clock = clocks.thread_time
) -> Unfolding | Failure:
    """Grow a system and draw it at even times from ``since`` to ``time``.

    Parameters
    ----------
    system
        The genotype.
    growth
        Budget, times and turtle. ``max_seconds`` bounds all times together.
    seed
        Decides what the system draws at random.
    clock
        The safety net behind the budget.

    Returns
    -------
    Unfolding or Failure
        A failure has a reason of :func:`growth.timed.derive`, of :func:`growth.timed.turtle.draw`, or ``empty`` where
        nothing is drawn at the last time.
    """
    deadline = clock() + growth.max_seconds
    times = np.linspace(growth.since, growth.time, growth.samples) if growth.samples > 1 else np.array([growth.time])
    derivation = begin(system, seed, growth)
    drawings = []
    for time in times.tolist():
        if isinstance(derivation, Failure):
            return derivation
        derivation = derivation.at(time, clock)
        word = derivation if isinstance(derivation, Failure) else derivation.word()
        drawing = word if isinstance(word, Failure) else draw(word, growth.turtle)
        if isinstance(drawing, Failure):
            return drawing
        if clock() > deadline:
            return Failure("clock", "the growth and its drawings took longer than max_seconds")
        drawings.append(drawing)
    if not len(drawings[-1]):
        return Failure("empty", f"the word draws nothing at time {growth.time:.9g}")
    return Unfolding(times, tuple(drawings))
