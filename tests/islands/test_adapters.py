"""Adapters: found by name, refused where they do not suit, and what comes through one is an individual of its own."""

from __future__ import annotations

import json

import pytest
from archipelagos import LENGTH, edge, island, spec
from hypothesis import given, settings
from hypothesis import strategies as st

from genome.errors import InputError
from islands.individual import make_id
from islands.migration.adapters import adapters_into, build_adapter
from islands.migration.channel import Channel, Migrant, Packet

WHERE = "x.yaml: channels.0.adapter"


def bits(number: int = 0, length: int = 8):
    return spec(number, kind="bits", genome={"length": length})


def surface(number: int = 0, **genome):
    return spec(number, kind="surface", genome=genome)


@settings(deadline=None)  # the first example imports the kind
@given(st.text("01", min_size=1, max_size=20), st.integers(1, 30))
def test_resizing_bits_cuts_off_or_repeats(text, length) -> None:
    resized = build_adapter("resize", bits(0, len(text)), bits(1, length), WHERE)(text)
    assert resized == (text * 30)[:length]


@settings(deadline=None)
@given(st.lists(st.integers(0, 2**31), min_size=1, max_size=20), st.integers(2, 30), st.integers(2, 400))
def test_resizing_genes_brings_them_under_the_ceiling(genes, length, ceiling) -> None:
    resize = build_adapter("resize", surface(0), surface(1, length=length, gene_ceiling=ceiling), WHERE)
    assert json.loads(resize(json.dumps(genes))) == [gene % ceiling for gene in (genes * 30)[:length]]


@pytest.mark.parametrize(
    ("name", "ends", "message"),
    [
        (
            "resize",
            (bits(), surface(1)),
            "two islands of one kind for the adapter 'resize', got isle-0 of kind 'bits' and",
        ),
        ("resise", (bits(), bits(1)), "an adapter, got 'resise'; did you mean 'resize'?"),
        ("json:loads", (bits(), bits(1)), "an adapter, got 'json:loads', a function without source, target, build"),
        ("species:Idle", (bits(), bits(1)), "an adapter that makes a translation, got 'species:Idle', whose build"),
        ("species:Inverted", (surface(), bits(1)), "an adapter from the kind 'surface' of island isle-0, got"),
        ("species:Inverted", (bits(), surface(1)), "an adapter to the kind 'surface' of island isle-1, got"),
    ],
)
def test_what_does_not_suit_is_refused(name, ends, message) -> None:
    with pytest.raises(InputError) as caught:
        build_adapter(name, *ends, WHERE)
    assert str(caught.value).startswith(f"{WHERE}: expected {message}")


def arrivals(isle, *texts: str, scoring: str = "") -> list[Packet]:
    migrants = tuple(Migrant(make_id(0, n), text, 3.0, (), "") for n, text in enumerate(texts))
    return [Packet(0, 0, 1, 0, scoring or isle.biology.scoring, migrants)]


def adapted(**settings):
    channel = Channel(0, "a", count=4, **settings)
    made = adapters_into(spec(1, kind="bits"), [("species:Inverted", spec(0, kind="bits"))], WHERE)
    return island(1, (edge(channel, 0, 1, adapter="species:Inverted"),), adapters=made)


def genes(ones: int) -> str:
    return json.dumps([0] * ones + [1] * (LENGTH - ones))


def test_whoever_comes_through_an_adapter_is_born_here() -> None:
    isle = adapted()
    begun = isle.begin()
    step = isle.advance(begun.state, 1, arrivals(isle, genes(23), genes(22)))
    one, two = step.records.born[:2]
    assert (one.id, one.parents, one.origin) == (make_id(1, 12), (make_id(0, 0),), "adaptation")
    assert (one.generation, one.epoch, one.fitness) == (0, 1, 23.0)
    assert json.loads(one.genotype) == [1] * 23 + [0]
    assert (two.id, two.parents, two.fitness) == (make_id(1, 13), (make_id(0, 1),), 22.0)
    assert [(row.id, row.fitness, row.accepted) for row in step.records.crossings] == [
        (make_id(0, 0), 3.0, True), (make_id(0, 1), 3.0, True),
    ]  # fmt: skip
    assert [member.id for member in step.state.deme[:2]] == [one.id, two.id]
    assert [row.evaluations for row in step.records.generations] == [12]
    assert step.records.rescored == ()


def test_it_stands_at_the_gate_with_the_fitness_that_it_has_here() -> None:
    isle = adapted(accept="better")
    step = isle.advance(isle.begin().state, 1, arrivals(isle, genes(1), genes(23)))
    assert [row.reason for row in step.records.crossings] == ["not better", ""]
    assert [row.origin for row in step.records.born[:2]] == ["adaptation"] * 2


def test_what_cannot_be_translated_or_read_is_turned_away_with_the_reason() -> None:
    isle = adapted()
    step = isle.advance(isle.begin().state, 1, arrivals(isle, json.dumps([0] * LENGTH), "[", genes(20)))
    reasons = [row.reason for row in step.records.crossings]
    assert reasons[0] == "adapter: ValueError: no ones at all"
    assert reasons[1].startswith("adapter: JSONDecodeError: ")
    assert reasons[2] == ""
    plain = island(1, (edge(Channel(0, "a", count=4), 0, 1),))
    step = plain.advance(plain.begin().state, 1, arrivals(plain, "[", genes(20)))
    reasons = [row.reason for row in step.records.crossings]
    assert reasons[0].startswith("genotype: JSONDecodeError: ")
    assert reasons[1] == ""
    assert len(step.state.deme) == 12
