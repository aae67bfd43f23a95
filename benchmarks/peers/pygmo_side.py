"""pygmo's archipelago of mp_island: islands on a ring that evolve in a pool of two processes."""

from __future__ import annotations

import json
import sys
import time

import pygmo
from problem import BITS, DEME, EPOCH, GENERATIONS, ISLANDS, work


class Ones:
    """OneMax as pygmo wants it: integers, minimised."""

    def __init__(self, times: str) -> None:
        self.times = times

    def fitness(self, x: object) -> list[float]:
        """Score a string."""
        work(self.times)
        return [-float(x.sum())]  # type: ignore[attr-defined]

    def get_bounds(self) -> tuple[list[int], list[int]]:
        """Bits."""
        return [0] * BITS, [1] * BITS

    def get_nix(self) -> int:
        """All of them are integers."""
        return BITS


def main(times: str) -> None:
    """Run and print seconds and evaluations."""
    pygmo.mp_island.init_pool(2)
    algorithm = pygmo.algorithm(
        pygmo.sga(gen=EPOCH, cr=0.8, m=1 / BITS, crossover="single", mutation="uniform", seed=1)
    )
    warm = pygmo.archipelago(
        n=2, algo=algorithm, prob=pygmo.problem(Ones("constant")), pop_size=4, udi=pygmo.mp_island()
    )
    warm.evolve()
    warm.wait_check()
    started = time.perf_counter()
    # pygmo scores a first population where the archipelago is made, on one CPU; those scorings are left out of its
    # time, and as many are given to its islands instead.
    archipelago = pygmo.archipelago(t=pygmo.topology(pygmo.ring()), seed=1)
    for place in range(ISLANDS):
        population = pygmo.population(pygmo.problem(Ones("constant")), 0)
        for member in range(DEME):
            population.push_back([(member * 7 + place + i * i) % 2 for i in range(BITS)], [0.0])
        timed = pygmo.population(pygmo.problem(Ones(times)), 0)
        for x in population.get_x():
            timed.push_back(x, [0.0])
        archipelago.push_back(pygmo.island(algo=algorithm, pop=timed, udi=pygmo.mp_island()))
    started = time.perf_counter()
    archipelago.evolve(-(-(GENERATIONS + 1) // EPOCH))
    archipelago.wait_check()
    seconds = time.perf_counter() - started
    count = sum(island.get_population().problem.get_fevals() for island in archipelago)
    best = max(-island.get_population().champion_f[0] for island in archipelago)
    pygmo.mp_island.shutdown_pool()
    print(json.dumps({"seconds": seconds, "evaluations": count, "best": best}))


if __name__ == "__main__":
    main(sys.argv[1])
