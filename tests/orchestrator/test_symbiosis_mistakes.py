"""Mistakes in experiments with enclosures, spaces and routes: refused by ``check`` and ``run`` alike, in one line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from refusals import refused
from rooms import house

from experiments import write
from orchestrator.cli import main


def without(number: int) -> dict[str, Any]:
    data = house()
    del data["channels"][number]
    return data


def grown(**growth: Any) -> dict[str, Any]:
    data = house()
    data["islands"]["walls"]["growth"] = growth
    return data


def channelled(*more: dict[str, Any], **islands: Any) -> dict[str, Any]:
    data = house()
    data["islands"] |= islands
    data["channels"] += more
    return data


ROUTE = {"kind": "route", "fitness": {"route": {"goal": "maximise"}}}
BOX = [[0, 0], [4, 0], [4, 4], [0, 4]]

CASES: dict[str, tuple[dict[str, Any], str, str]] = {
    "walls without partners": (without(2), "islands.walls.kind", "channel of kind partners to walls-0, which it"),
    "rooms without partners": (without(3), "islands.rooms.kind", "channel of kind partners to rooms-0, which it"),
    "a route without walls": (
        channelled({"kind": "partners", "from": "rooms", "to": "ways"}, ways=ROUTE),
        "islands.ways.kind", "kind partners that brings ways-0 what it needs, enclosure on cubic, got none",
    ),
    "walls that see a route alone": (
        house() | {"islands": house()["islands"] | {"ways": ROUTE}, "channels": [
            {"kind": "partners", "from": "ways", "to": "walls"}, *house()["channels"][3:],
            {"kind": "partners", "from": ["walls", "rooms"], "to": "ways"},
        ]}, "islands.walls.kind", "brings walls-0 what it needs, space on cubic, got none",
    ),
    "partners of one's own species": (
        channelled({"kind": "partners", "topology": "ring", "among": "walls"}), "channels.4",
        "gives enclosure on cubic to channels of kind partners, and walls-1 ('enclosure'), which takes space on cubic",
    ),
    "another lattice": (
        grown(lattice="isospatial"), "channels.2", "which takes space on isospatial or route on isospatial"
    ),
    "an outline that crosses itself": (
        grown(site={"outline": [[0, 0], [2, 2], [2, 0], [0, 2]]}),
        "growth.site.outline",
        "side 1 ([0, 0] to [2, 2]) meets side 3",
    ),
    "a site of fewer cells than a room has": (
        grown(least=27, site={"outline": [[-1, -1], [1, -1], [1, 1], [-1, 1]], "floors": 2}),
        "growth.site",
        "expected a site that holds the 27 cells of 'least', got one of 18 cells",
    ),
    "more cells at least than at most": (
        grown(least=500, max_blocks=300),
        "growth.least",
        "got 500, more than the 300 of max_blocks",
    ),
    "a site with no cell": (
        grown(site={"outline": [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9]]}), "growth.site.outline", "an outline that holds"
    ),
    "a start outside the site": (
        grown(site={"outline": BOX}, start=[5, 0, 0]), "growth.start", "a cell of the site, got [5, 0, 0]"
    ),
    "a start between cells": (
        grown(lattice="isospatial", start=[1, 0, 0]), "growth", "whose coordinates add up to an even number"
    ),
    "no storeys": (grown(site={"outline": BOX, "floors": 0}), "growth.site.floors", "than or equal to 1, got 0"),
    "a lattice that there is not": (grown(lattice="hexagonal"), "growth.lattice", "'cubic', 'isospatial' or 'square'"),
    "a reading that there is not": (grown(surrounded="rays"), "growth.surrounded", "'flood' or 'visibility'"),
    "a misspelt key of the site": (grown(site={"outlines": BOX}), "growth.site.outlines", "did you mean 'outline'?"),
    "no least volume": (grown(least=0), "growth.least", "greater than or equal to 1, got 0"),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_is_refused_by_check_and_by_run_in_one_line_that_names_the_key(tmp_path, name) -> None:
    data, key, told = CASES[name]
    for line in refused(tmp_path, data):
        assert key in line
        assert told in line


def test_what_is_right_is_taken(tmp_path) -> None:
    assert CliRunner().invoke(main, ["check", str(write(tmp_path, house()))]).exit_code == 0
    within = grown(site={"outline": BOX, "floors": 3, "environment": {"boundaries": []}})
    assert CliRunner().invoke(main, ["check", str(write(tmp_path, within))]).exit_code == 0
    both = channelled({"kind": "partners", "from": ["rooms", "walls"], "to": "ways"}, ways=ROUTE)
    result = CliRunner().invoke(main, ["check", str(write(tmp_path, both))])
    assert result.exit_code == 0, result.stderr


EXPERIMENTS = Path(__file__).resolve().parents[2] / "experiments"


@pytest.mark.parametrize("name", ["enclosure_space", "isospatial", "jackson", "parasite", "route"])
def test_the_shipped_experiments_are_right(name) -> None:
    result = CliRunner().invoke(main, ["check", str(EXPERIMENTS / f"{name}.yaml")])
    assert result.exit_code == 0, result.stderr
