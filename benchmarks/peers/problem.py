"""The problem that all sides solve: OneMax with work that costs about a millisecond, fixed or log-normal.

The work is hashing, so that it costs the same everywhere. Log-normal times do not hang on the string, since a
population that comes to one best string would come to one time: each process goes round a list of quantiles in an order
of its own, so that all sides do the same work within a percent. It needs nothing but the standard library, since each
side runs in an environment of its own.
"""

from __future__ import annotations

import hashlib
import math
import os
import random
import time
from collections.abc import Iterator
from functools import cache
from itertools import cycle
from statistics import NormalDist

BITS = 100
ISLANDS, DEME, GENERATIONS, EPOCH = 8, 20, 60, 2
"""Every side scores ISLANDS * DEME * (GENERATIONS + 1) strings, and exchanges migrants every EPOCH generations."""

ROUNDS = 4300
"""Rounds of hashing in a millisecond, about."""

QUANTILES = 1000
"""Different times of the log-normal distribution."""


def work(times: str) -> None:
    """Do the work of one string; each side counts the ones in its own way."""
    share = 1.0 if times == "constant" else next(shares(os.getpid()))
    hashlib.pbkdf2_hmac("sha256", b"atoll", b"peers", max(1, round(ROUNDS * share)))


@cache
def shares(process: int) -> Iterator[float]:
    """Give times of mean 1 and sigma 1 of their logarithm, without end, in an order that differs by process."""
    normal = NormalDist()
    found = [math.exp(normal.inv_cdf((place + 0.5) / QUANTILES)) for place in range(QUANTILES)]
    mean = sum(found) / QUANTILES
    random.Random(process).shuffle(found)  # noqa: S311 - an order, no secret
    return cycle([one / mean for one in found])


def evaluations() -> int:
    """Give how many strings a side scores."""
    return ISLANDS * DEME * (GENERATIONS + 1)


def cost() -> float:
    """Measure the seconds of one evaluation of constant work on this machine, at its best."""
    best = math.inf
    for _ in range(50):
        started = time.perf_counter()
        work("constant")
        best = min(best, time.perf_counter() - started)
    return best
