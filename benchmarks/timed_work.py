"""An island kind whose evaluations take a given time on the processor: all the same, or log-normally distributed.

Named in experiments by its import path, ``benchmarks.timed_work:TimedWorkKind``. How long an evaluation takes hangs on
its genotype alone, so that all schedules do equal work, whatever evolves.
"""

from __future__ import annotations

import hashlib
import math
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import NormalDist
from typing import Any, ClassVar

import numpy as np

from genome.settings import Settings
from growth.protocol import Clock
from islands.individual import Evaluation
from islands.kinds.protocol import Facts, Keep
from islands.spec import IslandSpec


class Word(Settings):
    """Numbers of so many bits."""

    bits: int = 60


class Work(Settings):
    """How long an evaluation takes: ``ms`` on average, with ``sigma`` of its logarithm."""

    ms: float = 1.0
    sigma: float = 0.0


class TimedWork:
    """Breeds numbers; a number's fitness is how many ones it holds."""

    seconds = 1.0
    scoring = "timed work"

    def __init__(self, genome: Word, work: Work, clock: Clock) -> None:
        self.bits, self.work, self.clock = genome.bits, work, clock

    def random(self, rng: np.random.Generator) -> int:
        """Draw a number."""
        return int(rng.integers(2**self.bits))

    def crossover(self, first: int, second: int, rng: np.random.Generator) -> tuple[int, int]:
        """Exchange the bits of a mask."""
        mask = (first ^ second) & int(rng.integers(2**self.bits))
        return first ^ mask, second ^ mask

    def mutate(self, genotype: int, rng: np.random.Generator) -> int:
        """Flip one bit."""
        return genotype ^ (1 << int(rng.integers(self.bits)))

    def encode(self, genotype: int) -> str:
        """Write in decimals."""
        return str(genotype)

    def decode(self, text: str) -> int:
        """Read decimals."""
        return int(text)

    def milliseconds(self, genotype: int) -> float:
        """Give how long the evaluation of a genotype takes."""
        if not self.work.sigma:
            return self.work.ms
        drawn = int.from_bytes(hashlib.blake2b(str(genotype).encode(), digest_size=6).digest(), "big")
        z = NormalDist().inv_cdf((drawn + 0.5) / 2**48)
        return self.work.ms * math.exp(self.work.sigma * z - self.work.sigma**2 / 2)

    def evaluate(self, genotype: int) -> Evaluation:
        """Keep the processor busy, then count ones."""
        ends = time.thread_time() + self.milliseconds(genotype) / 1e3
        while time.thread_time() < ends:
            pass
        ones = float(genotype.bit_count())
        return Evaluation(ones, (("ones", ones),))

    def diversity(self, genotypes: Sequence[int]) -> float | None:
        """Give the share of different numbers."""
        return None if len(genotypes) < 2 else (len(set(genotypes)) - 1) / (len(genotypes) - 1)

    def write_forms(self, genotype: int, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write nothing."""
        del genotype, stem, formats, facts
        return []


class TimedWorkKind:
    """The kind, as the registry wants it."""

    name: ClassVar[str] = "timed_work"
    genome: ClassVar[type[Settings]] = Word
    growth: ClassVar[type[Settings]] = Work

    def build(self, spec: IslandSpec, clock: Clock) -> TimedWork:
        """Make the biology of one island."""
        genome, work = Word.model_validate(dict(spec.genome)), Work.model_validate(dict(spec.growth))
        return TimedWork(genome, work, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep nothing."""
        del keep
        return spec.genome, spec.growth
