"""Packets as bytes: what one host posts to another.

A letter is JSON: plain values, as the log has them, that read back to the same bits. Packets that carry the same
migrants to several targets, as a broadcast does, have them written once.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from islands.migration.channel import Migrant, Packet

Bundle = list[Any]
"""Packets of the same migrants: channel, source, list of targets, epoch, scoring, migrants."""


def sealed(packets: Iterable[Packet]) -> bytes:
    """Write packets into a letter."""
    return written(bundled(packets))


def bundled(packets: Iterable[Packet]) -> list[Bundle]:
    """Put packets together that hold the very same migrants, in the order in which they come."""
    bundles: dict[tuple[int, int, int, str, int], Bundle] = {}
    for packet in packets:
        channel, source, target, epoch, scoring, migrants = packet
        key = (channel, source, epoch, scoring, id(migrants))
        bundle = bundles.get(key)
        if bundle is None:
            bundles[key] = [channel, source, [target], epoch, scoring, migrants]
        else:
            bundle[2].append(target)
    return list(bundles.values())


def written(bundles: Iterable[Bundle]) -> bytes:
    """Write bundles into a letter."""
    return json.dumps(list(bundles), separators=(",", ":")).encode("ascii")


def opened(letter: bytes) -> tuple[Packet, ...]:
    """Read what :func:`sealed` wrote."""
    packets: list[Packet] = []
    for channel, source, targets, epoch, scoring, travellers in json.loads(letter):
        migrants = tuple(
            Migrant(identity, text, fitness, tuple((name, value) for name, value in scores), error)
            for identity, text, fitness, scores, error in travellers
        )
        packets.extend(Packet(channel, source, target, epoch, scoring, migrants) for target in targets)
    return tuple(packets)
