"""``lock`` and ``unlock``: a member that stays in the deme whatever comes.

Neither offspring nor immigrants replace it, and it never moves away; copies of it travel as of any other. It breeds as
before, and lives beside those whom the algorithm lets live, who share the places that are left.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from islands.interventions.intervention import Arguments, Subject
from islands.interventions.promote import NO_MEMBER


def lock(subject: Subject[Any], arguments: Arguments) -> Subject[Any] | str:
    """Lock ``{"id": id}``."""
    identity, steered = arguments["id"], subject.steered
    if not subject.has(identity):
        return NO_MEMBER
    return subject._replace(steered=replace(steered, locked=tuple(sorted({*steered.locked, identity}))))


def unlock(subject: Subject[Any], arguments: Arguments) -> Subject[Any] | str:
    """Unlock ``{"id": id}``."""
    identity, steered = arguments["id"], subject.steered
    if not subject.has(identity):
        return NO_MEMBER
    if identity not in steered.locked:
        return "not locked"
    return subject._replace(steered=replace(steered, locked=tuple(one for one in steered.locked if one != identity)))
