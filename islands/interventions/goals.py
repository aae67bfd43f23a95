"""``weight`` and ``target``: other weights and targets of an island's goals.

From that epoch on the island scores by the changed goals, and its deme is scored again. A goal stays changed until it
is changed again. ``target`` makes its criterion a target even where it was to be as large or as small as possible: it
keeps its weight, and its scale is gone.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from evaluators.fitness import Goal
from genome.errors import InputError
from genome.settings import near, validated
from islands.interventions.intervention import Arguments, Subject


def changed(kind: str, goals: Mapping[str, Any], values: Mapping[str, float], where: str) -> dict[str, Goal]:
    """Give the goals that an intervention changes, changed.

    Parameters
    ----------
    kind
        ``weight`` or ``target``.
    goals
        The goals as they are, by criterion, as in an experiment.
    values
        The new weights or targets, by criterion.
    where
        The place, for messages.

    Raises
    ------
    InputError
        For a criterion without a goal, or a value that is none.
    """
    found = {}
    for name, value in values.items():
        if name not in goals:
            expected = "a criterion that the island has a goal for"
            raise InputError(where, expected, f"'{name}'", near(name, sorted(goals)))
        data = {**goals[name], "weight": value}
        if kind == "target":
            data = {"goal": "target", "value": value, "weight": goals[name].get("weight", 1.0)}
        found[name] = validated(Goal, data, f"{where} {name}")
    return found


def _effect(kind: str, subject: Subject[Any], arguments: Arguments) -> Subject[Any]:
    spec, steered = subject.spec, subject.steered
    goals = changed(kind, steered.spec(spec).fitness, arguments["values"], kind)
    return subject._replace(steered=steered.with_goals(goals))


def weight(subject: Subject[Any], arguments: Arguments) -> Subject[Any]:
    """Change weights: ``{"values": {criterion: weight}}``."""
    return _effect(WEIGHT, subject, arguments)


def target(subject: Subject[Any], arguments: Arguments) -> Subject[Any]:
    """Change targets: ``{"values": {criterion: target}}``."""
    return _effect(TARGET, subject, arguments)


WEIGHT: Final = "weight"
TARGET: Final = "target"
