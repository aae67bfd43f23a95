"""How timed forms are grown, drawn and looked at: the ``growth:`` section of an island of timed systems."""

from __future__ import annotations

from typing import Annotated, Final

from pydantic import Field, model_validator

from genome.errors import InputError
from growth.timed.settings import TimedGrowth
from growth.timed.turtle.settings import TurtleSettings

MOST_SAMPLES: Final = 10_000


class TimedForm(TimedGrowth):
    """The budget of timed growth, and when its form is looked at.

    Attributes
    ----------
    time
        When the form is judged: the last sample, in the system's own unit of time.
    since
        The first sample.
    samples
        How many times there are from ``since`` to ``time``, evenly, both counted. One is ``time`` alone: then nothing
        is seen to move or to grow.
    turtle
        How words are drawn.
    """

    time: Annotated[float, Field(gt=0)] = 1.0
    since: Annotated[float, Field(ge=0)] = 0.0
    samples: Annotated[int, Field(ge=1, le=MOST_SAMPLES)] = 12
    turtle: TurtleSettings = TurtleSettings()

    @model_validator(mode="after")
    def _check_span(self) -> TimedForm:
        if self.since >= self.time:
            raise InputError("since", f"a time before time ({self.time:g})", f"{self.since:g}")
        return self
