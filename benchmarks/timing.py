"""Timing for the benchmarks: alternate the contestants, take the best round of each."""

from __future__ import annotations

import time
from collections.abc import Callable


def best_of(*contestants: Callable[[], object], rounds: int = 15) -> tuple[float, ...]:
    """Give the shortest time in seconds of each contestant; they take turns, so that a busy machine hits all alike."""
    best = [float("inf")] * len(contestants)
    for _ in range(rounds):
        for i, run in enumerate(contestants):
            start = time.perf_counter()
            run()
            best[i] = min(best[i], time.perf_counter() - start)
    return tuple(best)
