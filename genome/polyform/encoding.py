"""The encoding of rooms, zones and houses in logs, checkpoints and migrants: JSON without blanks."""

from __future__ import annotations

import json
from typing import Any, Final

from genome.errors import InputError
from genome.polyform.genotypes import Assembly, Attachment, Conjoining, Part, Room
from genome.settings import describe

FORMAT: Final = 1
"""The version of this encoding."""

DEEPEST: Final = 16
"""Levels of assemblies within assemblies that are read."""


def encode(genotype: Room | Assembly) -> str:
    """Write a genotype; equal ones give equal texts.

    A room is ``{"format": 1, "first": 0, "joins": [[vector, edge], ...]}``, an assembly ``{"format": 1, "parts":
    [{"id": ..., "genotype": {...}}, ...], "joins": [[vector, edge, onto], ...]}``.
    """
    return json.dumps({"format": FORMAT, **_plain(genotype)}, separators=(",", ":"))


def _plain(genotype: Room | Assembly) -> dict[str, Any]:
    joins = [list(join) for join in genotype.joins]
    if isinstance(genotype, Room):
        return {"first": genotype.first, "joins": joins}
    return {"parts": [{"id": one.id, "genotype": _plain(one.genotype)} for one in genotype.parts], "joins": joins}


def decode_room(text: str) -> Room:
    """Read a room.

    Raises
    ------
    InputError
        For anything else.
    """
    found = decode_any(text)
    if not isinstance(found, Room):
        raise InputError("genotype", "a room", "an assembly")
    return found


def decode_assembly(text: str) -> Assembly:
    """Read an assembly; as :func:`decode_room`."""
    found = decode_any(text)
    if not isinstance(found, Assembly):
        raise InputError("genotype", "an assembly", "a room")
    return found


def decode_any(text: str) -> Room | Assembly:
    """Read a room or an assembly; as :func:`decode_room`."""
    try:
        data: Any = json.loads(text)
    except (ValueError, RecursionError):
        data = None
    if not isinstance(data, dict) or data.pop("format", None) != FORMAT:
        raise InputError("genotype", f"a room or an assembly as JSON of format {FORMAT}", describe(text))
    return _genotype(data, 0)


def _genotype(data: object, depth: int) -> Room | Assembly:
    if depth <= DEEPEST:
        match data:
            case {"first": int(first), "joins": [*joins], **more} if not more and not isinstance(first, bool):
                return Room(tuple(Conjoining(*_numbers(one, 2)) for one in joins), first)
            case {"parts": [*parts], "joins": [*joins], **more} if not more and len(parts) == len(joins) + 1:
                return Assembly(
                    tuple(_part(one, depth) for one in parts), tuple(Attachment(*_numbers(one, 3)) for one in joins)
                )
    raise InputError("genotype", "a room's or an assembly's keys", describe(data))


def _part(data: object, depth: int) -> Part:
    match data:
        case {"id": int(identity), "genotype": inner, **more} if not more and not isinstance(identity, bool):
            return Part(identity, _genotype(inner, depth + 1))
    raise InputError("genotype", "a part: its id and its genotype", describe(data))


def _numbers(row: object, count: int) -> list[int]:
    if isinstance(row, list) and len(row) == count and all(type(one) is int and one >= 0 for one in row):
        return row
    raise InputError("genotype", f"{count} whole numbers from 0", describe(row))
