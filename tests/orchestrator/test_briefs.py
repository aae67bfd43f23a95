"""Briefs in experiments: the islands and channels that they become, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from experiments import write
from genome.errors import InputError
from orchestrator.briefs import by_weight, expanded
from orchestrator.loading import load_experiment
from orchestrator.run import prepare

BRIEF: dict[str, Any] = {
    "rooms": {"bath": {"cells": 2}, "hall": {"cells": 3}, "living": {"cells": 6}, "bed": {"cells": 4}},
    "zones": {"night": ["bed", "bath", "hall"], "day": ["living"]},
    "adjacencies": [["hall", "bed"], ["hall", "bath", 2], ["hall", "living"]],
    "entrance": "hall",
    "site": {"outline": [[0, 0], [9, 0], [9, 9], [0, 9]], "street": "east"},
}


def of(brief: dict[str, Any] | None = None, **more: Any) -> dict[str, Any]:
    return expanded({"name": "x", "brief": BRIEF if brief is None else brief, **more}, "x.yaml")


def test_there_is_an_island_for_each_room_zone_and_house() -> None:
    islands = of()["islands"]
    assert {name: island["kind"] for name, island in islands.items()} == {
        "bath": "room", "hall": "room", "living": "room", "bed": "room",
        "night": "zone", "day": "zone", "house": "house",
    }  # fmt: skip
    assert islands["bath"]["genome"] == {"cells": 2, "tiling": "square", "part": "bath"}


def test_parts_are_conjoined_in_the_order_of_the_matrix() -> None:
    islands = of()["islands"]
    assert islands["night"]["genome"]["parts"] == {"hall": ["hall"], "bath": ["bath"], "bed": ["bed"]}
    assert list(islands["house"]["growth"]["brief"]["rooms"]) == ["hall", "bath", "bed", "living"]
    given = of({**BRIEF, "order": "given"})["islands"]
    assert list(given["night"]["genome"]["parts"]) == ["bed", "bath", "hall"]
    assert by_weight(["a", "b", "c", "d"], {frozenset("cd"): 1.0, frozenset("db"): 3.0}) == ["d", "b", "c", "a"]


def test_a_zone_has_the_wishes_among_its_rooms_and_the_house_all() -> None:
    islands = of()["islands"]
    night, house = islands["night"]["growth"]["brief"], islands["house"]["growth"]["brief"]
    assert [tuple(one) for one in night["adjacencies"]] == [("hall", "bed", 1.0), ("hall", "bath", 2.0)]
    assert "outline" not in night["site"]
    assert len(house["adjacencies"]) == 3
    assert house["site"]["outline"] == [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]]


def test_parts_rise_and_demands_come_down() -> None:
    channels = of()["channels"]
    assert [(one["kind"], one["from"], one["to"]) for one in channels] == [
        ("components", ["bed", "bath", "hall"], ["night"]),
        ("partners", ["night"], ["bed", "bath", "hall"]),
        ("components", ["living"], ["day"]),
        ("partners", ["day"], ["living"]),
        ("components", ["night", "day"], ["house"]),
        ("partners", ["house"], ["night", "day"]),
    ]


def test_levels_in_turn_rise_once() -> None:
    brief = {**BRIEF, "levels": "in_turn"}
    for level, epochs in (("room", 3), ("zone", 2), ("house", 4)):
        brief[level] = {"epochs": epochs, "fitness": {"corners": {"goal": "minimise"}}}
    found = of(brief)
    assert found["epochs"] == 9
    assert [one["kind"] for one in found["channels"]] == ["components"] * 3
    assert [(one["since"], one["until"]) for one in found["channels"]] == [(3, 4), (3, 4), (5, 6)]
    assert {name: one["epochs"] for name, one in found["islands"].items() if one["kind"] != "room"} == {
        "night": 2, "day": 2, "house": 4,
    }  # fmt: skip
    assert "epochs" not in of({**brief}, generations=20)


def test_own_islands_and_channels_join() -> None:
    own = {"living": {"population": 99}, "skin": {"kind": "surface"}}
    found = of(islands=own, channels=[{"kind": "surroundings", "from": "house", "to": "skin"}])
    assert found["islands"]["living"]["population"] == 99
    assert found["islands"]["living"]["kind"] == "room"
    assert found["islands"]["skin"] == {"kind": "surface"}
    assert found["channels"][-1]["to"] == "skin"


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"zones": {"night": ["bed", "bath", "hall"]}}, "each room in a zone, got 'living' in none"),
        ({"zones": {**BRIEF["zones"], "attic": []}}, "zones of one room at least, got 'attic' without any"),
        ({"zones": {**BRIEF["zones"], "attic": ["roof"]}}, "zones of rooms of the brief, got 'roof'"),
        ({"zones": {**BRIEF["zones"], "attic": ["bed"]}}, "got 'bed' in 'night' and 'attic'"),
        ({"zones": {"bed": ["bed", "bath", "hall"], "day": ["living"]}}, "a zone with a name of its own"),
        ({"adjacencies": [["hall", "garage"]]}, "got 'garage'"),
        ({"site": {"outline": [[0, 0], [3, 0], [3, 3], [0, 3]]}}, "a site that holds the rooms' area of 15"),
        ({"rooms": {**BRIEF["rooms"], "bed": {"cells": 0}}}, "x.yaml: brief.rooms.bed.cells: expected a whole number"),
        ({"order": "random"}, "x.yaml: brief.order"),
        ({"room": {"required": {"corners": 4.0}}}, "'required' of zones and houses alone, got of rooms: corners"),
        ({"site": {"outline": [[0, 0], [30, 0], [30, 0.9], [0, 0.9]]}}, "got one in which 0 lie whole"),
        ({"site": {"outline": [[0, 0], [9000, 0], [9000, 90]]}}, "got 9000 by 90"),
        ({"room": {"fitness": {}}}, "x.yaml: brief.room.fitness"),
    ],
)
def test_wrong_briefs_are_refused(more: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        of({**BRIEF, **more})


def test_without_a_brief_nothing_changes() -> None:
    data = {"name": "x", "islands": {"a": 1}, "channels": []}
    assert expanded(data, "x.yaml") == data


def checked(path: Path) -> None:
    """Check an experiment as ``atoll check`` does."""
    loaded = load_experiment(path)
    try:
        prepare(loaded)
    except InputError as error:
        raise loaded.locate(error) from None


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (
            {"zone": {"required": {"beauty": 1.0}}},
            "brief: expected a criterion of plans, got 'beauty' (in what the brief",
        ),
        ({"room": {"select": "nicest"}}, "(in what the brief becomes: channels.0.select)"),
        ({"house": {"fitness": {"beauty": {"goal": "maximise"}}}}, "islands.house.fitness.beauty)"),
    ],
)
def test_what_is_wrong_with_islands_of_a_brief_is_told_of_the_brief(
    tmp_path, more: dict[str, Any], message: str
) -> None:
    path = write(tmp_path, {"name": "x", "brief": {**BRIEF, **more}})
    with pytest.raises(InputError) as caught:
        checked(path)
    assert message in str(caught.value)
    assert "brief" in caught.value.where
