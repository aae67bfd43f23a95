"""Scores a form that unfolds by several criteria; whatever goes wrong becomes a failure with the criterion's name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from evaluators.applying import applied, read_only
from evaluators.timed.registry import TimedCriterion, resolve_all
from evaluators.timed.unfolding import Unfolding
from growth.protocol import Failure


def score(unfolding: Unfolding, criteria: Iterable[str] | Mapping[str, TimedCriterion]) -> dict[str, float] | Failure:
    """Apply criteria to a form that unfolds.

    Parameters
    ----------
    unfolding
        The criteria see it through arrays that cannot be written to.
    criteria
        Their names, or the criteria by name as :func:`evaluators.timed.registry.resolve_all` gives them.

    Returns
    -------
    dict of str to float, or Failure
        As of :func:`evaluators.applying.applied`.

    Raises
    ------
    InputError
        For a name that is no criterion.
    """
    found = resolve_all(criteria)
    return applied(found, read_only(unfolding))
