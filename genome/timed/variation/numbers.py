"""Variation of numbers: those of defines, and those that stand in axiom and productions."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final, final

import numpy as np

from genome.timed.expression import Number, Unary
from genome.timed.system import Define, TimedSystem
from genome.timed.variation.bounds import Bounds, bounds_of, free
from genome.timed.variation.constants import constant, define_values
from genome.timed.variation.places import Role, literals, with_literals

Move = Callable[[float, Bounds], float]
"""Gives another number for one, within its bounds."""


@final
class Numbers:
    """What numbers of a system vary, and how.

    Parameters
    ----------
    system
        The file's.
    defines
        The bounds of those that vary.
    factor
        By which literals vary, see :func:`genome.timed.variation.bounds.bounds_of`.
    varies
        Whether the productions of a symbol vary.
    """

    def __init__(
        self, system: TimedSystem, defines: Mapping[str, Bounds], factor: float, varies: Callable[[str], bool]
    ) -> None:
        self._defines: Final = defines
        self._factor: Final = factor
        self._varies: Final = varies
        self._literals: Final = bounds_of(system, factor, varies)

    def count(self, system: TimedSystem) -> int:
        """Give how many there are: defines in the order written, then literals as they stand."""
        defined = sum(define.name in self._defines for define in system.defines)
        return defined + sum(self._bounds(*one) is not None for one in literals(system, self._varies))

    def drawn(self, system: TimedSystem, rng: np.random.Generator) -> TimedSystem:
        """Draw all of them evenly between their bounds."""
        return self._moved(system, lambda _, bounds: _even(bounds, rng), [True] * self.count(system))

    def mutated(self, system: TimedSystem, rng: np.random.Generator, rate: float, step: float) -> TimedSystem:
        """Change each with a chance, by a Gaussian step that is a share of the distance between its bounds."""
        chosen = rng.random(self.count(system)) < rate
        return self._moved(system, lambda value, bounds: _stepped(value, bounds, step, rng), chosen.tolist())

    def one_mutated(self, system: TimedSystem, rng: np.random.Generator, step: float) -> TimedSystem:
        """Change one of them, each as likely; the system itself where there is none."""
        count = self.count(system)
        if not count:
            return system
        at = int(rng.integers(count))
        chosen = [place == at for place in range(count)]
        return self._moved(system, lambda value, bounds: _stepped(value, bounds, step, rng), chosen)

    def _moved(self, system: TimedSystem, move: Move, chosen: list[bool]) -> TimedSystem:
        turns = iter(chosen)
        values = define_values(system)

        def defined(define: Define) -> Define:
            bounds = self._defines.get(define.name)
            if bounds is None or not next(turns):
                return define
            # What is no plain number yet begins in the middle.
            value = constant(define.value, values)
            return replace(
                define, value=_number(move((bounds.low + bounds.high) / 2 if value is None else value, bounds))
            )

        def changed(role: Role, value: float) -> float:
            bounds = self._bounds(role, value)
            return value if bounds is None or not next(turns) else move(value, bounds)

        defines = tuple(map(defined, system.defines))
        return with_literals(replace(system, defines=defines), self._varies, changed)

    def _bounds(self, role: Role, value: float) -> Bounds | None:
        return free(role, value, self._literals, self._factor)


def _number(value: float) -> Number | Unary:
    return Unary("-", Number(-value)) if value < 0.0 else Number(value + 0.0)


def _even(bounds: Bounds, rng: np.random.Generator) -> float:
    if bounds.whole:
        return float(rng.integers(math.ceil(bounds.low), math.floor(bounds.high) + 1))
    return bounds.within(float(rng.uniform(bounds.low, bounds.high)))


def _stepped(value: float, bounds: Bounds, step: float, rng: np.random.Generator) -> float:
    """Give a number beside one; a whole one is another one."""
    moved = value + step * (bounds.high - bounds.low) * float(rng.standard_normal())
    found = bounds.within(moved)
    if bounds.whole and found == value:
        return bounds.within(value + (1.0 if moved >= value else -1.0))
    return found
