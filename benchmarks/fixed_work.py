"""An island kind whose evaluations all cost the same: bit strings, and for each the growth of one and the same surface.

Named in experiments by its import path, ``benchmarks.fixed_work:FixedWorkKind``.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from genome.settings import Settings
from growth.hemls import SurfaceGrowth, grow, parse_system
from growth.protocol import Clock
from islands.diversity import hamming_diversity
from islands.individual import Evaluation
from islands.kinds.protocol import Facts, Keep
from islands.spec import IslandSpec

Bits = tuple[int, ...]
SQUARE = (Path(__file__).parents[1] / "experiments" / "systems" / "square.hemls").read_text(encoding="utf-8")


class BitsGenome(Settings):
    """How long the strings are."""

    length: int = 100


class Work(Settings):
    """How much each evaluation does: growths of the square system of so many steps."""

    steps: int = 4
    times: int = 1


class FixedWork:
    """Breeds bit strings for OneMax and grows a square for each."""

    seconds = 0.1
    scoring = "fixed work"

    def __init__(self, genome: BitsGenome, work: Work, clock: Clock) -> None:
        self.length, self.work, self.clock = genome.length, work, clock
        self.system, self.how = parse_system(SQUARE), SurfaceGrowth(steps=work.steps)

    def random(self, rng: np.random.Generator) -> Bits:
        """Draw a string."""
        return tuple(rng.integers(0, 2, size=self.length).tolist())

    def crossover(self, first: Bits, second: Bits, rng: np.random.Generator) -> tuple[Bits, Bits]:
        """Cross at one point."""
        cut = int(rng.integers(1, self.length))
        return first[:cut] + second[cut:], second[:cut] + first[cut:]

    def mutate(self, genotype: Bits, rng: np.random.Generator) -> Bits:
        """Flip one bit."""
        place = int(rng.integers(self.length))
        return (*genotype[:place], 1 - genotype[place], *genotype[place + 1 :])

    def encode(self, genotype: Bits) -> str:
        """Write as JSON."""
        return json.dumps(genotype, separators=(",", ":"))

    def decode(self, text: str) -> Bits:
        """Read JSON."""
        return tuple(json.loads(text))

    def evaluate(self, genotype: Bits) -> Evaluation:
        """Do the fixed work and count ones."""
        started = self.clock()
        for _ in range(self.work.times):
            grow(self.system, self.how)
        ones = float(sum(genotype))
        return Evaluation(ones, (("ones", ones),), "", (self.clock() - started) * 1e3, 0.0)

    def diversity(self, genotypes: Sequence[Bits]) -> float | None:
        """Give the mean pairwise Hamming distance."""
        return hamming_diversity(genotypes)

    def write_forms(self, genotype: Bits, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write nothing."""
        del genotype, stem, formats, facts
        return []


class FixedWorkKind:
    """The kind, as the registry wants it."""

    name: ClassVar[str] = "fixed_work"
    genome: ClassVar[type[Settings]] = BitsGenome
    growth: ClassVar[type[Settings]] = Work

    def build(self, spec: IslandSpec, clock: Clock) -> FixedWork:
        """Make the biology of one island."""
        genome, work = BitsGenome.model_validate(dict(spec.genome)), Work.model_validate(dict(spec.growth))
        return FixedWork(genome, work, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep nothing."""
        del keep
        return spec.genome, spec.growth
