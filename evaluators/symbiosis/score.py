"""Scores partners in one space by several criteria; whatever goes wrong becomes a failure that says what."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from evaluators.applying import applied, read_only
from evaluators.symbiosis.registry import SymbiosisCriterion, resolve_all
from evaluators.symbiosis.symbiosis import Symbiosis
from growth.protocol import Failure


def score(
    symbiosis: Symbiosis, criteria: Iterable[str] | Mapping[str, SymbiosisCriterion]
) -> dict[str, float] | Failure:
    """Apply criteria to partners in one space.

    Parameters
    ----------
    symbiosis
        The criteria see it through arrays that cannot be written to.
    criteria
        Their names, or the criteria by name as :func:`evaluators.symbiosis.registry.resolve_all` gives them.

    Returns
    -------
    dict of str to float, or Failure
        As of :func:`evaluators.applying.applied`; ``evaluation`` too where the partners span too large a box.

    Raises
    ------
    InputError
        For a name that is no criterion.
    """
    found = resolve_all(criteria)
    seen = read_only(symbiosis)
    try:
        _ = seen.surroundings
    except ValueError as error:
        return Failure("evaluation", str(error))
    return applied(found, seen)
