"""What every growth engine shares: the budget that bounds a growth, and failure as a value.

A growth engine is a function of (rules, environment, budget) to a phenotype. A budget of counted things decides
validity, so that the verdict is the same on every machine; the clock behind it is a safety net only.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

Clock = Callable[[], float]
"""Gives a time in seconds that only moves forward; passed in, never looked up."""


@dataclass(frozen=True, slots=True)
class Budget:
    """How much a growth may make.

    Attributes
    ----------
    elements
        The most edges that a form may have at any moment of its growth.
    pairs
        The most pairs of branches that one joining may compare.
    seconds
        The wall time after which a growth is broken off, checked between steps; a safety net.
    """

    elements: int = 50_000
    pairs: int = 2_000_000
    seconds: float = 30.0


@dataclass(frozen=True, slots=True)
class Failure:
    """An expected failure: recorded with the individual, never raised.

    Attributes
    ----------
    reason
        One of the words that logs are searched by: ``mapping``, ``rules``, ``budget``, ``clock``, ``diverged``,
        ``boundary``, ``evaluation``, ``load``, ``unstable``, ``empty``, ``small``, ``expression``,
        ``refining``.
    detail
        A sentence that says what happened.
    """

    reason: str
    detail: str

    def __str__(self) -> str:
        return f"{self.reason}: {self.detail}"
