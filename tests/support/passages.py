"""Values that travel and that islands hold, as hypothesis draws them: to the last bit, odd ones too."""

from __future__ import annotations

import json
import math
from typing import Any

from hypothesis import strategies as st

from evaluators.fitness import Goal
from islands.holdings import NOTHING, Held, Holdings, Past
from islands.individual import Individual
from islands.migration.channel import Migrant, Packet
from islands.state import State
from islands.steered import Steered
from islands.watch import Known, Watch

FLOATS = st.floats(allow_nan=False)
IDS = st.integers(0, 2**62)
NUMBERS = st.integers(0, 2**31)
SCORES = st.lists(st.tuples(st.text(), FLOATS), max_size=3).map(tuple)
ODD_TEXT = st.text(st.characters(exclude_categories=()), max_size=20)
"""Lone surrogates too: what a kind offers is in no table of the log."""

MIGRANTS = st.builds(Migrant, IDS, ODD_TEXT, st.none() | FLOATS, SCORES, ODD_TEXT)
TRAVELLERS = st.lists(MIGRANTS, max_size=3).map(tuple)
GOALS = st.builds(
    lambda value, weight: Goal(goal="target", value=value, weight=weight),
    st.floats(-1e9, 1e9),
    st.floats(1e-9, 1e9),
)
HELD = st.lists(st.builds(Held, NUMBERS, NUMBERS, TRAVELLERS), max_size=2).map(tuple)
HOLDINGS = st.just(NOTHING) | st.builds(
    Holdings, HELD, HELD, HELD, st.lists(st.builds(Past, NUMBERS, TRAVELLERS), max_size=2).map(tuple)
)
CHAMPIONS = st.none() | st.tuples(FLOATS, IDS)
STEERED = st.builds(
    lambda goals, rates, promoted, locked: (
        Steered(promoted=promoted, locked=locked).with_goals(goals).with_rates(rates)
    ),
    st.dictionaries(st.text(max_size=3), GOALS, max_size=2),
    st.dictionaries(st.sampled_from(["crossover", "mutation"]), st.floats(0, 1), max_size=2),
    st.lists(IDS, max_size=2).map(tuple),
    st.lists(IDS, max_size=2).map(tuple),
)


OUTCOMES = st.lists(st.tuples(st.text(), st.none() | FLOATS), max_size=3).map(tuple)
KNOWN = st.lists(st.builds(Known, IDS, st.text()), max_size=2).map(tuple)
WATCHES = st.lists(st.builds(Watch, NUMBERS, KNOWN, NUMBERS), max_size=2).map(tuple)


def demes(genotypes: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    members = st.builds(Individual, IDS, genotypes, st.none() | FLOATS, SCORES, st.text(max_size=20), NUMBERS, OUTCOMES)
    return st.lists(members, max_size=4).map(tuple)


def states(epoch: int, genotypes: st.SearchStrategy[Any]) -> st.SearchStrategy[State[Any]]:
    """States at the end of an epoch, empty demes among them."""
    return st.builds(
        State, demes(genotypes), st.just(epoch), NUMBERS, IDS, st.none() | FLOATS, NUMBERS, HOLDINGS, ODD_TEXT, STEERED,
        WATCHES,
    )  # fmt: skip


def packets(epoch: int, target: int) -> st.SearchStrategy[tuple[Packet, ...]]:
    """Packets to an island of that epoch and of those before, each mark once, in order."""
    one = st.builds(Packet, NUMBERS, NUMBERS, st.just(target), st.integers(0, epoch), ODD_TEXT, TRAVELLERS)
    found = st.lists(one, max_size=4, unique_by=lambda packet: (packet.channel, packet.source, packet.epoch))
    return found.map(lambda some: tuple(sorted(some, key=lambda packet: (packet.channel, packet.source, packet.epoch))))


def bits_of(value: Any) -> Any:
    """Give a value in which floats that differ in a bit, or a float and a whole number, are different."""
    if isinstance(value, float):
        return value.hex() if math.isfinite(value) else str(value)
    if isinstance(value, (State, Individual)):
        return type(value).__name__, [bits_of(getattr(value, name)) for name in value.__slots__]
    if isinstance(value, Steered):
        return "Steered", json.dumps(value.to_json())
    if isinstance(value, tuple):
        return type(value).__name__, [bits_of(one) for one in value]
    return type(value).__name__, value
