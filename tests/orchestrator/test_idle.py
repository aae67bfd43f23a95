"""Channels that never carry: refused where that is what the file says, noted where the run is too short for them."""

from __future__ import annotations

import pytest

from experiments import bits, run, write
from genome.errors import InputError
from orchestrator.folder import open_run
from orchestrator.loading import load_experiment
from orchestrator.query import ask
from orchestrator.run import prepare

EDGES = {"name": "edges", "edges": [["north-0", "north-1", 0], ["north-1", "north-0", 0]]}


@pytest.mark.parametrize("channel", [{"topology": "ring"}, {"topology": "random"}, {"from": "north", "to": "south"}])
def test_a_weight_of_nothing_is_refused(tmp_path, channel) -> None:
    with pytest.raises(InputError, match=r"channels\.0\.weight: expected a probability above 0, got 0, by which it ne"):
        load_experiment(write(tmp_path, bits(channels=[{**channel, "weight": 0}])))


def test_edges_that_weigh_nothing_are_refused_even_where_members_may_be_unreached(tmp_path) -> None:
    data = bits(channels=[{"topology": EDGES, "unreached": "allow"}])
    with pytest.raises(InputError, match=r"channels\.0\.topology: expected an edge with a weight above 0, got 0 on ea"):
        prepare(load_experiment(write(tmp_path, data)))


def notes(tmp_path, channel: dict, *overrides: str, **changes) -> tuple[str, ...]:
    return load_experiment(write(tmp_path, bits(channels=[channel], **changes)), overrides).notes


def arrivals(tmp_path, channel: dict, *overrides: str) -> int:
    """How many migrants such a run sees."""
    found = open_run(str(run(tmp_path, bits(channels=[channel]), *overrides).folder))
    return int(ask(found.log, "select count(*) from migrations").rows[0][0])


@pytest.mark.parametrize("every", [1, 2, 3])
@pytest.mark.parametrize("epochs", [1, 2, 3, 4])
def test_a_run_too_short_for_a_channel_is_noted_just_where_nothing_arrives(tmp_path, every, epochs) -> None:
    channel = {"topology": "ring", "every": every}
    late = (
        f"channels.0: what it first carries, at the end of epoch {every}, comes too late for a run of {epochs} epochs"
    )
    told = notes(tmp_path, channel, f"epochs={epochs}")
    assert told in ((), (late,))
    assert bool(told) == (arrivals(tmp_path, channel, f"epochs={epochs}") == 0)


def test_what_travels_at_the_end_of_epoch_nothing_is_never_late(tmp_path) -> None:
    from traders import trading

    data = trading(epochs=1)
    data["channels"][1]["every"] = 9
    told = load_experiment(write(tmp_path, data)).notes
    assert [note.partition(":")[0] for note in told] == ["channels.0", "channels.5"]


@pytest.mark.parametrize(("stagnation", "noted"), [(9, False), (10, True)])
def test_a_stagnation_longer_than_the_run_is_noted(tmp_path, stagnation, noted) -> None:
    # Four epochs of three generations: what leaves after nine comes to something, what leaves after twelve does not.
    channel = {"topology": "ring", "trigger": {"stagnation": stagnation}}
    late = f"channels.0: a stagnation of {stagnation} generations comes too late: it carries for the last time after 9"
    assert notes(tmp_path, channel) == ((late,) if noted else ())
    assert notes(tmp_path, {**channel, "every": 2})[0].endswith("for the last time after 6")


def test_a_deme_of_one_has_no_diversity(tmp_path) -> None:
    channel = {"from": "north", "to": "south", "trigger": {"diversity": 0.5}}
    islands = {"north": {"count": 6, "population": 1, "algorithm": {"elite": 0}}, "south": {}}
    told = "channels.0: a deme of one has no diversity, so these never send: north-0, north-1, north-2, north-3, ..."
    assert notes(tmp_path, channel, islands=islands) == (told,)
    assert notes(tmp_path, {**channel, "from": "south", "to": "north"}, islands=islands) == ()
    ring = {"topology": "ring", "trigger": {"diversity": 0.5}}
    assert notes(tmp_path, ring, "islands.north.count=1", islands=islands) == (
        "channels.0: a deme of one has no diversity, so these never send: north",
    )


def test_a_run_of_no_epochs_and_islands_alone_on_purpose_need_no_note(tmp_path) -> None:
    assert notes(tmp_path, {"topology": "ring"}, "epochs=0") == ()
    assert notes(tmp_path, {"topology": "unconnected", "every": 9}) == ()


@pytest.mark.parametrize(("key", "names"), [
    ("among", ["north", "north-1"]), ("among", ["south", "south"]), ("from", ["north-1", "north"]),
    ("to", ["south", "south"]),
])  # fmt: skip
def test_islands_named_twice_are_refused(tmp_path, key, names) -> None:
    channel = {"topology": "ring"} if key == "among" else {"from": "south", "to": "north"}
    data = bits(channels=[{**channel, key: names}])
    with pytest.raises(
        InputError, match=rf"channels\.0\.{key}: expected islands or groups, each once, got \S+ twice, as"
    ):
        prepare(load_experiment(write(tmp_path, data)))
