"""Random streams by name: one for each island, purpose and epoch, so that no schedule can disturb another's draws."""

from __future__ import annotations

from enum import IntEnum, unique
from typing import Final, final

import numpy as np


@unique
class Purpose(IntEnum):
    """What a stream is drawn for. The numbers are part of every run's history: add, never renumber."""

    INITIAL = 0
    SELECTION = 1
    VARIATION = 2
    EMIGRANTS = 3
    REPLACEMENT = 4
    GROWTH = 5
    TOPOLOGY = 6
    ROUTING = 7
    PARTNERS = 8


ARCHIPELAGO: Final = 2**32 - 1
"""In place of an island's number, for what concerns all of them."""


def stream(seed: int, island: int, purpose: Purpose, epoch: int, *extra: int) -> np.random.Generator:
    """Give the generator of one island for one purpose in one epoch.

    Parameters
    ----------
    seed
        The run's seed.
    island
        The island's number.
    purpose
        What is drawn.
    epoch
        In which epoch.
    extra
        Further keys where one purpose needs several streams, such as a channel's number.
    """
    key = (island, int(purpose), epoch, *extra)
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(entropy=seed, spawn_key=key)))


@final
class EpochStreams:
    """The streams of one island in one epoch, each made when it is first drawn from: making one takes its time.

    Parameters
    ----------
    seed, island, epoch
        As for :func:`stream`.
    """

    __slots__ = ("_epoch", "_island", "_made", "_seed")

    def __init__(self, seed: int, island: int, epoch: int) -> None:
        self._seed: Final = seed
        self._island: Final = island
        self._epoch: Final = epoch
        self._made: Final[dict[tuple[int, ...], np.random.Generator]] = {}

    def __call__(self, purpose: Purpose, *extra: int) -> np.random.Generator:
        """Give the generator for a purpose: the same one each time, wherever its draws have come to."""
        key = (purpose, *extra)
        made = self._made.get(key)
        if made is None:
            made = self._made[key] = stream(self._seed, self._island, purpose, self._epoch, *extra)
        return made
