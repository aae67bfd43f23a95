"""Criteria of timed forms: of the form at a time, of how it develops up to then, and of how it moves (McCormack).

A criterion sees an :class:`~evaluators.timed.unfolding.Unfolding`: drawings at even times. Criteria of form judge
the last of them.
"""

from evaluators.timed.registry import TIMED_CRITERIA, TimedCriterion, resolve, resolve_all
from evaluators.timed.score import score
from evaluators.timed.settings import TimedForm
from evaluators.timed.unfolding import Unfolding, unfold

__all__ = [
    "TIMED_CRITERIA",
    "TimedCriterion",
    "TimedForm",
    "Unfolding",
    "resolve",
    "resolve_all",
    "score",
    "unfold",
]
