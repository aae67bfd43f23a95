"""DEAP with multiprocessing: one deme of all members, whose scoring is mapped over two processes."""

from __future__ import annotations

import json
import multiprocessing
import random
import sys
import time
from functools import partial

from deap import algorithms, base, creator, tools  # noqa: TID251 - as DEAP's users write it
from problem import BITS, DEME, GENERATIONS, ISLANDS, work

creator.create("Fitness", base.Fitness, weights=(1.0,))
creator.create("Member", list, fitness=creator.Fitness)


def score(member: list[int], times: str) -> tuple[float]:
    """Score a member."""
    work(times)
    return (float(sum(member)),)


def main(times: str) -> None:
    """Run and print seconds and evaluations."""
    random.seed(1)
    toolbox = base.Toolbox()
    toolbox.register("bit", random.randint, 0, 1)
    toolbox.register("member", tools.initRepeat, creator.Member, toolbox.bit, BITS)
    toolbox.register("population", tools.initRepeat, list, toolbox.member)
    toolbox.register("mate", tools.cxTwoPoint)
    toolbox.register("mutate", tools.mutFlipBit, indpb=1 / BITS)
    toolbox.register("select", tools.selTournament, tournsize=3)
    with multiprocessing.Pool(2) as pool:
        # Short chunks when times differ: the last one of a generation is waited for.
        toolbox.register("map", pool.map, chunksize=20 if times == "constant" else 2)
        toolbox.register("evaluate", partial(score, times=times))
        pool.map(partial(score, times="constant"), [[0] * BITS] * 20)
        population = toolbox.population(ISLANDS * DEME)
        started, count = time.perf_counter(), len(population)
        for member, fitness in zip(population, toolbox.map(toolbox.evaluate, population), strict=True):
            member.fitness.values = fitness
        for _ in range(GENERATIONS):
            offspring = algorithms.varOr(
                toolbox.select(population, len(population)), toolbox, len(population), cxpb=0.5, mutpb=0.5
            )
            # Every offspring is scored, as on the other sides.
            for member, fitness in zip(offspring, toolbox.map(toolbox.evaluate, offspring), strict=True):
                member.fitness.values = fitness
            population, count = offspring, count + len(offspring)
        seconds = time.perf_counter() - started
    print(json.dumps({"seconds": seconds, "evaluations": count, "best": max(m.fitness.values[0] for m in population)}))


if __name__ == "__main__":
    main(sys.argv[1])
