"""``.plan`` files: a room, or a plan by its brief and given genotypes; ``docs/formats/plan.md`` describes them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final, Literal, final

import numpy as np
from pydantic import Field

from evaluators.plans import Brief
from evaluators.plans.brief import MOST_CELLS
from genome.errors import InputError
from genome.polyform import Assembly, Attachment, Conjoining, Part, Room
from genome.settings import Settings, describe, near, validated
from genome.yaml import Document, load_yaml
from growth.polyforms import TILINGS, Tiling, draw_assembly, draw_room, form_of
from growth.protocol import Failure
from orchestrator.briefs import HOUSE, BriefSettings

ROOM: Final = "room"
"""The name of a room that stands alone."""

WAYS: Final = {"up": 0, "down": 1}
"""Where the first of triangles points."""

TRIES: Final = 64
"""Rooms and attachments that the file leaves open are drawn anew so often until they can be conjoined."""

_EDGE: Final = re.compile(r"([A-Z])([1-9][0-9]{0,8})")

Edges = list[Any]


class RoomFile(Settings):
    """A room alone.

    Attributes
    ----------
    tiling, unit
        As of a brief.
    cells
        How many; a room that is not given is drawn.
    room
        Its conjoinings.
    seed
        What is drawn starts from it.
    """

    tiling: Literal["square", "triangle", "hexagon", "cube"] = "square"
    unit: Annotated[float, Field(gt=0, le=1000)] = 1.0
    cells: Annotated[int, Field(ge=1, le=MOST_CELLS)] | None = None
    room: Edges | None = None
    seed: Annotated[int, Field(ge=0)] = 0


class PlanFile(Settings):
    """A plan.

    Attributes
    ----------
    brief
        As of an experiment.
    rooms
        The conjoinings of rooms by name; others are drawn.
    joins
        The attachments of each zone's rooms but the first, and of the house's zones but the first; others are drawn.
    seed
        What is drawn starts from it.
    """

    brief: dict[str, Any]
    rooms: dict[str, Edges] = Field(default_factory=dict)
    joins: dict[str, Edges] = Field(default_factory=dict)
    seed: Annotated[int, Field(ge=0)] = 0


@final
@dataclass(frozen=True, slots=True)
class Given:
    """What a file gives.

    Attributes
    ----------
    brief
        The rooms in the order in which they are conjoined.
    zones
        The rooms of each zone, in that order; one zone for a room alone.
    rooms, joins
        Those that are given.
    seed
        For the others.
    """

    brief: Brief
    zones: Mapping[str, Sequence[str]]
    rooms: Mapping[str, Room]
    joins: Mapping[str, tuple[Attachment, ...]]
    seed: int


def read_plan(path: Path) -> Given:
    """Read a ``.plan`` file.

    Raises
    ------
    InputError
        When it is not right, with the line where it is known.
    """
    document = load_yaml(path)
    if isinstance(document.data, Mapping) and "brief" in document.data:
        return _plan(document)
    return _room(document)


def genotype_of(given: Given, seed: int | None) -> Room | Assembly | Failure:
    """Give the genotype, what is left open drawn at random.

    Parameters
    ----------
    given
        A file's.
    seed
        In place of the file's own.

    Returns
    -------
    Room, Assembly or Failure
        A failure where given parts do not conjoin, or no way to conjoin them was found.
    """
    tiling = given.brief.cells
    rng = np.random.default_rng(given.seed if seed is None else seed)
    found: Room | Assembly | Failure = Failure("conjoining", "nothing was tried")
    for _ in range(TRIES):
        found = _assembled(given, tiling, rng)
        if not isinstance(found, Failure):
            break
    return found


def _assembled(given: Given, tiling: Tiling, rng: np.random.Generator) -> Room | Assembly | Failure:
    zones: list[Room | Assembly] = []
    for zone, names in given.zones.items():
        rooms: list[Room | Assembly] = [
            given.rooms[name] if name in given.rooms else draw_room(given.brief.rooms[name].cells, tiling, rng)
            for name in names
        ]
        made = _joined(rooms, given.joins.get(zone), tiling, rng)
        if isinstance(made, Failure):
            return Failure(made.reason, f"{zone}: {made.detail}" if len(rooms) > 1 else made.detail)
        zones.append(made)
    return _joined(zones, given.joins.get(HOUSE), tiling, rng)


def _joined(
    parts: Sequence[Room | Assembly], joins: tuple[Attachment, ...] | None, tiling: Tiling, rng: np.random.Generator
) -> Room | Assembly | Failure:
    numbered = [Part(number, one) for number, one in enumerate(parts)]
    if len(parts) == 1:
        made: Room | Assembly | Failure = parts[0]
    elif joins is None:
        made = draw_assembly(numbered, tiling, rng)
    else:
        made = Assembly(tuple(numbered), joins)
    if isinstance(made, Failure):
        return made
    grown = form_of(made, tiling)
    return grown if isinstance(grown, Failure) else made


# -- reading -----------------------------------------------------------------------------------------------------------


def _room(document: Document) -> Given:
    file = validated(RoomFile, document.data, document.source, line_of=document.line_of)
    tiling = TILINGS[file.tiling]
    rooms: dict[str, Room] = {}
    if file.room is not None:
        rooms[ROOM] = _conjoinings(file.room, tiling, document, (ROOM,))
    elif file.cells is None:
        raise InputError(document.source, "a brief, a room's conjoinings or its cells", "none of them",
                         "for example room: [E1, N1]")  # fmt: skip
    cells = rooms[ROOM].size if file.cells is None else file.cells
    if ROOM in rooms and rooms[ROOM].size != cells:
        got = f"conjoinings of {rooms[ROOM].size}"
        raise InputError(_at(document, ("cells",)), f"conjoinings of {cells} cells", got)
    wishes = {"tiling": file.tiling, "unit": file.unit, "rooms": {ROOM: {"cells": cells}}}
    return Given(validated(Brief, wishes, document.source), {ROOM: [ROOM]}, rooms, {}, file.seed)


def _plan(document: Document) -> Given:
    file = validated(PlanFile, document.data, document.source, line_of=document.line_of)
    brief = validated(BriefSettings, file.brief, document.source, ("brief",), document.line_of)
    zones, plain, tiling = brief.ordered(), brief.plain(), brief.cells
    rooms = {}
    for name, edges in file.rooms.items():
        at = _at(document, ("rooms", name))
        if name not in brief.rooms:
            raise InputError(at, "rooms of the brief", f"'{name}'", near(name, list(brief.rooms)))
        rooms[name] = _conjoinings(edges, tiling, document, ("rooms", name))
        cells = brief.rooms[name].cells
        if rooms[name].size != cells:
            raise InputError(at, f"{cells - 1} conjoinings for {cells} cells", f"{rooms[name].size - 1}")
    joins = {}
    parts: Mapping[str, Sequence[str]] = {**zones, HOUSE: list(zones)}
    for name, rows in file.joins.items():
        at = _at(document, ("joins", name))
        if name not in parts:
            raise InputError(at, "zones of the brief, or the house", f"'{name}'", near(name, list(parts)))
        joins[name] = tuple(_attachment(row, tiling, document, ("joins", name, k)) for k, row in enumerate(rows))
        if len(rows) != len(parts[name]) - 1:
            names = ", ".join(parts[name])
            raise InputError(at, f"an attachment of each part but the first ({names})", f"{len(rows)}")
    ordered = {room: plain.rooms[room] for own in zones.values() for room in own}
    return Given(plain.model_copy(update={"rooms": ordered}), zones, rooms, joins, file.seed)


def _conjoinings(edges: Edges, tiling: Tiling, document: Document, path: tuple[str, ...]) -> Room:
    first, rest = 0, list(edges)
    if rest and tiling.types > 1 and rest[0] in WAYS:
        first = WAYS[rest.pop(0)]
    shift = len(edges) - len(rest)
    places = [_edge(one, tiling, document, (*path, k + shift)) for k, one in enumerate(rest)]
    return Room(tuple(Conjoining(*one) for one in places), first)


def _attachment(row: object, tiling: Tiling, document: Document, path: tuple[str | int, ...]) -> Attachment:
    match row:
        case [edge, int() as onto] if onto >= 1 and not isinstance(onto, bool):
            return Attachment(*_edge(edge, tiling, document, path), onto - 1)
    what = "a free edge and the number of the part's: [E3, 2]"
    raise InputError(_at(document, path), what, describe(row))


def _edge(text: object, tiling: Tiling, document: Document, path: tuple[str | int, ...]) -> tuple[int, int]:
    found = _EDGE.fullmatch(text) if isinstance(text, str) else None
    if found is None or found[1] not in tiling.letters:
        letters = ", ".join(tiling.letters)
        what = f"a vector's letter ({letters}) and the number of a free edge, such as {tiling.letters[0]}1"
        raise InputError(_at(document, path), what, describe(text))
    return tiling.letters.index(found[1]), int(found[2]) - 1


def _at(document: Document, path: tuple[str | int, ...]) -> str:
    line = document.line_of(path)
    place = f"{document.source}:{line}" if line else document.source
    return f"{place}: {'.'.join(map(str, path))}"
