"""``promote``: a member that ranks before all others, whatever its fitness.

So it is first among the parents, the elite, the emigrants and the survivors, for as long as it lives there; it is not
kept alive, which is what ``lock`` does. Of several the one promoted last is the first.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from islands.interventions.intervention import Arguments, Subject

NO_MEMBER = "no member here"


def promote(subject: Subject[Any], arguments: Arguments) -> Subject[Any] | str:
    """Promote ``{"id": id}``; without an id nobody is promoted any more."""
    identity, steered = arguments.get("id"), subject.steered
    if identity is None:
        return subject._replace(steered=replace(steered, promoted=()))
    if not subject.has(identity):
        return NO_MEMBER
    others = tuple(one for one in steered.promoted if one != identity)
    return subject._replace(steered=replace(steered, promoted=(identity, *others)))
