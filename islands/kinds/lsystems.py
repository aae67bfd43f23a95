"""What all kinds whose genotypes are L-systems share: how these are made, varied and written down."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Final

import numpy as np

from genome.lsystem import (
    LSystem,
    LSystemGenome,
    crossover,
    decode,
    encode,
    mutate,
    random_system,
    system_diversity,
)
from islands.individual import Evaluation


class LSystemBiology(ABC):
    """Breeds L-systems; see :class:`islands.kinds.protocol.Biology`.

    Parameters
    ----------
    genome
        The island's settings.
    """

    def __init__(self, genome: LSystemGenome) -> None:
        self._genome: Final = genome

    def random(self, rng: np.random.Generator) -> LSystem:
        """Draw an L-system."""
        return random_system(self._genome, rng)

    def crossover(self, first: LSystem, second: LSystem, rng: np.random.Generator) -> tuple[LSystem, LSystem]:
        """Cross the production rules of two L-systems."""
        return crossover(first, second, rng, self._genome)

    def mutate(self, genotype: LSystem, rng: np.random.Generator) -> LSystem:
        """Mutate the production rules of an L-system."""
        return mutate(genotype, rng, self._genome)

    def encode(self, genotype: LSystem) -> str:
        """Write an L-system as JSON."""
        return encode(genotype)

    def decode(self, text: str) -> LSystem:
        """Read an L-system."""
        return decode(text)

    def diversity(self, genotypes: Sequence[LSystem]) -> float | None:
        """Give the mean distance of the L-systems."""
        return system_diversity(genotypes)

    @abstractmethod
    def evaluate(self, genotype: LSystem) -> Evaluation:
        """Grow and score an L-system by itself; failure is a value."""
