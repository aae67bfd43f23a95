"""Taking in what channels bring other than migrants, and scoring a deme again where that changes how it scores."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from islands.holdings import Holdings, archived, taken_in
from islands.migration.channel import Channel, Edge, Migrant, Packet
from islands.records import Crossing
from islands.registrar import Registrar
from islands.state import Deme
from islands.steered import Steered

G = TypeVar("G")
Arrived = tuple[Edge, Packet]


def received(held: Holdings, others: Sequence[Arrived], registrar: Registrar[G]) -> Holdings:
    """Take in partners, components and surroundings, a row each; give what the island holds then."""
    shown: dict[Channel, list[Migrant]] = {}
    for edge, packet in others:
        channel = edge.channel
        held, reasons = taken_in(held, channel, packet)
        ends = (registrar.epoch, channel.name, channel.kind, edge.source_name, edge.target_name)
        for one, reason in zip(packet.migrants, reasons, strict=True):
            registrar.crossings.append(Crossing(*ends, one.id, one.fitness, not reason, reason))
        if channel.kind == "partners":
            shown.setdefault(channel, []).extend(packet.migrants)
    for channel, partners in shown.items():
        held = archived(held, channel, partners)
    return held


def steered_reason(before: Steered, after: Steered) -> str:
    """Say why a deme is scored again that is steered otherwise than before; empty where it scores as it did."""
    if after.goals != before.goals:
        return "weights"
    return "strengths" if after.strengths != before.strengths else ""


def reason_of(before: str, among: str) -> str:
    """Say why a deme is scored again whose goals are the same.

    Parameters
    ----------
    before
        How its members were scored; empty where nothing was held.
    among
        How they are scored in what surrounds them now, partners aside.
    """
    is_alike = (before or among) == among or before.startswith(f"{among}+")
    return "partners" if is_alike else "surroundings"


def rescored(deme: Deme[G], reason: str, registrar: Registrar[G]) -> Deme[G]:
    """Score a whole deme again, a row each."""
    return tuple(registrar.score_again(one.id, one.genotype, reason, one.since) for one in deme)
