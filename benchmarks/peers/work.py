"""Atoll's side of the shared problem: the kind ``bits``, with the work of the problem in each evaluation.

Named in experiments by its import path, ``benchmarks.peers.work:WorkKind``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np

from benchmarks.peers.problem import work
from genome.settings import Settings
from growth.protocol import Clock
from islands.individual import Evaluation
from islands.kinds.bits import BitsBiology, BitsGenome
from islands.kinds.protocol import Facts, Keep
from islands.spec import IslandSpec


class Work(Settings):
    """Which times evaluations take."""

    times: Literal["constant", "lognormal"] = "constant"


class WorkBiology:
    """Breeds as the kind ``bits`` does, and works for each score."""

    seconds = 0.1

    def __init__(self, spec: IslandSpec, clock: Clock) -> None:
        self.work = Work.model_validate(dict(spec.growth))
        self.clock = clock
        self.bits = BitsBiology(_plain(spec), clock)
        self.scoring = f"work {self.work.times}"

    def random(self, rng: np.random.Generator) -> int:
        """Draw a string."""
        return self.bits.random(rng)

    def crossover(self, first: int, second: int, rng: np.random.Generator) -> tuple[int, int]:
        """Cross two."""
        return self.bits.crossover(first, second, rng)

    def mutate(self, genotype: int, rng: np.random.Generator) -> int:
        """Flip bits."""
        return self.bits.mutate(genotype, rng)

    def encode(self, genotype: int) -> str:
        """Write zeros and ones."""
        return self.bits.encode(genotype)

    def decode(self, text: str) -> int:
        """Read zeros and ones."""
        return self.bits.decode(text)

    def evaluate(self, genotype: int) -> Evaluation:
        """Work, and count ones."""
        started = self.clock()
        work(self.work.times)
        fitness = float(genotype.bit_count())
        return Evaluation(fitness, (("ones", fitness),), "", (self.clock() - started) * 1e3, 0.0)

    def diversity(self, genotypes: Sequence[int]) -> float | None:
        """Give the mean pairwise Hamming distance."""
        return self.bits.diversity(genotypes)

    def write_forms(self, genotype: int, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write nothing."""
        del genotype, stem, formats, facts
        return []


def _plain(spec: IslandSpec) -> IslandSpec:
    from dataclasses import replace

    return replace(spec, growth={})


class WorkKind:
    """The kind, as the registry wants it."""

    name: ClassVar[str] = "work"
    genome: ClassVar[type[Settings]] = BitsGenome
    growth: ClassVar[type[Settings]] = Work

    def build(self, spec: IslandSpec, clock: Clock) -> WorkBiology:
        """Make the biology of one island."""
        return WorkBiology(spec, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, object], Mapping[str, object]]:
        """Keep nothing."""
        del keep
        return spec.genome, spec.growth
