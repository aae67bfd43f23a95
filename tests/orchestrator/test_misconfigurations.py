"""The misconfigurations that people make: each refused by ``check`` and ``run`` alike, in a line that names the key."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from traders import trading

from experiments import bits, write
from orchestrator.cli import main


def seven(**channel: object) -> str:
    return json.dumps(bits(islands={"north": {"count": 7}}, channels=[channel]), indent=1)


def differing() -> str:
    data = bits()
    data["islands"]["south"]["genome"] = {"length": 16}
    return json.dumps(data, indent=1)


def unreached() -> str:
    return json.dumps(bits(channels=[{"topology": "ring", "among": "north"}]), indent=1)


def without_partners() -> str:
    data = trading()
    data["channels"][1] = {"topology": "unconnected", "among": "host"}
    return json.dumps(data, indent=1)


def into(kind: str, what: str, topology: bool = False) -> str:
    data = trading(islands={"guest": {"kind": "traders:GuestKind"}, "taker": {"kind": f"traders:{kind}", "count": 2}})
    data["channels"] = [{"kind": what, "from": "guest", "to": "taker", "name": "gift"}]
    if topology:
        data["channels"] = [{"kind": what, "topology": "random", "among": ["taker", "guest"], "name": "gift"}]
        data["islands"]["guest"]["kind"] = f"traders:{kind}"
    return json.dumps(data, indent=1)


def partners(sharing: str = "none", topology: object = None, count: int = 2, **channel: object) -> str:
    """Two species of the project's own bits that are worth what they agree; the channel to the second is given."""
    fitness = {"agreement": {"goal": "maximise"}}
    islands = {name: {"species": name, "count": count, "fitness": fitness} for name in ("host", "guest")}
    islands["guest"]["algorithm"] = {"sharing": sharing}
    ends = {"from": "host", "to": "guest"} if topology is None else {"topology": topology, "among": "guest"}
    channels = [{"kind": "partners", "from": "guest", "to": "host"}, {"kind": "partners", **ends, **channel}]
    return json.dumps(bits(defaults={"kind": "bits"}, islands=islands, channels=channels), indent=1)


TWICE = """
islands:
  north: {kind: "bits:BitsKind", fitness: {ones: {goal: maximise}}}
  north: {kind: "bits:BitsKind", fitness: {ones: {goal: maximise}}}
"""
NUMBERED = """
islands:
  north: {kind: "bits:BitsKind", count: 2, fitness: {ones: {goal: maximise}}}
  north-1: {kind: "bits:BitsKind", fitness: {ones: {goal: maximise}}}
"""
LONELY = {"name": "edges", "edges": [[n, n + 1] for n in range(6)]}

CASES = {
    "a channel to itself": (
        json.dumps(bits(channels=[{"from": "south", "to": "south"}]), indent=1), "channels.0.to", "got 'south' twice"
    ),
    "an edge to itself": (
        seven(topology={"name": "edges", "edges": [[0, 1], [2, 2]]}), "channels.0.topology.edges.1", "got '2' twice"
    ),
    "a species mismatch": (differing(), "channels.0", "whose genomes differ in length (32, 16)"),
    "a topology that does not fit": (seven(topology="torus"), "channels.0.topology", "6 (2 x 3) or 8 (2 x 4) islands,"),
    "a hypercube of seven": (seven(topology="hypercube"), "channels.0.topology", "expected 4 or 8 islands, got 7"),
    "a rate over one": (seven(topology="ring", rate=1.01), "channels.0.rate", "less than or equal to 1, got 1.01"),
    "an interval of zero": (seven(topology="ring", every=0), "channels.0.every", "greater than or equal to 1, got 0"),
    "a graph file that is broken": (
        seven(topology={"name": "graph", "file": "broken.graphml"}), "channels.0.topology.file", "line 2: mismatched ta"
    ),
    "a graph file that is missing": (
        seven(topology={"name": "graph", "file": "none.graphml"}), "channels.0.topology.file", "which is not there"
    ),
    "an island that nobody reaches": (
        seven(topology=LONELY), "channels.0.topology", "got none of its edges to north-0; add one, or set unreached: al"
    ),
    "an island on no channel": (unreached(), "channels", "got south, which is on none; name it in 'among', or add"),
    "partners missing": (without_partners(), "islands.host.kind", "partners missing: add {kind: partners"),
    "partners that a kind has no use for": (
        into("HollowKind", "partners"), "islands.taker.kind", "expected a kind with evaluate_with, got 'traders:Hollow"
    ),
    "parts that a kind has no use for": (
        into("HollowKind", "components"), "islands.taker.kind", "whose biology has no supplied; channel 'gift' brings"
    ),
    "parts that a kind cannot tell": (
        into("HalfKind", "components"), "islands.taker.kind", "which takes components and whose biology has no componen"
    ),
    "forms that a kind has no use for": (
        into("HollowKind", "surroundings"), "islands.taker.kind", "expected a kind with surrounded, got"
    ),
    "partners of drawn edges": (
        into("HollowKind", "partners", topology=True), "islands.guest.kind", "expected a kind with evaluate_with, got"
    ),
    "partners from an island to itself": (
        partners(**{"from": "guest-0", "to": "guest-0"}), "channels.1.to", "got 'guest-0' twice; a channel to itself ca"
    ),
    "partners one to one with themselves": (
        partners(**{"from": "guest", "to": "guest", "join": "matching"}), "channels.1.to", "got 'guest-0' twice"
    ),
    "partners on an edge to itself": (
        partners(topology={"name": "edges", "edges": [["guest-0", "guest-1"], ["guest-1", "guest-1"]]}),
        "channels.1.topology.edges.1", "got 'guest-1' twice"
    ),
    "no archive to mix with": (
        partners(pairing="mixed"), "channels.1.archive", "an archive of 1 or more for pairing: mixed with pairin"
    ),
    "an archive too small to mix with": (
        partners(pairing="mixed", pairings=7, archive=2), "channels.1.archive", "archive of 3 or more for pairing: mix"
    ),
    "a mixture of two": (
        partners(pairing="mixed", pairings=2, archive=2), "channels.1.pairings", "expected 3 or more with pairing: mix"
    ),
    "a mixture with too few shown": (
        partners(pairing="mixed", pairings=5, archive=4), "channels.1.pairings",
        "expected at most 2, as many as are shown to guest-0, got 5, of which 3 are with some of those shown; raise 'co"
    ),
    "no archive to measure against": (
        partners(measures=True), "channels.1.measures", "an archive to measure the best against, got none; add archive"
    ),
    "migrants that are measured": (
        seven(topology="ring", measures=True), "channels.0.measures", "'measures' on a channel of kind partners alone"
    ),
    "fitness shared by one pairing": (
        partners("competitive"), "islands.guest.algorithm.sharing", "two or more pairings to share by, got 1 to guest-0"
    ),
    "fitness shared without partners": (
        json.dumps(bits(defaults={"kind": "bits", "fitness": {"ones": {"goal": "maximise"}},
                                  "algorithm": {"sharing": "competitive"}}, islands={"a": {"count": 2}},
                        channels=[{"topology": "ring"}]), indent=1),
        "islands.a.algorithm.sharing", "got no channel of partners to a-0; it is partners that members share: add"
    ),
    "fitness shared by a word": (partners("fair"), "islands.guest.algorithm.sharing", "'none' or 'competitive', got "),
    "two islands of one name": (TWICE, "", "each key once, got 'north' again (line 3)"),
    "two islands of one name by count": (NUMBERED, "islands.north-1", "'north-1', a name that the islands of 'north'"),
}  # fmt: skip


def test_the_project_s_own_kind_needs_partners_where_agreement_is_a_goal(tmp_path) -> None:
    islands = {name: {"kind": "bits", "fitness": {"agreement": {"goal": "maximise"}}} for name in ("a", "b")}
    path = write(tmp_path, bits(defaults={}, islands=islands, channels=[{"kind": "partners", "topology": "ring"}]))
    assert CliRunner().invoke(main, ["check", str(path)]).exit_code == 0
    for channels in ([], [{"topology": "ring"}], [{"kind": "partners", "from": "b", "to": "a"}]):
        path = write(tmp_path, bits(defaults={}, islands=islands, channels=channels))
        result = CliRunner().invoke(main, ["check", str(path)])
        assert result.exit_code == 2
        lacking = "b" if len(channels) and "from" in channels[0] else "a"
        assert (
            f"islands.{lacking}.kind: expected a channel of kind partners to {lacking}, which it needs" in result.stderr
        )


def test_a_circle_of_one_island_brings_it_no_partners(tmp_path) -> None:
    path = tmp_path / "wrong.yaml"
    path.write_text(partners(topology="ring", count=1), encoding="utf-8")
    for arguments in (["check", path], ["run", path, "--runs-dir", tmp_path / "runs"]):
        result = CliRunner().invoke(main, [str(argument) for argument in arguments])
        assert result.exit_code == 2
        assert "islands.guest.kind: expected a channel of kind partners to guest, which it needs, got" in result.stderr


def test_two_islands_of_one_species_may_be_each_other_s_partners(tmp_path) -> None:
    for text in (
        partners(topology="ring"),
        partners(**{"from": "guest", "to": "guest"}),
        partners(topology="complete"),
    ):
        path = tmp_path / "fine.yaml"
        path.write_text(text, encoding="utf-8")
        result = CliRunner().invoke(main, ["check", str(path)])
        assert result.exit_code == 0, result.stderr


@pytest.mark.parametrize("name", CASES)
def test_is_refused_by_check_and_by_run_in_one_line_that_names_the_key(tmp_path, name) -> None:
    text, key, told = CASES[name]
    path = tmp_path / "wrong.yaml"
    path.write_text(text, encoding="utf-8")
    (tmp_path / "broken.graphml").write_text("<graphml>\n</graph>\n", encoding="utf-8")
    before = sorted(tmp_path.iterdir())
    for arguments in (["check", path], ["run", path, "--runs-dir", tmp_path / "runs"]):
        result = CliRunner().invoke(main, [str(argument) for argument in arguments])
        assert result.exit_code == 2, result.output
        assert result.stdout == ""
        (line,) = result.stderr.strip().splitlines()
        assert line.startswith(f"atoll: {path}:")
        assert f": {key}: expected " in line if key else "expected " in line
        assert told in line
        assert sorted(tmp_path.iterdir()) == before


def test_what_is_wrong_by_an_override_is_told_as_such(tmp_path) -> None:
    path = write(tmp_path, bits())
    for override, told in (
        ("channels.0.topology=hypercube", None),
        ("channels.0.topology=torus", None),
        ("channels.0.rate=2", "--set channels.0.rate: expected less than or equal to 1, got 2"),
        ("islands.north.count=2", None),
        (
            "channels.0.topology={name: torus, rows: 3}",
            "--set channels.0.topology.rows: expected rows that divide 4 isl",
        ),
    ):
        result = CliRunner().invoke(main, ["check", str(path), "--set", override, "--set", "channels.1.to=north"])
        assert (result.exit_code == 0) == (told is None), result.stderr
        assert told is None or told in result.stderr


def test_one_island_is_noted_by_check(tmp_path) -> None:
    data = bits(islands={"north": {"count": 4}}, channels=[{"topology": "hypercube"}])
    result = CliRunner().invoke(main, ["check", str(write(tmp_path, data)), "--set", "islands.north.count=1"])
    assert result.exit_code == 0
    assert "topology hypercube of one island, north, carries nothing" in result.stderr
    assert not list(Path(tmp_path).glob("runs"))
