"""Choosing who emigrates. Each chooser takes a ranked deme and gives distinct members, the best of them first."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from islands.individual import Individual
from islands.migration.channel import Channel

Chooser = Callable[[int, Channel, np.random.Generator], list[int]]
"""From the deme's size, the channel and a stream to ``channel.count`` distinct places in the ranking."""


def best(size: int, channel: Channel, rng: np.random.Generator) -> list[int]:
    """Choose the best."""
    del size, rng
    return list(range(channel.count))


def random(size: int, channel: Channel, rng: np.random.Generator) -> list[int]:
    """Choose at random, each set of members as likely."""
    return sorted(int(place) for place in rng.choice(size, size=channel.count, replace=False))


def tournament(size: int, channel: Channel, rng: np.random.Generator) -> list[int]:
    """Hold one tournament after the other among those not chosen yet."""
    left = list(range(size))
    chosen = []
    for _ in range(channel.count):
        entrants = rng.integers(0, len(left), size=channel.tournament)
        chosen.append(left.pop(int(entrants.min())))
    return sorted(chosen)


CHOOSERS: Final[Mapping[str, Chooser]] = {"best": best, "random": random, "tournament": tournament}


def emigrants(
    order: Sequence[Individual[Any]], channel: Channel, rng: np.random.Generator
) -> tuple[Individual[Any], ...]:
    """Choose ``channel.count`` distinct members of a ranked deme.

    Parameters
    ----------
    order
        The deme, best first; at least ``channel.count`` members.
    channel
        Says how many and how.
    rng
        The stream of this edge and epoch.
    """
    return tuple(order[place] for place in CHOOSERS[channel.select](len(order), channel, rng))
