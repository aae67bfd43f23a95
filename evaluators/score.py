"""Scores a form by several criteria; whatever goes wrong becomes a failure with the criterion's name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from evaluators.applying import applied, read_only
from evaluators.registry import Criterion, resolve_all
from growth.protocol import Failure
from growth.surface import Surface

if TYPE_CHECKING:
    from growth.environment import Environment


def score(
    surface: Surface, environment: Environment, criteria: Iterable[str] | Mapping[str, Criterion]
) -> dict[str, float] | Failure:
    """Apply criteria to a form.

    Parameters
    ----------
    surface
        A form. The criteria see it through arrays that cannot be written to.
    environment
        Where it grew.
    criteria
        Their names, or the criteria by name as :func:`evaluators.registry.resolve_all` gives them, which saves looking
        each up for every form.

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
    return applied(found, read_only(surface), environment)
