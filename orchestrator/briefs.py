"""A brief in an experiment: rooms, zones and what they want become islands, and channels between their levels.

``docs/formats/brief.md`` describes it. One island, or several runs, for each room, zone and house; chosen members rise
on channels of components (Rosenman 1997, section 2.2.4).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Final, Literal, Self

from pydantic import Field, model_validator

from evaluators.fitness import Goal
from evaluators.plans import Brief
from evaluators.plans.brief import RoomName
from genome.errors import InputError
from genome.settings import Settings, describe, near, validated
from islands.settings import Algorithm
from orchestrator.channels import Count

HOUSE: Final = "house"
"""The name of the island on top."""

Level = Literal["room", "zone", "house"]


Fitness = Annotated[dict[str, Goal], Field(min_length=1)]


class LevelSettings(Settings):
    """How the islands of one level evolve.

    Attributes
    ----------
    runs
        Islands of each room, zone or house, each from a random population of its own.
    epochs
        How many epochs it breeds in where levels run one after the other.
    population, fitness, algorithm
        As of an island.
    rise
        How many members rise to the level above at a time.
    select
        Which: ``best``, ``spread`` (medoids), or another choice of channels.
    required
        Of zones and houses: what a plan must reach to be valid.
    """

    runs: Count = 1
    epochs: Count = 8
    population: Count = 48
    fitness: Fitness | None = None
    algorithm: Algorithm = Algorithm(mutation=0.3)
    rise: Count = 10
    select: str = "spread"
    required: dict[str, float] = Field(default_factory=dict)


ROOMS: Final = {
    "perimeter_to_area": Goal(goal="minimise"),
    "corners": Goal(goal="minimise", scale=20.0),
}
PLANS: Final = {"adjacency": Goal(goal="minimise")}
USUAL: Final[Mapping[Level, Mapping[str, Goal]]] = {"room": ROOMS, "zone": PLANS, "house": PLANS}
"""Goals of a level that has none of its own (Rosenman 1997, section 3.3.1)."""


class BriefSettings(Brief):
    """The ``brief:`` section of an experiment: see :class:`evaluators.plans.Brief`, and how it is built up.

    Attributes
    ----------
    zones
        The rooms of each zone.
    order
        In which parts are conjoined: as they are ``given``, or by the interconnection ``matrix``: the one with most
        weight first, then whichever weighs most with those before it (Rosenman 1997, section 3.2.2).
    levels
        ``in_turn``: each level runs its epochs, then its members rise once. ``together``: all run at once, and better
        parts rise as they come.
    ask
        Whether plans that miss adjacencies ask those below for other parts; ``together`` alone.
    room, zone, house
        How each level evolves.
    """

    zones: Annotated[dict[RoomName, list[str]], Field(min_length=1)]
    order: Literal["matrix", "given"] = "matrix"
    levels: Literal["in_turn", "together"] = "together"
    ask: bool = True
    room: LevelSettings = LevelSettings()
    zone: LevelSettings = LevelSettings()
    house: LevelSettings = LevelSettings()

    @model_validator(mode="after")
    def _each_room_in_one_zone(self) -> Self:
        seen: dict[str, str] = {}
        for zone, rooms in self.zones.items():
            if zone in self.rooms or zone == HOUSE:
                raise InputError("", "a zone with a name of its own", f"'{zone}'", "rooms and the house have names too")
            if not rooms:
                raise InputError("", "zones of one room at least", f"'{zone}' without any")
            for room in rooms:
                if room not in self.rooms:
                    raise InputError("", "zones of rooms of the brief", describe(room), near(room, list(self.rooms)))
                if room in seen:
                    raise InputError("", "each room once in one zone", f"'{room}' in '{seen[room]}' and '{zone}'")
                seen[room] = zone
        for room in self.rooms:
            if room not in seen:
                raise InputError("", "each room in a zone", f"'{room}' in none", "name it under zones")
        if self.room.required:
            got = ", ".join(self.room.required)
            raise InputError("", "'required' of zones and houses alone", f"of rooms: {got}", "make it a goal of rooms")
        if HOUSE in self.rooms:
            raise InputError("", "rooms that are not named as the house is", f"'{HOUSE}'", "choose another name")
        return self

    def plain(self) -> Brief:
        """Give the brief without how it is built up."""
        fields = {name: getattr(self, name) for name in Brief.model_fields}
        return Brief.model_construct(**fields)

    def ordered(self) -> dict[str, list[str]]:
        """Give the zones and their rooms in the order in which they are conjoined."""
        if self.order == "given":
            return {zone: list(rooms) for zone, rooms in self.zones.items()}
        weights = {frozenset((one.first, one.second)): one.weight for one in self.adjacencies}
        home = {room: zone for zone, rooms in self.zones.items() for room in rooms}
        between: dict[frozenset[str], float] = {}
        for pair, weight in weights.items():
            ends = frozenset(home[room] for room in pair)
            if len(ends) == 2:
                between[ends] = between.get(ends, 0.0) + weight
        zones = by_weight(list(self.zones), between)
        return {zone: by_weight(self.zones[zone], weights) for zone in zones}


def by_weight(names: Sequence[str], weights: Mapping[frozenset[str], float]) -> list[str]:
    """Order names: the one of most weight first, then whichever weighs most with those before it; else as given."""

    def weight(name: str, others: Sequence[str]) -> float:
        return sum(weights.get(frozenset((name, other)), 0.0) for other in others if other != name)

    left = list(names)
    found = [max(left, key=lambda name: weight(name, names))]
    while len(found) < len(names):
        left = [name for name in left if name not in found]
        found.append(max(left, key=lambda name: weight(name, found)))
    return found


def expanded(data: Mapping[str, Any], source: str) -> dict[str, Any]:
    """Put islands and channels in the place of an experiment's brief; its own islands win key by key.

    Raises
    ------
    InputError
        When the brief is not right.
    """
    plain = dict(data)
    given = plain.pop("brief", None)
    if given is None:
        return plain
    brief = validated(BriefSettings, given, source, ("brief",))
    islands = _islands(brief)
    own = plain.get("islands")
    if isinstance(own, Mapping):
        for name, island in own.items():
            base = islands.get(name)
            known = isinstance(base, dict) and isinstance(island, Mapping)
            islands[name] = {**base, **island} if known and base is not None else island
    plain["islands"] = islands
    channels = plain.get("channels") or []
    plain["channels"] = [*_channels(brief), *channels] if isinstance(channels, list) else channels
    if brief.levels == "in_turn" and "epochs" not in plain and "generations" not in plain:
        plain["epochs"] = brief.room.epochs + brief.zone.epochs + brief.house.epochs
    return plain


def _islands(brief: BriefSettings) -> dict[str, Any]:
    zones, plain = brief.ordered(), brief.plain()
    islands: dict[str, Any] = {}
    for name, wish in brief.rooms.items():
        islands[name] = _island("room", brief) | {
            "genome": {"cells": wish.cells, "tiling": brief.tiling, "part": name},
            "growth": {"unit": brief.unit},
        }
    for zone, rooms in zones.items():
        islands[zone] = _assembly("zone", brief, {room: [room] for room in rooms}, plain.among(rooms), zone)
    whole = plain.model_copy(update={"rooms": {room: plain.rooms[room] for own in zones.values() for room in own}})
    islands[HOUSE] = _assembly("house", brief, zones, whole, HOUSE)
    return islands


def _island(level: Level, brief: BriefSettings) -> dict[str, Any]:
    settings: LevelSettings = getattr(brief, level)
    goals = settings.fitness or USUAL[level]
    island: dict[str, Any] = {
        "kind": level,
        "count": settings.runs,
        "population": settings.population,
        "fitness": {name: goal.model_dump(mode="json", exclude_none=True) for name, goal in goals.items()},
        "algorithm": settings.algorithm.model_dump(mode="json", exclude_none=True),
    }
    if brief.levels == "in_turn":
        island["epochs"] = settings.epochs
    return island


def _assembly(
    level: Level, brief: BriefSettings, parts: Mapping[str, list[str]], own: Brief, name: str
) -> dict[str, Any]:
    settings: LevelSettings = getattr(brief, level)
    growth = {"brief": own.model_dump(mode="json", exclude_none=True), "required": dict(settings.required)}
    return _island(level, brief) | {"genome": {"parts": dict(parts), "part": name}, "growth": growth}


def _channels(brief: BriefSettings) -> list[dict[str, Any]]:
    first, second = brief.room.epochs, brief.room.epochs + brief.zone.epochs
    channels: list[dict[str, Any]] = []
    for zone, rooms in brief.zones.items():
        channels.append(_rising(brief, brief.room, rooms, zone, first))
        if brief.ask and brief.levels == "together":
            channels.append({"name": f"{zone}-asks", "kind": "partners", "from": [zone], "to": list(rooms)})
    zones = list(brief.zones)
    channels.append(_rising(brief, brief.zone, zones, HOUSE, second))
    if brief.ask and brief.levels == "together":
        channels.append({"name": f"{HOUSE}-asks", "kind": "partners", "from": [HOUSE], "to": zones})
    return channels


def _rising(brief: BriefSettings, level: LevelSettings, below: Sequence[str], above: str, at: int) -> dict[str, Any]:
    channel: dict[str, Any] = {
        "name": f"to-{above}",
        "kind": "components",
        "from": list(below),
        "to": [above],
        "count": min(level.rise, level.population),
        "keep": level.rise if brief.levels == "in_turn" else 2 * level.rise,
        "select": level.select,
    }
    return channel | ({"since": at, "until": at + 1} if brief.levels == "in_turn" else {})
