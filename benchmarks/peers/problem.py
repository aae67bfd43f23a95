"""The problem that all sides solve: OneMax with work that costs about a millisecond, fixed or log-normal.

The work is hashing, so that it costs the same everywhere; how much of it is a function of the string alone. It needs
nothing but the standard library, since each side runs in an environment of its own.
"""

from __future__ import annotations

import hashlib
import math
import time

BITS = 100
ISLANDS, DEME, GENERATIONS, EPOCH = 8, 20, 60, 2
"""Every side scores ISLANDS * DEME * (GENERATIONS + 1) strings, and exchanges migrants every EPOCH generations."""

ROUNDS = 4300
"""Rounds of hashing in a millisecond, about."""

MOST = 60.0
"""A log-normal draw is cut here, in milliseconds."""


def evaluate(bits: tuple[int, ...], times: str) -> float:
    """Do the work of a string and count its ones."""
    share = 1.0 if times == "constant" else lognormal(bits)
    hashlib.pbkdf2_hmac("sha256", b"atoll", b"peers", max(1, round(ROUNDS * share)))
    return float(sum(bits))


def lognormal(bits: tuple[int, ...]) -> float:
    """Draw from a log-normal distribution of mean 1 and sigma 1, the same for the same string."""
    digest = hashlib.sha256(bytes(bits)).digest()
    first, second = (int.from_bytes(digest[at : at + 7], "big") / 2**56 for at in (0, 7))
    normal = math.sqrt(-2 * math.log(1 - first)) * math.cos(2 * math.pi * second)
    return min(math.exp(normal - 0.5), MOST)


def evaluations() -> int:
    """Give how many strings a side scores."""
    return ISLANDS * DEME * (GENERATIONS + 1)


def cost() -> float:
    """Measure the seconds of one evaluation of constant work on this machine, at its best."""
    best = math.inf
    for _ in range(50):
        started = time.perf_counter()
        evaluate((0,) * BITS, "constant")
        best = min(best, time.perf_counter() - started)
    return best
