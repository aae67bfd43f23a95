"""``strength``: other strengths of joints (Senatore 2009, 'weights and mechanical properties').

From that epoch on bodies are loaded by the changed strengths, and the deme is scored again: who stood may fall, and who
fell may stand. A strength stays changed until it is changed again.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

from genome.errors import InputError
from genome.settings import describe, near
from islands.interventions.intervention import Arguments, Subject
from islands.strengths import KEYS, has_strengths

STRENGTH: Final = "strength"

LARGEST: Final = 1e12


def changed(growth: Mapping[str, Any], values: Mapping[str, float], where: str) -> dict[str, float]:
    """Give the new strengths.

    Parameters
    ----------
    growth
        The island's growth section.
    values
        The new strengths, by name.
    where
        The place, for messages.

    Raises
    ------
    InputError
        For an island whose bodies have no joints, a strength that there is not, or one that is not above zero.
    """
    if not has_strengths(growth):
        raise InputError(where, "an island of bodies under load", "one without a section 'load'")
    for name, value in values.items():
        if name not in KEYS:
            raise InputError(where, "a strength of joints", f"'{name}'", near(name, list(KEYS)))
        if not (math.isfinite(value) and 0 < value <= LARGEST):
            raise InputError(f"{where} {name}", f"a number above 0 and up to {LARGEST:g}", describe(value))
    return {name: float(value) for name, value in values.items()}


def strength(subject: Subject[Any], arguments: Arguments) -> Subject[Any]:
    """Change strengths: ``{"values": {name: strength}}``."""
    strengths = changed(subject.spec.growth, arguments["values"], STRENGTH)
    return subject._replace(steered=subject.steered.with_strengths(strengths))
