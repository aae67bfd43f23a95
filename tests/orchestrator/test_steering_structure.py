"""Islands and channels that come and go: their numbers, their spans, and what a run makes of them."""

from __future__ import annotations

from pathlib import Path

import pytest
from rooms import house
from steered import Steered

from experiments import bits, write
from genome.errors import InputError
from islands.individual import home_of
from orchestrator.loading import load_experiment
from orchestrator.plan import make_plan
from orchestrator.steering.checks import checked
from orchestrator.steering.command import Command
from orchestrator.steering.language import Words, read
from orchestrator.steering.restructuring import replayed
from orchestrator.steering.structure import Structure, structure_of


@pytest.fixture
def begun(tmp_path: Path) -> Structure:
    return structure_of(load_experiment(write(tmp_path, bits())))


def command(structure: Structure, epoch: int, verb: str, *words: str, number: int = 0, **options) -> Command:
    request = checked(read(verb, Words(words, **options)), structure, epoch)
    return Command(number, "", verb, request.arguments, epoch, "somebody")


def after(structure: Structure, *lines: tuple[int, str, str]) -> Structure:
    for epoch, verb, word in lines:
        like = {"like": "north"} if verb == "add-island" else {}
        structure = replayed(structure, [command(structure, epoch, verb, word, **like)])
    return structure


def test_a_run_that_nobody_steers_has_the_plan_of_its_experiment(tmp_path, begun) -> None:
    assert begun.plan() == make_plan(load_experiment(tmp_path / "bits.yaml"))


def test_what_is_added_comes_last_and_leaves_all_else_as_it_was(begun) -> None:
    before = begun.plan()
    plan = after(begun, (3, "add-island", "west"), (4, "connect", "{topology: ring, among: [west, south]}")).plan()
    assert plan.islands[:4] == before.islands
    (west,) = plan.islands[4:]
    assert (west.name, west.number, west.since, west.until) == ("west", 4, 3, None)
    assert plan.edges[: len(before.edges)] == before.edges
    new = plan.edges[len(before.edges) :]
    assert [(edge.channel.number, edge.channel.name) for edge in new] == [(2, "migrants-2")] * 2
    assert [(edge.source, edge.target, edge.since, edge.until) for edge in new] == [(3, 4, 4, None), (4, 3, 4, None)]


def test_what_is_removed_ends_and_keeps_its_number(begun) -> None:
    structure = after(begun, (3, "remove-island", "north-1"), (5, "disconnect", "migrants-1"))
    plan = structure.plan()
    assert [(spec.name, spec.until) for spec in plan.islands] == [
        ("north-0", None), ("north-1", 3), ("north-2", None), ("south", None)
    ]  # fmt: skip
    ends = {(edge.channel.number, edge.source, edge.target): edge.until for edge in plan.edges}
    assert ends == {(0, 0, 1): 3, (0, 1, 2): 3, (0, 2, 3): None, (0, 3, 0): None, (1, 3, 1): 3}
    assert structure.channel_names(4) == {"migrants-0": 0, "migrants-1": 1}
    assert structure.channel_names(5) == {"migrants-0": 0}
    again = after(structure, (6, "add-island", "east"))
    assert again.plan().islands[4].number == 4
    assert [spec.name for spec in again.living(6)] == ["north-0", "north-2", "south", "east"]


def test_a_group_is_removed_as_a_whole_and_named_for_those_who_are_left(begun) -> None:
    structure = after(begun, (3, "remove-island", "north-1"), (4, "connect", "{topology: complete, among: north}"))
    new = [edge for edge in structure.plan().edges if edge.channel.number == 2]
    assert [(edge.source, edge.target) for edge in new] == [(0, 2), (2, 0)]
    gone = after(structure, (5, "remove-island", "north"))
    assert [spec.until for spec in gone.islands()] == [5, 3, 5, None]
    everywhere = after(begun, (3, "remove-island", "south"), (4, "connect", "{topology: ring}"))
    assert {edge.source for edge in everywhere.plan().edges if edge.channel.number == 2} == {0, 1, 2}


def test_edges_drawn_anew_are_drawn_among_those_who_are_left(tmp_path) -> None:
    data = bits(channels=[{"topology": {"name": "random", "degree": 3}}])
    begun = structure_of(load_experiment(write(tmp_path, data)))
    parts = after(begun, (3, "remove-island", "north-1"), (6, "disconnect", "migrants-0")).plan().redrawn
    assert [(len(part.members), part.degree, part.since, part.until) for part in parts] == [(4, 3, 0, 3), (3, 2, 3, 6)]
    alone = after(begun, (3, "remove-island", "north")).plan().redrawn
    assert [(len(part.members), part.until) for part in alone] == [(4, 3)]


@pytest.mark.parametrize(
    ("earlier", "line", "message"),
    [
        ([], ("connect", "{from: north-0, to: wets}"), "connect: to: expected an island of the run, got 'wets'"),
        ([(2, "remove-island", "south")], ("connect", "{from: north-0, to: south}"), "connect: to: expected an island"),
        ([], ("connect", "{from: north-0, to: south, name: migrants-1}"), "connect: name: expected a name that no"),
        ([], ("connect", "{from: north-0, to: south, count: 10}"), "connect: count: expected at most a deme's members"),
        ([], ("connect", "{from: north-0, to: south, cuont: 1}"), "connect: cuont: expected a known key, got 'cuont'"),
        ([], ("connect", "{topology: rnig}"), "connect: topology: expected a topology, got 'rnig'"),
        ([], ("connect", "{from: north-0, to: south, keep: 3}"), "connect: keep: expected 'keep' on a channel"),
        ([], ("connect", "{from: north, to: south, mode: move, count: 9, kind: migrants}"), None),
        ([(2, "disconnect", "migrants-0")], ("disconnect", "migrants-0"), "disconnect: expected a channel of the run"),
        ([], ("remove-island", "north-9"), "steer remove-island: expected an island of the run, got 'north-9'"),
        ([(2, "remove-island", "north")], ("remove-island", "south"), "remove-island: expected an island that is left"),
    ],
)
def test_what_cannot_be_is_told_with_the_command_as_its_place(begun, earlier, line, message) -> None:
    structure = after(begun, *earlier)
    if message is None:
        assert after(structure, (3, *line)) != structure
        return
    with pytest.raises(InputError) as caught:
        after(structure, (3, *line))
    assert str(caught.value).startswith(message)


def test_channels_that_together_would_empty_an_island_are_refused(begun) -> None:
    moves = "{from: south, to: north-0, mode: move, count: 5}"
    once = after(begun, (3, "connect", moves))
    with pytest.raises(InputError, match="connect: mode: expected at most 8 that move from south at a time"):
        after(once, (4, "connect", moves))
    assert after(once, (4, "disconnect", "migrants-2"), (5, "connect", moves)) != once


def test_an_island_keeps_the_channel_that_its_kind_needs(tmp_path) -> None:
    kinds = {"kind": "bits", "population": 8, "fitness": {"agreement": {"goal": "maximise"}}}
    data = bits(
        defaults=kinds,
        islands={"a": {"species": "a"}, "b": {"species": "b"}},
        channels=[{"kind": "partners", "from": one, "to": other, "name": one} for one, other in ("ab", "ba")],
    )
    begun = structure_of(load_experiment(write(tmp_path, data)))
    with pytest.raises(InputError, match="steer: expected a channel of kind partners to b, which it needs, got none"):
        after(begun, (3, "disconnect", "a"))
    other = after(begun, (3, "connect", "{kind: partners, from: a, to: b, name: more}"), (3, "disconnect", "a"))
    assert other.channel_names(3) == {"b": 1, "more": 2}
    new = replayed(begun, [command(begun, 3, "add-island", "c", like="a")])
    assert len(new.living(3)) == 3, "one that is new is not connected yet"


def test_an_island_keeps_the_channel_that_brings_what_its_kind_needs(tmp_path) -> None:
    data = house()
    data["islands"]["ways"] = {"kind": "route", "count": 1, "fitness": {"route": {"goal": "maximise"}}}
    ways = [("rooms", "ways"), ("walls", "ways")]
    data["channels"] += [{"kind": "partners", "from": one, "to": other, "name": one} for one, other in ways]
    begun = structure_of(load_experiment(write(tmp_path, data)))
    for gone, missing in (("rooms", "space"), ("walls", "enclosure")):
        told = (
            f"steer: expected a channel of kind partners that brings ways what it needs, {missing} on cubic, got none"
        )
        with pytest.raises(InputError, match=told):
            after(begun, (3, "disconnect", gone))
    connect = (3, "connect", "{kind: partners, from: rooms-0, to: ways, name: more}")
    other = after(begun, connect, (3, "disconnect", "rooms"))
    assert "more" in other.channel_names(3)


def test_a_run_whose_structure_changes_goes_as_one_that_knew_of_it_from_the_start(begun) -> None:
    """Hosts that are made anew with the whole plan, as after a crash, step as those that learnt of it on the way."""
    lines = [
        (2, "add-island", "west"),
        (3, "connect", "{from: [north-0, south], to: west, count: 2}"),
        (3, "connect", "{from: west, to: south, replace: random}"),
        (4, "disconnect", "migrants-0"),
        (5, "remove-island", "north-1"),
    ]
    learning, structure = Steered(begun.plan(), 7), begun
    for epoch in range(8):
        for line in lines:
            if line[0] == epoch:
                structure = after(structure, line)
        learning.remake(structure.plan())
        learning.step()
    knowing = Steered(structure.plan(), 7)
    undisturbed = Steered(begun.plan(), 7)
    for _ in range(8):
        knowing.step()
        undisturbed.step()
    assert learning.born() == knowing.born()
    assert learning.states == knowing.states
    steered, plain = knowing.born(), undisturbed.born()
    for (number, epoch), rows in plain.items():
        if epoch < 4 and number < 3:
            assert steered[number, epoch] == rows, "nothing is otherwise before it takes effect"
    assert sorted(epoch for number, epoch in steered if number == 4) == list(range(2, 8))
    assert sorted(epoch for number, epoch in steered if number == 1) == list(range(5))
    came = {home_of(row.id) for row in knowing.records[4, 4].crossings}
    assert came == {0, 3}
    assert not knowing.records[4, 3].crossings
    assert {row.channel for row in knowing.records[0, 4].crossings} == {"migrants-0"}, "the last ones are taken in"
    assert not knowing.records[0, 5].crossings


def test_a_journal_of_commands_replays(begun) -> None:
    lines = [(2, "add-island", "west"), (3, "connect", "{topology: ring, among: [west, south]}")]
    structure, commands = begun, []
    for number, (epoch, verb, word) in enumerate(lines):
        like = {"like": "north"} if verb == "add-island" else {}
        commands.append(command(structure, epoch, verb, word, number=number, **like))
        structure = replayed(structure, commands[-1:])
    refused = Command(9, "", "remove-island", {"islands": ["north-0"]}, None, "", "no")
    read_back = [Command.from_json(one.to_json()) for one in (*commands, refused)]
    assert replayed(begun, read_back).plan() == structure.plan()
