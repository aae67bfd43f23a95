"""The JSON Schema says of channels what the loader says."""

from __future__ import annotations

import jsonschema
import pytest
from traders import trading

from experiments import bits, write
from genome.errors import InputError
from orchestrator.json_schema import experiment_schema
from orchestrator.loading import load_experiment
from orchestrator.topology.registry import TOPOLOGIES

CHANNELS = [
    ({"topology": "ring"}, True),
    ({"topology": {"name": "ring"}}, True),
    ({"topology": {"name": "torus", "rows": 2}}, True),
    ({"topology": {"name": "edges", "edges": [["a", 1], ["a", "b", 0.5]]}}, True),
    ({"topology": {"name": "watts_strogatz", "neighbours": 2, "rewiring": 0.5, "seed": 3}}, True),
    ({"topology": "bits:pairs"}, True),
    ({"from": "north", "to": ["south"], "join": "matching", "rate": 0.5}, True),
    ({"from": "north", "to": "south", "trigger": {"diversity": 0.5}, "mode": "move"}, True),
    ({"from": "north", "to": "south", "kind": "partners", "pairing": "several", "archive": 3}, True),
    ({"topology": {"name": "torus", "row": 2}}, False),
    ({"topology": {"name": "torus", "rows": 1}}, False),
    ({"topology": {"name": "ring", "rows": 1}}, False),
    ({"topology": {"rows": 2}}, False),
    ({"topology": "graph"}, False),
    ({"topology": {"name": "edges", "edges": [["a"]]}}, False),
    ({"topology": {"name": "edges"}}, False),
    ({"from": "north"}, False),
    ({}, False),
    ({"topology": "ring", "count": 1, "rate": 0.5}, False),
    ({"topology": "ring", "rate": 1.5}, False),
    ({"topology": "ring", "pairing": "best"}, False),
    ({"topology": "ring", "kind": "partners", "mode": "move"}, False),
    ({"topology": "ring", "kind": "surroundings", "keep": 3}, False),
]


@pytest.mark.parametrize(("channel", "good"), CHANNELS)
def test_schema_and_loader_agree_on_a_channel(tmp_path, channel, good) -> None:
    data = bits(channels=[channel])
    schema = experiment_schema()
    assert jsonschema.Draft202012Validator(schema).is_valid(data) is good
    if good:
        load_experiment(write(tmp_path, data))
    else:
        with pytest.raises(InputError):
            load_experiment(write(tmp_path, data))


def test_the_schema_is_one_and_takes_what_is_resolved(tmp_path) -> None:
    schema = experiment_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(trading(), schema)
    jsonschema.validate(load_experiment(write(tmp_path, trading())).data(), schema)
    assert schema["$defs"]["ChannelSettings"]["properties"]["topology"]["anyOf"][0]["examples"] == list(TOPOLOGIES)


def test_a_brief_is_described_and_stands_in_the_place_of_islands() -> None:
    schema = experiment_schema()
    brief = {"rooms": {"a": {"cells": 2}}, "zones": {"z": ["a"]}, "adjacencies": [["a", "b", 2.0], ["a", "c"]]}
    valid = jsonschema.Draft202012Validator(schema).is_valid
    assert valid({"brief": {**brief, "site": {"outline": [[0, 0], [1, 0], [0, 1]]}}})
    assert not valid({})
    assert not valid({"brief": {**brief, "rooms": {"a": {"area": 2}}}})
    assert not valid({"brief": {**brief, "adjacencies": [["a"]]}})
