"""Timing for the benchmarks: alternate the contestants, take the best round of each, and say how rounds spread."""

from __future__ import annotations

import time
from collections.abc import Callable
from statistics import median


def best_of(*contestants: Callable[[], object], rounds: int = 15) -> tuple[float, ...]:
    """Give the shortest time in seconds of each contestant; they take turns, so that a busy machine hits all alike.

    Prints how the rounds spread.
    """
    seconds: list[list[float]] = [[] for _ in contestants]
    for _ in range(rounds):
        for mine, run in zip(seconds, contestants, strict=True):
            start = time.perf_counter()
            run()
            mine.append(time.perf_counter() - start)
    spread = "; ".join(f"{median(mine) / min(mine):.2f}, {max(mine) / min(mine):.2f}" for mine in seconds)
    print(f"{rounds} rounds in turns; median and slowest, of the best of each: {spread}")
    return tuple(map(min, seconds))
