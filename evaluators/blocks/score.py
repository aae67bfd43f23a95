"""Scores a body under load by several criteria; whatever goes wrong becomes a failure with the criterion's name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from evaluators.applying import applied, read_only
from evaluators.blocks.registry import BlockCriterion, resolve_all
from evaluators.blocks.structure import Structure
from growth.protocol import Failure


def score(structure: Structure, criteria: Iterable[str] | Mapping[str, BlockCriterion]) -> dict[str, float] | Failure:
    """Apply criteria to a body under load.

    Parameters
    ----------
    structure
        The criteria see it through arrays that cannot be written to.
    criteria
        Their names, or the criteria by name as :func:`evaluators.blocks.registry.resolve_all` gives them.

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
    return applied(found, Structure(read_only(structure.body), read_only(structure.load)))
