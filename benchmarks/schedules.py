"""How much of two cores' time goes into the islands' own work, by schedule, on two Ray hosts.

The first part gives every island the same work an epoch, on a complete topology with migration each epoch, where all
wait for all: the share of two cores that this work takes, start-up aside, of what two plain processes get that do the
same work side by side in the same run. The second lets evaluation times be
log-normal (sigma 1), where a barrier waits for the slowest.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.runs import run, undisturbed

ISLANDS, HOSTS, ROUNDS = 8, 2, 3
EXPERIMENT = """
name: schedules
epochs: {epochs}
epoch: 1
hosts: 2
schedule: {schedule}
islands:
  i:
    kind: benchmarks.timed_work:TimedWorkKind
    count: {islands}
    population: {population}
    growth: {{ms: {ms}, sigma: {sigma}}}
    fitness: {{ones: {{goal: maximise}}}}
    algorithm: {{elite: 1, tournament: 2, crossover: 0.0, mutation: 1.0}}
channels:
  - {{kind: migrants, topology: {topology}, count: 1}}
forms: {{best: 0}}
log: {{flush_generations: 250}}
"""
BUSY = ((1.0, 1000, 0.65), (20.0, 100, 0.95), (200.0, 15, 0.99))
"""Milliseconds of work an island and epoch, epochs, and the least share that is to be busy with it."""

SPIN = """
import sys, time
began = time.perf_counter()
for _ in range(int(sys.argv[1])):
    ends = time.thread_time() + float(sys.argv[2])
    while time.thread_time() < ends:
        pass
print(time.perf_counter() - began)
"""
SPARSE = ("ring", "{name: torus, rows: 2, columns: 4}")
UNEVEN_EPOCHS, EVALUATIONS = 150, 8
"""Of the runs with log-normal times: epochs, and evaluations an island and epoch, of a millisecond on average."""

MOST_IDLE = 0.10


def busy(folder: Path, schedule: str, ms: float, epochs: int) -> float:
    """Give the wall time of a run, in the best round."""
    made = {"islands": ISLANDS, "population": 2, "ms": ms, "sigma": 0.0, "topology": "complete"}
    text = EXPERIMENT.format(epochs=epochs, schedule=schedule, **made)
    return min(
        undisturbed(lambda turn: float(run(folder, text, f"{schedule}-{ms:g}-{turn}")["stepped_s"]), rounds=ROUNDS)
    )


def plain(ms: float, epochs: int) -> float:
    """Give the wall time of two processes that do the work of that run and nothing else, in the best round."""
    # The first population is two individuals an island; each epoch breeds one.
    command = [sys.executable, "-c", SPIN, str(ISLANDS // HOSTS * (epochs + 2)), str(ms / 1e3)]

    def once(turn: int) -> float:
        del turn
        pair = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(HOSTS)]
        return max(float(process.communicate()[0]) for process in pair)

    return min(undisturbed(once, rounds=ROUNDS))


def uneven(folder: Path, schedule: str, topology: str) -> tuple[float, float]:
    """Give the wall time and the idle share of a run whose evaluation times are log-normal, in the best round."""
    made = {"epochs": UNEVEN_EPOCHS, "islands": ISLANDS, "population": EVALUATIONS + 1, "ms": 1.0, "sigma": 1.0}
    text = EXPERIMENT.format(schedule=schedule, topology=topology, **made)
    told = [run(folder, text, f"{schedule}-{topology[:4].strip('{')}-{turn}") for turn in range(ROUNDS)]
    best = min(told, key=lambda one: float(one["stepped_s"]))
    return float(best["stepped_s"]), 1 - float(best["busy"])


def main() -> bool:
    """Print the shares and ratios; tell whether all are within their limits."""
    fine = True
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for ms, epochs, least in BUSY:
            alone, work = plain(ms, epochs), ISLANDS * (epochs + 2) * ms / 1e3 / HOSTS
            print(f"schedules: two plain processes, {ms:g} ms: {work / alone:.3f} of two cores", flush=True)
            for schedule, limit in (("dataflow", f"at least {least:g}"), ("barrier", "told, not limited")):
                wall = busy(folder, schedule, ms, epochs)
                fine &= schedule != "dataflow" or alone / wall >= least
                print(f"schedules: {schedule}, complete, {ms:g} ms: {work / wall:.3f} of two cores, ", end="")
                print(f"{alone / wall:.3f} of what the plain ones got ({limit})", flush=True)
        for topology in SPARSE:
            barrier, idle = uneven(folder, "barrier", topology)
            print(f"schedules: barrier, {topology}, log-normal: {barrier:.2f} s, {idle:.3f} idle", flush=True)
            for schedule in ("dataflow", "async"):
                wall, idle = uneven(folder, schedule, topology)
                fine &= wall < barrier and idle < MOST_IDLE
                print(
                    f"schedules: {schedule}, {topology}, log-normal: {wall:.2f} s, {wall / barrier:.3f} of the ", end=""
                )
                print(f"barrier's (under 1), {idle:.3f} idle (under {MOST_IDLE:g})", flush=True)
    return fine


if __name__ == "__main__":
    raise SystemExit(not main())
