"""What plug-ins raise at a run's start is bad input, told in a line; a Ctrl-C is not."""

from __future__ import annotations

import pytest
from click.testing import CliRunner
from plugged import install

from experiments import bits, write
from genome.errors import InputError
from orchestrator.cli import main
from orchestrator.loading import load_experiment
from orchestrator.run import prepare

LENGTHS = {"long": {"genome": {"length": 16}}, "short": {"genome": {"length": 12}}}
ADAPTED = {"from": "long", "to": "short"}


def adapted(adapter: str) -> dict:
    return bits(islands=LENGTHS, channels=[{**ADAPTED, "adapter": f"spoilt:{adapter}"}])


def of_kind(kind: str, *channels: dict) -> dict:
    return bits(islands={"north": {"kind": f"spoilt:{kind}"}, "south": {"kind": f"spoilt:{kind}"}},
                channels=list(channels))  # fmt: skip


PARTNERS = {"kind": "partners", "from": "north", "to": "south"}
SPOILT = [
    (bits(channels=[{"topology": "spoilt:leaving"}]), "channels.0.topology",
     "expected a topology of 4 islands, got 'spoilt:leaving', which raised SystemExit: cannot lay 4 islands"),
    (adapted("Unmade"), "channels.0.adapter", "got 'spoilt:Unmade', which raised ZeroDivisionError: no adapter today"),
    (adapted("Unbuilt"), "channels.0.adapter", "expected an adapter from long to short, got 'spoilt:Unbuilt', which r"),
    (adapted("Kindless"), "channels.0.adapter", "got 'spoilt:Kindless', which raised TypeError: "),
    (of_kind("NoBuildKind"), "islands.north.kind", "an island kind that can be built, got 'spoilt:NoBuildKind', which"),
    (of_kind("NoInitKind"), "islands.north.kind", "expected an island kind, got 'spoilt:NoInitKind', which raised Sys"),
    (of_kind("NoNeedsKind"), "islands.north.kind", "got the needs of 'spoilt:NoNeedsKind', which raised RuntimeError:"),
    (of_kind("NoGivesKind", PARTNERS), "islands.north.kind", "got the gives of 'spoilt:NoGivesKind', which raised Run"),
]  # fmt: skip


@pytest.mark.parametrize(("data", "place", "message"), SPOILT)
def test_it_is_told_in_a_line(tmp_path, data, place, message) -> None:
    result = CliRunner().invoke(main, ["check", str(write(tmp_path, data))])
    assert result.exit_code == 2, result.output
    (line,) = result.stderr.splitlines()
    assert f": {place}: " in line
    assert message in line


@pytest.mark.parametrize("data", [bits(channels=[{"topology": "spoilt:interrupted"}]), adapted("Waiting")])
def test_a_ctrl_c_passes(tmp_path, data) -> None:
    with pytest.raises(KeyboardInterrupt):
        prepare(load_experiment(write(tmp_path, data)))


def test_adapters_that_are_merely_installed_spoil_nothing(tmp_path, monkeypatch) -> None:
    install(tmp_path, monkeypatch, "atoll.adapters", unmade="spoilt:Unmade", unbuilt="spoilt:Unbuilt",
            kindless="spoilt:Kindless", shorten="traders:Shorten", gone="nowhere:X")  # fmt: skip
    with pytest.raises(
        InputError, match=r"give both the same genome and 'species', or set adapter: resize or shorten$"
    ):
        prepare(load_experiment(write(tmp_path, bits(islands=LENGTHS, channels=[ADAPTED]))))


def test_edges_of_a_plug_in_that_are_there_twice_are_refused(tmp_path) -> None:
    data = bits(channels=[{"topology": "spoilt:repeated"}])
    with pytest.raises(InputError, match=r"topology: expected each edge once, got 'spoilt:repeated' with 0 -> 1 again"):
        prepare(load_experiment(write(tmp_path, data)))


def test_a_need_and_a_name_without_brackets_are_one(tmp_path) -> None:
    with pytest.raises(InputError, match="expected a channel of kind partners to north, which it needs"):
        prepare(load_experiment(write(tmp_path, of_kind("OneNeedKind"))))
    prepare(
        load_experiment(write(tmp_path, of_kind("OneNeedKind", PARTNERS, {**PARTNERS, "from": "south", "to": "north"})))
    )
