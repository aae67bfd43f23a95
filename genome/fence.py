"""The fence around the global random stream, which DEAP's operators draw from.

Inside the fence the stream starts from a passed generator, so that nothing outside decides what is drawn; behind it the
stream is as it was, so that nothing drawn inside shows outside.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np


@contextmanager
def fenced(rng: np.random.Generator) -> Iterator[None]:
    """Seed the global ``random`` from ``rng`` and restore its state at the end, after an exception too.

    Parameters
    ----------
    rng
        One 63-bit integer is drawn from it.
    """
    seed = int(rng.integers(0, 2**63))
    state = random.getstate()
    random.seed(seed)
    try:
        yield
    finally:
        random.setstate(state)
