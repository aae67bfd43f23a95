"""LEAP with dask: scoring on a cluster of two workers, by generations, or steady when times differ."""

from __future__ import annotations

import json
import logging
import sys
import time
import warnings

warnings.filterwarnings("ignore")

from distributed import Client, LocalCluster  # noqa: E402
from leap_ec import ops, representation  # noqa: E402
from leap_ec.binary_rep.initializers import create_binary_sequence  # noqa: E402
from leap_ec.binary_rep.ops import mutate_bitflip  # noqa: E402
from leap_ec.decoder import IdentityDecoder  # noqa: E402
from leap_ec.distrib import asynchronous, synchronous  # noqa: E402
from leap_ec.distrib.individual import DistributedIndividual  # noqa: E402
from leap_ec.problem import ScalarProblem  # noqa: E402
from problem import BITS, DEME, GENERATIONS, ISLANDS, work  # noqa: E402
from toolz import pipe  # noqa: E402

SIZE = ISLANDS * DEME


class Ones(ScalarProblem):
    """OneMax as LEAP wants it."""

    def __init__(self, times: str) -> None:
        super().__init__(maximize=True)
        self.times = times

    def evaluate(self, phenome: object, *_args: object, **_kwargs: object) -> float:
        """Score a string."""
        work(self.times)
        return float(sum(phenome))  # type: ignore[call-overload]


def by_generations(client: Client, problem: Ones) -> tuple[int, float]:
    """Score whole generations."""
    made = representation.Representation(
        decoder=IdentityDecoder(), initialize=create_binary_sequence(BITS), individual_cls=DistributedIndividual
    )
    population = synchronous.eval_population(made.create_population(SIZE, problem), client)
    count = SIZE
    for _ in range(GENERATIONS):
        population = pipe(
            population,
            ops.tournament_selection,
            ops.clone,
            mutate_bitflip(expected_num_mutations=1),
            ops.UniformCrossover(),
            synchronous.eval_pool(client=client, size=SIZE),
        )
        count += SIZE
    return count, max(one.fitness for one in population)


def steady(client: Client, problem: Ones) -> tuple[int, float]:
    """Score one after the other, whichever worker is free."""
    made = representation.Representation(
        decoder=IdentityDecoder(), initialize=create_binary_sequence(BITS), individual_cls=DistributedIndividual
    )
    births = SIZE * (GENERATIONS + 1)
    population = asynchronous.steady_state(
        client,
        max_births=births,
        init_pop_size=8,
        pop_size=SIZE,
        representation=made,
        problem=problem,
        offspring_pipeline=[
            ops.random_selection,
            ops.clone,
            mutate_bitflip(expected_num_mutations=1),
            ops.pool(size=1),
        ],
    )
    return births, max(one.fitness for one in population)


def main(times: str) -> None:
    """Run and print seconds and evaluations."""
    with (
        LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=logging.CRITICAL
        ) as cluster,
        Client(cluster) as client,
    ):
        client.gather(client.map(pow, range(20), [2] * 20))
        started = time.perf_counter()
        count, best = (by_generations if times == "constant" else steady)(client, Ones(times))
        seconds = time.perf_counter() - started
    print(json.dumps({"seconds": seconds, "evaluations": count, "best": float(best)}))


if __name__ == "__main__":
    main(sys.argv[1])
