"""What an epoch costs with 10 to 1,000 islands on two Ray hosts, and what they hold in memory.

Each island has 20 members, breeds one generation an epoch, and sends one migrant to its neighbour on a ring. The cost
of an epoch is to grow linearly: the slope of a line through the logarithms is to stay under 1.1.
"""

from __future__ import annotations

import math
import statistics
import tempfile
from pathlib import Path

from benchmarks.runs import watched

COUNTS = (10, 30, 100, 300, 1000)
ISLAND_EPOCHS = 30_000
ROUNDS = 2
EXPONENT, ISLAND_MB, DRIVER_MB = 1.1, 1.0, 500.0
EXPERIMENT = """
name: many
epochs: {epochs}
epoch: 1
hosts: 2
schedule: dataflow
islands:
  i:
    kind: bits
    count: {islands}
    population: 20
    genome: {{length: 64}}
    fitness: {{ones: {{goal: maximise}}}}
channels:
  - {{kind: migrants, topology: ring, count: 1}}
forms: {{best: 0}}
"""


def main() -> bool:
    """Print the costs, the slope and the memory; tell whether they are within their limits."""
    seconds: list[float] = []
    driver = hosts = fewest = 0.0
    with tempfile.TemporaryDirectory() as name:
        for count in COUNTS:
            epochs = max(ISLAND_EPOCHS // count, 20)
            text = EXPERIMENT.format(epochs=epochs, islands=count)
            rounds = [watched(Path(name), text, f"many-{count}-{turn}") for turn in range(ROUNDS)]
            seconds.append(min(float(told["stepped_s"]) for told, _, _ in rounds) / epochs)
            driver, hosts = max(one for _, one, _ in rounds), min(held for _, _, held in rounds)
            fewest = fewest or hosts
            print(f"many_islands: {count} islands: {seconds[-1] * 1e3:.2f} ms an epoch, ", end="")
            print(f"driver {driver:.0f} MB, hosts {hosts:.0f} MB", flush=True)
    slope = statistics.linear_regression([math.log(c) for c in COUNTS], [math.log(s) for s in seconds]).slope
    each = (hosts - fewest) / (COUNTS[-1] - COUNTS[0])
    print(f"many_islands: exponent {slope:.3f} (under {EXPONENT:g})")
    print(f"many_islands: {each:.3f} MB an island (under {ISLAND_MB:g}), driver {driver:.0f} MB (under {DRIVER_MB:g})")
    return slope < EXPONENT and each < ISLAND_MB and driver < DRIVER_MB


if __name__ == "__main__":
    raise SystemExit(not main())
