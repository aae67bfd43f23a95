"""Parts that rise on channels of components, and the demand that comes down on channels of partners: JSON texts.

A part is ``{"name": "living", "genotype": {...}}``; a demand ``{"met": 0.5, "parts": {"living": {...}, ...}}`` is what
a zone or a house shows to those that it is assembled from: the share of its wanted adjacencies that it meets, and the
parts that it uses.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Final, NamedTuple

from genome.errors import InputError
from genome.polyform import Assembly, Room, decode_any, encode
from genome.settings import describe

Form = Room | Assembly

REMEMBERED: Final = 1024
"""Texts whose meaning is kept: a demand is looked at for each member, and parts stay for epochs."""

DEMAND: Final = "demand"
"""What kinds that give or take demands call them."""


class Demand(NamedTuple):
    """What an upper island asks of those below.

    Attributes
    ----------
    met
        The share of its wanted adjacencies that its representative meets, 0 to 1.
    parts
        The parts that it uses, by name.
    """

    met: float
    parts: Mapping[str, Form]


def part_text(name: str, genotype: Form) -> str:
    """Write a part."""
    return json.dumps({"name": name, "genotype": json.loads(encode(genotype))}, separators=(",", ":"))


@lru_cache(maxsize=REMEMBERED)
def read_part_text(text: str) -> tuple[str, Form]:
    """Read a part: its name and its genotype.

    Raises
    ------
    InputError
        For anything else.
    """
    match _loaded(text):
        case {"name": str(name), "genotype": dict(genotype), **more} if not more:
            return name, decode_any(json.dumps(genotype))
    raise InputError("part", "a part: its name and its genotype", describe(text))


def demand_text(met: float, parts: Mapping[str, Form]) -> str:
    """Write a demand."""
    told = {name: json.loads(encode(one)) for name, one in parts.items()}
    return json.dumps({"met": met, "parts": told}, separators=(",", ":"), allow_nan=False)


@lru_cache(maxsize=REMEMBERED)
def read_demand_text(text: str) -> Demand:
    """Read a demand; as :func:`read_part_text`."""
    match _loaded(text):
        case {"met": int() | float() as met, "parts": dict(parts), **more} if not more and math.isfinite(met):
            return Demand(float(met), {str(name): decode_any(json.dumps(one)) for name, one in parts.items()})
    raise InputError("demand", "a demand: what is met, and the parts", describe(text))


def _loaded(text: str) -> Any:  # noqa: ANN401 - whatever JSON holds
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return None
