"""The budget of timed growth: a part of the ``growth:`` section of an island of timed systems."""

from __future__ import annotations

from typing import Annotated, Final

from pydantic import Field

from genome.settings import Settings

MOST_MODULES: Final = 10_000_000
MOST_EVENTS: Final = 100_000_000


class TimedGrowth(Settings):
    """How much a timed system may grow.

    Attributes
    ----------
    max_modules
        The most modules that a word may have at the time asked for, brackets counted.
    max_events
        The most births, and askings of productions, from time 0 on. It bounds systems that explode and vanish again,
        and those in which something is reborn without time passing.
    max_seconds
        The clock behind the budget, a safety net.
    """

    max_modules: Annotated[int, Field(ge=1, le=MOST_MODULES)] = 1_000_000
    max_events: Annotated[int, Field(ge=1, le=MOST_EVENTS)] = 5_000_000
    max_seconds: Annotated[float, Field(gt=0)] = 30.0
