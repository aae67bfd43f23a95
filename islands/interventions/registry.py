"""The interventions by name, and how they are taken in. A new one is one file here and one line of ``EFFECTS``."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, TypeVar

from genome.errors import InputError
from islands.interventions.goals import target, weight
from islands.interventions.insert import KIND as INSERT
from islands.interventions.insert import insert
from islands.interventions.intervention import Arguments, Intervention, Subject, is_elsewhere
from islands.interventions.lock import lock, unlock
from islands.interventions.promote import promote
from islands.interventions.rates import rate
from islands.interventions.remove import remove
from islands.interventions.strengths import STRENGTH, strength
from islands.registrar import Registrar

G = TypeVar("G")
Effect = Callable[[Subject[Any], Arguments], Subject[Any] | str]
"""From the island and the arguments to the changed island, or to the reason why it is as before."""

EFFECTS: Final[Mapping[str, Effect]] = {
    "weight": weight,
    "target": target,
    "rate": rate,
    STRENGTH: strength,
    "promote": promote,
    "lock": lock,
    "unlock": unlock,
    "remove": remove,
}
"""All but ``insert``, which has to score."""

KINDS: Final = (*EFFECTS, INSERT)


def changed(subject: Subject[G], interventions: Sequence[Intervention], registrar: Registrar[G]) -> Subject[G]:
    """Let interventions change an island, one after the other; those that insert come later, with :func:`joined`.

    Each is an event ``intervention`` of the island: ``done``, or ``detail``, which says why not.
    """
    for one in interventions:
        if one.kind == INSERT or is_elsewhere(one, subject):
            continue
        try:
            after = EFFECTS[one.kind](subject, one.arguments)
        except InputError as error:
            after = str(error)
        _tell(registrar, one, after, {})
        subject = subject if isinstance(after, str) else after
    return subject


def joined(subject: Subject[G], interventions: Sequence[Intervention], registrar: Registrar[G]) -> Subject[G]:
    """Let those join who are inserted, one after the other, scored as all are in this epoch."""
    for one in interventions:
        if one.kind == INSERT:
            after, identity = insert(subject, one.arguments["genotype"], registrar)
            _tell(registrar, one, after, {} if identity is None else {"id": identity})
            subject = subject if isinstance(after, str) else after
    return subject


def _tell(registrar: Registrar[Any], one: Intervention, after: object, more: Mapping[str, object]) -> None:
    # A genotype may be long, and has a row of its own.
    arguments = {key: value for key, value in one.arguments.items() if key != "genotype"}
    detail: dict[str, object] = {"command": one.number, "kind": one.kind, **arguments, **more}
    why = {"detail": after} if isinstance(after, str) else {}
    registrar.note("intervention", {**detail, "done": not why, **why})
