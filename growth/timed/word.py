"""The phenotype of a timed system at one time: a word of modules, their parameters developed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from genome.timed import Module
from growth.timed.figures import NO_FIGURES, Figures
from growth.timed.tables import Floats, Ints


@final
@dataclass(frozen=True, slots=True, eq=False)
class Word:
    """A word at one time, for the turtle; m modules with v parameters in all (McCormack, section 3.2).

    Attributes
    ----------
    time
        The time.
    names
        The symbol of each code.
    commands
        The symbol that the turtle takes each code for, after ``equiv``.
    codes
        (m,) int64.
    starts
        (m + 1,) int64, where the parameters of each module begin in ``values``.
    values
        (v,) float64, the parameters, scaled by the development functions; finite.
    ages
        (m,) float64, not negative.
    factors
        (m,) float64, what the parameters were scaled by; 1 where a symbol has no development function.
    radians
        Whether turns are in radians, and not in degrees.
    lineages
        (m,) int64, who a module is: equal at all times at which it lives, of no other module (but by a chance of
        2**-64).
    figures
        Cross-sections and surfaces that the system's file has.
    """

    time: float
    names: tuple[str, ...]
    commands: tuple[str, ...]
    codes: Ints
    starts: Ints
    values: Floats
    ages: Floats
    factors: Floats
    radians: bool
    lineages: Ints
    figures: Figures = NO_FIGURES

    def __len__(self) -> int:
        return len(self.codes)

    def modules(self) -> list[Module]:
        """Give the modules one by one: symbol, developed parameters, age."""
        values, starts = self.values.tolist(), self.starts.tolist()
        return [
            Module(self.names[code], tuple(values[starts[at] : starts[at + 1]]), age)
            for at, (code, age) in enumerate(zip(self.codes.tolist(), self.ages.tolist(), strict=True))
        ]
