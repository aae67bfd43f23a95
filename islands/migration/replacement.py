"""Whose place an immigrant takes. Each replacer takes the ranked residents, the worst last, and gives a place."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from islands.individual import Individual
from islands.kinds.protocol import Biology
from islands.migration.channel import Channel
from islands.streams import EpochStreams, Purpose

Residents = Sequence[Individual[Any]]
Replace = Callable[[Residents, Any, Biology[Any], Channel, EpochStreams], int]
"""From the residents (at least 1), the newcomer's genotype, the biology, the channel and the streams to a place."""

BY_GENOTYPE: Final = frozenset({"similar"})
"""Those that look at the newcomer's genotype; the others are given ``None``."""


def worst(
    residents: Residents, newcomer: object, biology: Biology[Any], channel: Channel, streams: EpochStreams
) -> int:
    """Take the place of the worst resident."""
    del newcomer, biology, channel, streams
    return len(residents) - 1


def random(
    residents: Residents, newcomer: object, biology: Biology[Any], channel: Channel, streams: EpochStreams
) -> int:
    """Take the place of any resident, each as likely."""
    del newcomer, biology
    return int(streams(Purpose.REPLACEMENT, channel.number).integers(0, len(residents)))


def oldest(
    residents: Residents, newcomer: object, biology: Biology[Any], channel: Channel, streams: EpochStreams
) -> int:
    """Take the place of the resident that has been in this deme the longest; of equals, of the worst."""
    del newcomer, biology, channel, streams
    return min(range(len(residents)), key=lambda place: (residents[place].since, -place))


def similar(
    residents: Residents, newcomer: object, biology: Biology[Any], channel: Channel, streams: EpochStreams
) -> int:
    """Take the place of the resident that differs least; of equals, of the worst."""
    del channel, streams
    apart = [biology.diversity((newcomer, one.genotype)) or 0.0 for one in residents]
    return min(range(len(residents)), key=lambda place: (apart[place], -place))


def tournament(
    residents: Residents, newcomer: object, biology: Biology[Any], channel: Channel, streams: EpochStreams
) -> int:
    """Take the place of the worst of ``tournament`` residents that are drawn with replacement."""
    del newcomer, biology
    rng = streams(Purpose.REPLACEMENT, channel.number)
    return int(rng.integers(0, len(residents), size=channel.tournament).max())


REPLACERS: Final[Mapping[str, Replace]] = {
    "worst": worst,
    "random": random,
    "oldest": oldest,
    "similar": similar,
    "tournament": tournament,
}
