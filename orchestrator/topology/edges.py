"""Edges written out one by one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Final, final

from pydantic import BeforeValidator, WithJsonSchema

from genome.errors import InputError
from genome.mishaps import one_line
from genome.settings import Settings, describe, near
from orchestrator.topology.protocol import Ground, Link

SHAPE: Final = "a list of two islands, and a weight from 0 to 1 if it has one: [a, b] or [a, b, 0.5]"


def _as_item(value: object) -> object:
    parts = tuple(value) if isinstance(value, (list, tuple)) else ()
    ends, weight = parts[:2], parts[2:]
    if len(parts) not in (2, 3) or not all(type(end) in (str, int) for end in ends):
        raise InputError("", SHAPE, describe(value))
    if weight and (type(weight[0]) not in (int, float) or not 0 <= weight[0] <= 1):
        raise InputError("", "a weight from 0 to 1", describe(weight[0]))
    return (*ends, *map(float, weight))


_SCHEMA: Final = {
    "type": "array",
    "prefixItems": [{"type": ["string", "integer"]}, {"type": ["string", "integer"]}, {"type": "number"}],
    "minItems": 2,
    "maxItems": 3,
}


@final
class Edges(Settings):
    """A list of directed edges.

    Attributes
    ----------
    edges
        Source and target, names of members or their places from 0, and a weight in place of the channel's.
    """

    edges: list[Annotated[Any, BeforeValidator(_as_item), WithJsonSchema(_SCHEMA)]]

    def links(self, ground: Ground) -> list[Link]:
        """Give the edges.

        Raises
        ------
        InputError
            For an end that is no member, a loop, or an edge that is there twice.
        """
        places = {name: place for place, name in enumerate(ground.names)}
        found: dict[tuple[int, int], int] = {}
        links = []
        for number, (source, target, *weight) in enumerate(self.edges):
            where = f"edges.{number}"
            ends = _place(source, places, where), _place(target, places, where)
            if ends[0] == ends[1]:
                raise InputError(
                    where, "two islands", f"'{one_line(str(source), 60)}' twice", "a channel to itself carries nothing"
                )
            if ends in found:
                shown = " -> ".join(one_line(str(end), 60) for end in (source, target))
                got = f"{shown} again, as edge {found[ends]}"
                raise InputError(where, "each edge once", got, "remove one of them")
            found[ends] = number
            links.append(Link(*ends, *weight))
        return links


def _place(end: str | int, places: Mapping[str, int], where: str) -> int:
    """Give the place of a member by its name or place."""
    if isinstance(end, int):
        if 0 <= end < len(places):
            return end
        raise InputError(where, f"a member's name, or its place from 0 to {len(places) - 1}", str(end))
    if end in places:
        return places[end]
    raise InputError(where, "a member of the channel, by name or place", describe(end), near(end, list(places)))
