"""What kinds of islands share on the way from a form to its evaluation: goals, criteria, failures."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, Generic, NamedTuple, TypeVar, final

from evaluators.fitness import Goal, total
from growth.protocol import Clock, Failure
from islands.individual import Evaluation

S = TypeVar("S")


class Criteria(NamedTuple, Generic[S]):
    """The criteria of one sort of form.

    Attributes
    ----------
    usual
        Names of those that are measured with a goal or not.
    resolve
        Finds one by its name; takes the place that an error names, too.
    score
        Applies criteria by name to what they see.
    """

    usual: tuple[str, ...]
    resolve: Callable[[str, str], Callable[[S], float]]
    score: Callable[[S, Mapping[str, Callable[[S], float]]], dict[str, float] | Failure]


@final
class Scoring(Generic[S]):
    """How individuals of an island become evaluations.

    Parameters
    ----------
    goals
        By criterion, as an experiment has them.
    criteria
        The kind's.
    own
        Names of criteria that the kind itself measures.
    where
        Gives the place of a key of the island, for messages.
    clock
        For the ``*_ms`` columns.

    Attributes
    ----------
    goals
        By criterion.
    """

    def __init__(
        self,
        goals: Mapping[str, Mapping[str, Any]],
        criteria: Criteria[S],
        own: Sequence[str],
        where: Callable[..., str],
        clock: Clock,
    ) -> None:
        self.goals: Final = {name: Goal.model_validate(dict(goal)) for name, goal in goals.items()}
        names = [name for name in dict.fromkeys([*criteria.usual, *self.goals]) if name not in own]
        self._criteria: Final = {name: criteria.resolve(name, where("fitness", name)) for name in names}
        self._score: Final = criteria.score
        self._clock: Final = clock

    def key(self, kind: str, growth: Mapping[str, Any]) -> str:
        """Hash all that a fitness depends on besides the genotype."""
        goals = {name: goal.model_dump(mode="json") for name, goal in sorted(self.goals.items())}
        meaning = [kind, growth, goals, sorted(self._criteria)]
        return hashlib.sha256(json.dumps(meaning, sort_keys=True, allow_nan=False).encode()).hexdigest()

    def failed(self, why: Failure, started: float) -> Evaluation:
        """Give the evaluation of what grew to no form."""
        notes: tuple[tuple[str, dict[str, object]], ...] = ()
        if why.reason == "clock":
            notes = (("clock", {"detail": why.detail}),)
        return Evaluation(None, (), str(why), (self._clock() - started) * 1e3, 0.0, notes)

    def of(self, seen: S | Failure, more: Mapping[str, float], started: float, grown: float) -> Evaluation:
        """Score what the criteria see by all of them; ``more`` are those that the kind has measured itself."""
        growth_ms = (grown - started) * 1e3
        if isinstance(seen, Failure):
            return Evaluation(None, (), str(seen), growth_ms, (self._clock() - grown) * 1e3)
        scores = self._score(seen, self._criteria)
        evaluation_ms = (self._clock() - grown) * 1e3
        if isinstance(scores, Failure):
            return Evaluation(None, (), str(scores), growth_ms, evaluation_ms)
        scores |= more
        return Evaluation(total(scores, self.goals), tuple(sorted(scores.items())), "", growth_ms, evaluation_ms)
