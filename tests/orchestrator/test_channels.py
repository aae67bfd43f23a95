"""Channels of an experiment: what they may say, what they become, and what each mistake is told."""

from __future__ import annotations

import copy

import networkx as nx
import pytest
from plugged import install
from traders import trading

from experiments import bits, write
from genome.errors import InputError
from islands.migration.channel import Pairing, Trigger
from islands.migration.routes import Redrawn
from orchestrator.loading import load_experiment
from orchestrator.plan import Plan, host_plans
from orchestrator.run import prepare

ISLANDS = {"north": {"count": 3}, "south": {"count": 3}, "east": {}}


def planned(tmp_path, *channels: dict, islands: dict | None = None, **changes) -> Plan:
    """The plan of an experiment of seven islands, with those that are on no channel put on one."""
    rest = {"topology": "unconnected", "name": "rest"}
    data = bits(islands=ISLANDS if islands is None else islands, channels=[*channels, rest], **changes)
    return prepare(load_experiment(write(tmp_path, data)))[0]


def pairs(plan: Plan) -> list[tuple[str, str]]:
    return [(edge.source_name, edge.target_name) for edge in plan.edges]


def test_groups_join_all_to_all_or_one_to_one(tmp_path) -> None:
    norths, souths = [f"north-{n}" for n in range(3)], [f"south-{n}" for n in range(3)]
    assert pairs(planned(tmp_path, {"from": "north", "to": "south"})) == [(a, b) for a in norths for b in souths]
    matching = planned(tmp_path, {"from": "north", "to": "south", "join": "matching"})
    assert pairs(matching) == list(zip(norths, souths, strict=True))
    assert pairs(planned(tmp_path, {"from": "north", "to": "east"})) == [(a, "east") for a in norths]
    assert pairs(planned(tmp_path, {"from": ["east", "north-1"], "to": "north-1"})) == [("east", "north-1")]
    within = planned(tmp_path, {"from": "north", "to": "north"})
    assert pairs(within) == [(a, b) for a in norths for b in norths if a != b]


def test_a_topology_lies_on_its_members_in_the_order_of_among(tmp_path) -> None:
    plan = planned(tmp_path, {"topology": "line", "among": ["east", "south-1", "north-2"]})
    assert set(pairs(plan)) == {
        ("east", "south-1"), ("south-1", "east"), ("south-1", "north-2"), ("north-2", "south-1"),
    }  # fmt: skip
    numbers = [(edge.source, edge.target) for edge in plan.edges]
    assert numbers == sorted(numbers)


def test_every_key_arrives_where_islands_look_for_it(tmp_path) -> None:
    channel = {
        "topology": "ring", "every": 3, "rate": 0.25, "select": "roulette", "tournament": 5, "replace": "oldest",
        "accept": "better", "mode": "move", "routing": "point", "weight": 0.5, "trigger": {"diversity": 0.2},
    }  # fmt: skip
    edge = planned(tmp_path, channel).edges[0]
    assert edge.weight == 0.5
    found = edge.channel
    assert (found.number, found.name, found.kind) == (0, "migrants-0", "migrants")
    assert (found.every, found.rate, found.select, found.tournament) == (3, 0.25, "roulette", 5)
    assert (found.replace, found.accept, found.move, found.routing) == ("oldest", "better", True, "point")
    assert found.trigger == Trigger(diversity=0.2)
    assert found.pairing is None


def test_a_trigger_in_generations_is_an_interval(tmp_path) -> None:
    plan = planned(tmp_path, {"topology": "ring", "trigger": {"generations": 12}})
    assert {edge.channel.every for edge in plan.edges} == {4}
    assert {edge.channel.trigger for edge in plan.edges} == {None}
    still = planned(tmp_path, {"topology": "ring", "trigger": {"stagnation": 12}})
    assert {edge.channel.trigger for edge in still.edges} == {Trigger(stagnation=12)}


def test_weights_stand_on_edges(tmp_path) -> None:
    edges = {"name": "edges", "edges": [["north-0", "east", 0.25], ["east", 0]]}
    plan = planned(tmp_path, {"topology": edges, "weight": 0.75, "unreached": "allow"})
    assert {(edge.source_name, edge.target_name): edge.weight for edge in plan.edges} == {
        ("north-0", "east"): 0.25,
        ("east", "north-0"): 0.75,
    }


def test_the_trades_of_species(tmp_path) -> None:
    plan, _ = prepare(load_experiment(write(tmp_path, trading())))
    channels = {edge.channel.number: edge.channel for edge in plan.edges}
    assert channels[1].pairing == Pairing("several", 3, "mean", 0)
    assert channels[2].pairing == Pairing("best", 1, "mean", 0)
    assert (channels[3].count, channels[3].keep) == (3, 4)
    assert [channel.kind for channel in channels.values()] == [
        "migrants", "partners", "partners", "components", "surroundings", "migrants", "surroundings",
    ]  # fmt: skip
    assert [edge.adapter for edge in plan.edges if edge.channel.number >= 4] == ["", "traders:Shorten", ""]


def test_resolved_channels_resolve_to_themselves_and_tell_their_defaults(tmp_path) -> None:
    data = trading()
    data["channels"] += [
        {"topology": {"name": "torus"}, "among": ["host", "guest"], "kind": "partners"},
        {"topology": {"name": "watts_strogatz", "neighbours": 2}, "among": "host", "trigger": {"generations": 4}},
    ]
    data["islands"]["host"]["count"] = 4
    data["channels"][2] |= {"join": "all"}
    data["islands"]["guest"]["species"] = data["islands"]["host"]["species"] = "people"
    data["islands"]["guest"]["kind"] = "traders:NeedyKind"
    data["channels"][-2]["among"] = ["host", "guest"]
    loaded = load_experiment(write(tmp_path, data))
    plan, _ = prepare(loaded)
    again = load_experiment(write(tmp_path, loaded.data(), "again.yaml"))
    assert again.experiment == loaded.experiment
    assert again.data() == loaded.data()
    assert prepare(again)[0].edges == plan.edges
    told = loaded.data()["channels"]
    assert told[0] == {
        "kind": "migrants", "topology": "ring", "among": "host", "unreached": "refuse", "every": 1, "since": 0,
        "count": 2, "select": "best", "tournament": 2, "routing": "broadcast", "weight": 1.0, "replace": "worst",
        "accept": "always", "mode": "copy",
    }  # fmt: skip
    assert told[1].keys() & {"replace", "accept", "mode", "keep", "unreached"} == set()
    assert (told[1]["pairing"], told[1]["score"], told[1]["archive"]) == ("several", "mean", 0)
    assert told[-2]["topology"] == "torus"
    assert told[-1]["topology"] == {"name": "watts_strogatz", "neighbours": 2, "rewiring": 0.1}
    assert (told[-1]["every"], "trigger" in told[-1]) == (2, False)


def test_a_random_topology_is_drawn_by_islands_and_hosts_themselves(tmp_path) -> None:
    channel = {"topology": {"name": "random", "degree": 2}, "among": ["south", "north"], "weight": 0.5}
    plan = planned(tmp_path, channel)
    assert plan.edges == ()
    (redrawn,) = plan.redrawn
    assert redrawn == Redrawn(redrawn.channel, tuple(enumerate(
        ["north-0", "north-1", "north-2", "south-0", "south-1", "south-2"])), 2, 0.5, "")  # fmt: skip
    assert all(len({edge.target for edge in redrawn.edges(7, 3) if edge.source == n}) == 2 for n in range(6))


def test_a_random_topology_adapts_between_species_alone(tmp_path) -> None:
    islands = {"north": {"count": 2}, "long": {"count": 2, "genome": {"length": 40}}}
    channel = {"topology": {"name": "random", "degree": 3}, "adapter": "traders:Shorten"}
    (redrawn,) = planned(tmp_path, channel, islands=islands).redrawn
    for edge in redrawn.edges(7, 1):
        assert bool(edge.adapter) == (edge.source_name.split("-")[0] != edge.target_name.split("-")[0])
    assert "channels.0.adapter: expected an adapter, got 'shrink'" in broken(
        tmp_path, {**channel, "adapter": "shrink"}, islands=islands
    )


@pytest.mark.parametrize("name", ["ring", "torus", "hypercube", "random", "wheel", "watts_strogatz", "barabasi_albert"])
def test_one_island_is_no_mistake_but_noted(tmp_path, name) -> None:
    data = bits(islands={"north": {"count": 4}}, channels=[{"topology": name, "among": "north"}])
    path = write(tmp_path, data)
    loaded = load_experiment(path, ["islands.north.count=1"])
    assert loaded.notes == (f"channels.0: topology {name} of one island, north, carries nothing",)
    plan, _ = prepare(loaded)
    assert plan.edges == plan.redrawn == ()
    if name not in ("wheel", "watts_strogatz"):
        assert load_experiment(path).notes == ()


def test_hosts_know_the_islands_that_adapters_translate_from(tmp_path) -> None:
    loaded = load_experiment(write(tmp_path, trading()))
    plan, _ = prepare(loaded)
    hosts = host_plans(loaded, plan, 8, "run", tmp_path)
    assert [[spec.name for spec in host.foreign] for host in hosts] == [[]] * 7 + [["long"]]
    assert [[spec.name for spec in host.foreign] for host in host_plans(loaded, plan, 1, "run", tmp_path)] == [[]]


def test_a_channel_within_a_species_has_no_use_for_its_adapter(tmp_path) -> None:
    islands = {"north": {"count": 2}, "long": {"genome": {"length": 40}}}
    plan = planned(tmp_path, {"topology": "complete", "adapter": "traders:Shorten"}, islands=islands)
    adapters = {(edge.source_name, edge.target_name): edge.adapter for edge in plan.edges}
    assert {pair for pair, adapter in adapters.items() if not adapter} == {
        ("north-0", "north-1"),
        ("north-1", "north-0"),
    }


def broken(tmp_path, *channels: dict, **changes) -> str:
    with pytest.raises(InputError) as caught:
        planned(tmp_path, *channels, **changes)
    return str(caught.value).split(": ", 1)[1]


TO_EAST = {"from": "north", "to": "east"}
MISTAKES = [
    ({"rate": 1.5}, "channels.0.rate: expected less than or equal to 1, got 1.5"),
    ({"rate": 0}, "channels.0.rate: expected greater than 0, got 0"),
    ({"rate": 0.5, "count": 1}, "channels.0.rate: expected either 'count' or 'rate', got both; remove one of them"),
    ({"every": 0}, "channels.0.every: expected greater than or equal to 1, got 0"),
    ({"every": 1.5}, "channels.0.every: expected a whole number, got 1.5"),
    ({"weight": -0.1}, "channels.0.weight: expected greater than or equal to 0, got -0.1"),
    ({"weight": True}, "channels.0.weight: expected a number, got True"),
    ({"routing": "multicast"}, "channels.0.routing: expected 'broadcast' or 'point', got 'multicast'"),
    ({"mode": "swap"}, "channels.0.mode: expected 'copy' or 'move', got 'swap'"),
    ({"kinds": "x"}, "channels.0.kinds: expected a known key, got 'kinds'; did you mean 'kind'?"),
    ({"pairing": "best"}, "channels.0.pairing: expected 'pairing' on a channel of kind partners alone, got 'pairing'"),
    ({"archive": 3}, "channels.0.archive: expected 'archive' on a channel of kind partners alone"),
    ({"keep": 3}, "channels.0.keep: expected 'keep' on a channel of kind components alone"),
    ({"kind": "partners", "replace": "worst"}, "channels.0.replace: expected 'replace' on a channel of kind migrants"),
    ({"kind": "partners", "mode": "copy"}, "channels.0.mode: expected 'mode' on a channel of kind migrants alone"),
    ({"kind": "surroundings", "score": "mean"}, "channels.0.score: expected 'score' on a channel of kind partners"),
    ({"trigger": {}}, "channels.0.trigger: expected one of 'generations', 'stagnation' and 'diversity', got none"),
    ({"trigger": {"stagnation": 3, "diversity": 0.1}}, "trigger: expected one of 'generations', 'stagnation' and 'div"),
    ({"trigger": {"diversity": 1.2}}, "channels.0.trigger.diversity: expected less than or equal to 1, got 1.2"),
    ({"trigger": {"generations": 4}}, "trigger.generations: expected a multiple of the epoch's 3 generations, got 4;"),
    ({"trigger": {"generations": 2}}, "got 2; take 3: migrants travel at the end of epochs"),
    ({"trigger": {"generations": 3}, "every": 1}, "channels.0.trigger.generations: expected either 'every' or 'trigge"),
    ({"kind": "partners", "pairings": 2}, "channels.0.pairings: expected 1 with pairing: best, got 2"),
    ({"kind": "partners", "pairing": "archive"}, "channels.0.archive: expected an archive of 1 or more for pairing: a"),
    ({"kind": "partners", "pairing": "archive", "pairings": 5, "archive": 3}, "expected an archive of 4 or more"),
    ({"kind": "components", "count": 4, "keep": 3}, "channels.0.keep: expected at least the 4 that arrive at a time"),
    ({"count": 13}, "channels.0.count: expected at most a deme's members, got 13, more than the 12 members of north-0"),
    ({"mode": "move", "count": 12}, "channels.0.mode: expected at most 11 that move from north-0 at a time, so that"),
]  # fmt: skip


@pytest.mark.parametrize(("keys", "message"), MISTAKES)
def test_each_mistake_names_its_key(tmp_path, keys, message) -> None:
    assert message in broken(tmp_path, {**TO_EAST, **keys})


TOPOLOGY_MISTAKES = [
    ({"topology": "ring", "join": "all"}, "channels.0.join: expected 'join' with 'from' and 'to' alone, got 'join' wi"),
    ({**TO_EAST, "unreached": "allow"}, "channels.0.unreached: expected 'unreached' with 'topology' alone"),
    ({"from": "east", "to": "east"}, "channels.0.to: expected two islands, got 'east' twice; a channel to itself"),
    ({"from": "north", "to": "north", "join": "matching"}, "channels.0.to: expected two islands, got 'north-0' twice"),
    ({"from": "north", "to": "east", "join": "matching"}, "channels.0.join: expected as many islands in 'from' as in"),
    ({"from": "nort", "to": "east"}, "channels.0.from: expected an island of the experiment, got 'nort'; did you"),
    ({"from": ["north", 3], "to": "east"}, "channels.0.from: expected an island's name or a list of names"),
    ({"topology": {"name": "random", "degree": 7}}, "channels.0.topology.degree: expected at most 6 for 7 islands, go"),
    ({"topology": {"name": "edges", "edges": [["east", "east"]]}}, "channels.0.topology.edges.0: expected two islands"),
    ({"topology": "graph"}, "channels.0.topology.file: expected a value for 'file', got nothing"),
    ({"topology": "bits:pairs"}, "topology: expected a topology that reaches each of its islands, got none of its edg"),
    ({"topology": {"name": "edges", "edges": [["east", 1], [1, "east", 0]]}, "among": ["east", "north-0"]},
     "channels.0.topology: expected a topology that reaches each of its islands, got none of its edges to east; add"),
    ({"topology": "complete", "mode": "move", "count": 2}, "channels.0.mode: expected at most 11 that move from north"),
    ({"topology": {"name": "random", "degree": 6}, "mode": "move", "count": 2}, "got 12; lower 'count', take mode: co"),
]  # fmt: skip


@pytest.mark.parametrize(("channel", "message"), TOPOLOGY_MISTAKES)
def test_each_mistake_of_who_is_joined_names_its_key(tmp_path, channel, message) -> None:
    assert message in broken(tmp_path, channel)


def test_what_moves_by_one_edge_at_a_time_leaves_enough(tmp_path) -> None:
    planned(tmp_path, {"topology": "complete", "mode": "move", "count": 2, "routing": "point"})
    told = broken(tmp_path, *[{"topology": "ring", "mode": "move", "count": 6} for _ in range(2)])
    assert told.startswith("channels.1.mode: expected at most 11 that move from north-0 at a time")


def test_an_edge_of_another_channel_of_the_kind_reaches_as_well(tmp_path) -> None:
    pair = {"among": ["east", "north-0"], "topology": {"name": "edges", "edges": [["east", "north-0"]]}}
    assert "none of its edges to east" in broken(tmp_path, pair)
    planned(tmp_path, pair, {"from": "south-1", "to": "east"})
    planned(tmp_path, {**pair, "unreached": "allow"})
    planned(tmp_path, pair, {"topology": "random"})


def test_an_island_on_no_channel_is_refused_where_there_are_some(tmp_path) -> None:
    data = bits(channels=[{"topology": "ring", "among": "north"}])
    with pytest.raises(InputError, match=r"channels: expected islands that are each on a channel, got south, which is"):
        prepare(load_experiment(write(tmp_path, data)))
    data["channels"].append({"topology": "unconnected", "among": "south"})
    prepare(load_experiment(write(tmp_path, data)))
    prepare(load_experiment(write(tmp_path, bits(channels=[]))))


def changed(path: str, value: object) -> dict:
    data = copy.deepcopy(trading())
    here = data
    *parts, last = [int(part) if part.isdecimal() else part for part in path.split(".")]
    for part in parts:
        here = here[part]
    here[last] = value
    return data


STRANGERS = [
    ("channels.5", {"from": "long", "to": "short"}, "channels.5: expected islands of one species, got long (bits-",
     "whose genomes differ in length (16, 12)"),
    ("channels.5", {"from": "long", "to": "skin"}, "of the kinds 'bits' and 'skin'", "migrants travel within a specie"),
    ("channels.5.to", "skin", "channels.5.adapter: expected an adapter to the kind 'skin' of island skin, got", "trad"),
    ("channels.5.adapter", "traders:NeedyKind", "channels.5.adapter: expected an adapter, got 'traders:NeedyKind'", ""),
    ("channels.5.adapter", "shrink", "channels.5.adapter: expected an adapter, got 'shrink'", ""),
    ("islands.long.genome", {"length": 101}, "channels.5.adapter: expected a source of at most 100 bits, got 101", ""),
    ("channels.1.from", "skin", "channels.1: expected islands of which one gives partners that the other takes, got sk",
     "which gives nothing to channels of kind partners, and host-0 ('traders:NeedyKind'), which takes word"),
    ("channels.3.to", "skin", "which gives part to channels of kind components, and skin ('traders:SkinKind'), which t",
     "nothing"),
    ("channels.1.pairings", 5, "channels.1.pairings: expected at most 4, as many as are shown to host-0, got 5", ""),
    ("channels.1.kind", "components", "channels.1.pairing: expected 'pairing' on a channel of kind partners alone", ""),
    ("channels.1", {"topology": "unconnected", "among": "host"},
     "islands.host.kind: expected a channel of kind partners to host-0, which it needs",
     "partners missing: add {kind: partners, from: ..., to: host} to 'channels'"),
]  # fmt: skip


@pytest.mark.parametrize(("path", "value", "message", "more"), STRANGERS)
def test_strangers_are_told_why_they_have_nothing_to_exchange(tmp_path, path, value, message, more) -> None:
    with pytest.raises(InputError) as caught:
        prepare(load_experiment(write(tmp_path, changed(path, value))))
    assert message in str(caught.value)
    assert more in str(caught.value)


def test_a_species_of_one_name_is_of_one_kind(tmp_path) -> None:
    data = trading()
    for name in ("short", "skin"):
        data["islands"][name]["species"] = "folk"
    data["channels"].append({"from": "short", "to": "skin"})
    with pytest.raises(InputError, match=r"channels\.7: expected islands of one kind in a species, got short"):
        prepare(load_experiment(write(tmp_path, data)))
    data = bits(islands={"a": {"species": "x"}, "b": {"species": "y"}}, channels=[{"topology": "ring"}])
    with pytest.raises(InputError, match="whose genomes are alike: they differ by 'species' alone"):
        prepare(load_experiment(write(tmp_path, data)))


def test_adapters_that_would_do_are_named(tmp_path, monkeypatch) -> None:
    install(tmp_path, monkeypatch, "atoll.adapters", shorten="traders:Shorten", broken="nowhere:X")
    data = changed("channels.5", {"from": "long", "to": "short"})
    with pytest.raises(InputError, match=r"or set adapter: (resize or )?shorten$"):
        prepare(load_experiment(write(tmp_path, data)))
    data["channels"][5]["adapter"] = "shorten"
    prepare(load_experiment(write(tmp_path, data)))


def test_drawn_graphs_of_a_plan_follow_from_the_run_s_seed(tmp_path) -> None:
    def drawn(seed: int) -> list[tuple[str, str]]:
        return pairs(planned(tmp_path, {"topology": "erdos_renyi"}, seed=seed))

    assert drawn(1) == drawn(1) != drawn(2)
    assert nx.is_strongly_connected(nx.DiGraph(drawn(1)))
