"""``insert``: an individual whose genotype somebody wrote down.

It is born on the island, with no parents and the origin ``intervention``, scored as all are in that epoch, and takes
a free place, or that of the worst member that is not locked. One that is invalid there is in the log alone.
"""

from __future__ import annotations

from typing import TypeVar

from genome.mishaps import let_pass, one_line, told
from islands.algorithms.breeding import Birth
from islands.interventions.intervention import Subject
from islands.registrar import Registrar
from islands.selection import ranked

G = TypeVar("G")
KIND = "insert"


def insert(subject: Subject[G], genotype: str, registrar: Registrar[G]) -> tuple[Subject[G] | str, int | None]:
    """Insert a genotype, given in its encoding.

    Returns
    -------
    The island with the newcomer, or the reason why it is as before; and the newcomer's id, if it was born.
    """
    steered, deme = subject.steered, subject.deme
    places = [one for one in ranked(deme, steered.promoted) if one.id not in steered.locked]
    is_full = len(deme) >= subject.spec.population
    if is_full and not places:
        return "no place left: all members are locked", None
    try:
        read = registrar.context.biology.decode(genotype)
    except BaseException as error:  # noqa: BLE001 - whatever a plug-in raises must not end the run
        let_pass(error)
        return one_line(f"genotype: {told(error)}"), None
    newcomer = registrar.bear(Birth(read, (), "intervention"))
    if newcomer.fitness is None:
        return one_line(f"invalid: {newcomer.error}"), newcomer.id
    lost = places[-1].id if is_full else None
    left = tuple(one for one in deme if one.id != lost)
    return Subject(subject.spec, (*left, newcomer), steered if lost is None else steered.without(lost)), newcomer.id
