"""Where an island's growth section holds the strengths of its bodies' joints, for whoever steers them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

SECTION: Final = "load"

KEYS: Final[Mapping[str, str]] = {"axial": "axial_strength", "torsion": "torsion_strength"}
"""Their keys in that section, by the names that steering has for them."""


def has_strengths(growth: Mapping[str, Any]) -> bool:
    """Tell whether joints of bodies of an island with this growth section have strengths."""
    section = growth.get(SECTION)
    return isinstance(section, Mapping) and all(key in section for key in KEYS.values())


def loaded(growth: Mapping[str, Any], strengths: Mapping[str, float]) -> dict[str, Any]:
    """Give a growth section with other strengths."""
    section = {**growth[SECTION], **{KEYS[name]: value for name, value in strengths.items()}}
    return {**growth, SECTION: section}
