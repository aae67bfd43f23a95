"""What steering has changed on an island for good: goals, rates, strengths, and members that it favours or keeps."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

from evaluators.fitness import Goal
from genome.errors import InputError
from genome.settings import describe
from islands.settings import Algorithm
from islands.spec import IslandSpec
from islands.strengths import loaded

Json = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Steered:
    """See the module's docstring; plain and equal by value, so that it travels with an island's state.

    Attributes
    ----------
    goals
        The goals that were changed, whole, by criterion in alphabetical order.
    rates
        Settings of the algorithm that were changed, in alphabetical order.
    promoted
        Ids of members that rank before all others, in this order.
    locked
        Ids of members that nothing replaces or moves away, ascending.
    strengths
        The strengths of joints that were changed, in alphabetical order.
    """

    goals: tuple[tuple[str, Goal], ...] = ()
    rates: tuple[tuple[str, float], ...] = ()
    promoted: tuple[int, ...] = ()
    locked: tuple[int, ...] = ()
    strengths: tuple[tuple[str, float], ...] = ()

    @property
    def measure(self) -> tuple[object, ...]:
        """All of it that changes how members score; equal where they score alike."""
        return self.goals, self.strengths

    def with_goals(self, changed: Mapping[str, Goal]) -> Steered:
        """Give the same with some goals in place of those of before."""
        return replace(self, goals=tuple(sorted({**dict(self.goals), **changed}.items(), key=_name)))

    def with_rates(self, changed: Mapping[str, float]) -> Steered:
        """Give the same with some rates in place of those of before."""
        return replace(self, rates=tuple(sorted({**dict(self.rates), **changed}.items(), key=_name)))

    def with_strengths(self, changed: Mapping[str, float]) -> Steered:
        """Give the same with some strengths in place of those of before."""
        return replace(self, strengths=tuple(sorted({**dict(self.strengths), **changed}.items(), key=_name)))

    def without(self, identity: int) -> Steered:
        """Give the same once a member is gone."""
        promoted = tuple(one for one in self.promoted if one != identity)
        return replace(self, promoted=promoted, locked=tuple(one for one in self.locked if one != identity))

    def among(self, members: Iterable[int]) -> Steered:
        """Give the same without those who are no members any more: one who comes back is as any other."""
        if not self.promoted and not self.locked:
            return self
        here = frozenset(members)
        promoted = tuple(one for one in self.promoted if one in here)
        return replace(self, promoted=promoted, locked=tuple(one for one in self.locked if one in here))

    def spec(self, spec: IslandSpec) -> IslandSpec:
        """Give an island's settings as they are changed."""
        if self.strengths:
            spec = replace(spec, growth=loaded(spec.growth, dict(self.strengths)))
        if not self.goals and not self.rates:
            return spec
        goals = {name: goal.model_dump(mode="json") for name, goal in self.goals}
        algorithm = Algorithm.model_validate({**spec.algorithm.model_dump(), **dict(self.rates)})
        return replace(spec, fitness={**spec.fitness, **goals}, algorithm=algorithm)

    def to_json(self) -> dict[str, Any]:
        """Give plain JSON values; nothing is left out but what is empty."""
        told: dict[str, Any] = {
            "goals": {name: goal.model_dump(mode="json", exclude_none=True) for name, goal in self.goals},
            "rates": dict(self.rates),
            "promoted": list(self.promoted),
            "locked": list(self.locked),
            "strengths": dict(self.strengths),
        }
        return {key: value for key, value in told.items() if value}

    @staticmethod
    def from_json(told: Json) -> Steered:
        """Read what :meth:`to_json` gave.

        Raises
        ------
        InputError
            For anything else.
        """
        try:
            read = Steered(
                tuple((name, Goal.model_validate(goal)) for name, goal in told.get("goals", {}).items()),
                tuple(told.get("rates", {}).items()),
                tuple(told.get("promoted", ())),
                tuple(told.get("locked", ())),
                tuple(told.get("strengths", {}).items()),
            )
        except (AttributeError, TypeError, ValueError):
            read = None
        # Whatever does not write itself as it was read is something else.
        if read is None or read.to_json() != told:
            raise InputError("steered", "what an island was steered to, as it writes it", describe(told)) from None
        return read


UNSTEERED: Final = Steered()


def _name(pair: tuple[str, object]) -> str:
    return pair[0]
