"""``remove``: a member that leaves its deme, locked or not; the next generation fills the place."""

from __future__ import annotations

from typing import Any

from islands.interventions.intervention import Arguments, Subject
from islands.interventions.promote import NO_MEMBER


def remove(subject: Subject[Any], arguments: Arguments) -> Subject[Any] | str:
    """Remove ``{"id": id}``."""
    identity = arguments["id"]
    if not subject.has(identity):
        return NO_MEMBER
    left = tuple(one for one in subject.deme if one.id != identity)
    return subject._replace(deme=left, steered=subject.steered.without(identity))
