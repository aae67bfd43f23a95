"""What a species is: one kind and one genome section but for variation; and partners that fit."""

from __future__ import annotations

import pytest

from experiments import bits, run, write
from genome.errors import InputError
from islands.kinds.registry import KINDS, resolve_kind
from islands.kinds.trade import variation
from orchestrator.loading import load_experiment
from orchestrator.plan import Plan
from orchestrator.run import prepare


def of_bits(one: dict, other: dict, *channels: dict, **changes) -> dict:
    islands = {"a": {"species": "x", "genome": one}, "b": {"species": "x", "genome": other}}
    data = bits(islands=islands, channels=list(channels or ({"topology": "ring"},)))
    data["defaults"] |= {"kind": "bits", **changes}
    return data


def planned(tmp_path, data: dict) -> Plan:
    return prepare(load_experiment(write(tmp_path, data)))[0]


def test_a_species_of_one_name_has_one_genome(tmp_path) -> None:
    with pytest.raises(InputError) as caught:
        planned(tmp_path, of_bits({"length": 8}, {"length": 16, "flip": 0.5}))
    assert str(caught.value).partition(": ")[2] == (
        "channels.0: expected islands of one genome in a species, got a (x) and b (x), whose genomes differ in "
        "length (8, 16); give them one genome, or different 'species' and adapter: resize"
    )
    with pytest.raises(InputError, match="expected islands of one genome in a species"):
        planned(tmp_path, of_bits({"length": 8}, {"length": 16}, {"topology": "random"}))


def test_islands_of_a_species_may_vary_as_they_like(tmp_path) -> None:
    assert planned(tmp_path, of_bits({"flip": 0.1}, {"flip": 0.5, "crossover": "one_point"})).edges
    outcome = run(tmp_path, of_bits({"flip": 0.1}, {"flip": 0.5, "crossover": "one_point"}, {"topology": "ring"}))
    assert outcome.status == "finished"


def test_islands_that_differ_in_variation_alone_are_told_that_a_species_may(tmp_path) -> None:
    data = of_bits({"flip": 0.1}, {"flip": 0.5})
    del data["islands"]["a"]["species"], data["islands"]["b"]["species"]
    with pytest.raises(InputError, match=r"differ in flip .*; migrants travel within a species: give both the same 's"):
        planned(tmp_path, data)


@pytest.mark.parametrize("name", KINDS)
def test_what_may_vary_is_a_part_of_the_genome_section(name) -> None:
    kind = resolve_kind(name, "x")
    assert variation(kind) < set(kind.genome.model_fields)
    assert "length" not in variation(kind)


def test_partners_are_of_one_length(tmp_path) -> None:
    channel = {"kind": "partners", "from": "a", "to": "b"}
    with pytest.raises(InputError) as caught:
        planned(tmp_path, of_bits({"length": 8}, {"length": 16}, channel))
    assert "a ('bits'), which gives bits of 8 to channels of kind partners, and b ('bits'), which takes bits of 16" in (
        str(caught.value)
    )
    assert planned(tmp_path, of_bits({"length": 8}, {"length": 8, "flip": 0.5}, channel)).edges


def several(count: int, pairings: int) -> dict:
    data = of_bits({}, {}, {"kind": "partners", "topology": "random", "pairing": "several", "pairings": pairings,
                            "count": count})  # fmt: skip
    data["islands"]["a"]["count"] = 3
    return data


def test_more_pairings_than_drawn_edges_can_ever_show_are_refused(tmp_path) -> None:
    with pytest.raises(InputError, match=r"pairings: expected at most 6, as many as are shown to a-0, got 7"):
        planned(tmp_path, several(2, 7))
    assert planned(tmp_path, several(2, 6)).redrawn


def test_islands_alone_in_their_group_need_not_trade_with_themselves(tmp_path) -> None:
    data = bits(islands={"left": {"kind": "spoilt:LeftKind"}, "right": {"kind": "spoilt:RightKind"}},
                channels=[{"kind": "partners", "topology": "random"}])  # fmt: skip
    assert planned(tmp_path, data).redrawn
    data["islands"]["left"]["count"] = 2
    with pytest.raises(InputError, match="which gives left to channels of kind partners, and left-0"):
        planned(tmp_path, data)


ALIKE = {"from": "a", "to": "b", "adapter": "resize"}


def test_an_adapter_without_work_is_refused_and_one_that_is_not_there_in_any_case(tmp_path) -> None:
    with pytest.raises(InputError, match=r"adapter: expected islands of different species to adapt between, got islan"):
        planned(tmp_path, of_bits({}, {}, ALIKE))
    for channel in ({**ALIKE, "adapter": "shrink"}, {"topology": "ring", "among": "a", "adapter": "shrink"}):
        with pytest.raises(InputError, match=r"channels\.0\.adapter: expected an adapter, got 'shrink'"):
            planned(tmp_path, of_bits({}, {}, channel, {"topology": "ring"}))
    with pytest.raises(InputError, match=r"channels\.0\.adapter: expected a text that is not empty, got ''$"):
        planned(tmp_path, of_bits({}, {}, {**ALIKE, "adapter": ""}))


def test_hosts_build_no_adapter_within_a_species(tmp_path) -> None:
    from islands.host import _strangers
    from orchestrator.plan import host_plans

    islands = {"a": {"count": 2}, "b": {"genome": {"length": 40}}}
    loaded = load_experiment(write(tmp_path, bits(islands=islands, channels=[
        {"topology": "random", "adapter": "traders:Shorten"}])))  # fmt: skip
    plan, _ = prepare(loaded)
    (host,) = host_plans(loaded, plan, 1, "run", tmp_path)
    found = {target: [source.number for _, source in sources] for target, sources in _strangers(host).items()}
    assert found == {0: [2], 1: [2], 2: [0, 1]}
