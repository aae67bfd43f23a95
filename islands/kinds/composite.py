"""Composite individuals: several genotypes under one id, bred part by part and scored as one.

A kind whose individuals are made of parts of other kinds, such as a pair of forms, makes its biology of theirs here,
and says how the parts score together.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final, final

import numpy as np

from islands.individual import Evaluation
from islands.kinds.protocol import Biology, Facts

Parts = tuple[Any, ...]


@final
class CompositeBiology:
    """Breeds and scores individuals of several parts; see :class:`islands.kinds.protocol.Biology`.

    A genotype is a tuple of its parts' genotypes, in the order of ``parts``.

    Parameters
    ----------
    parts
        How each part is bred and written down; at least one.
    joint
        Grows and scores all parts together; failure is a value.
    scoring
        Equal for two islands exactly when their ``joint`` scores alike.
    seconds
        An upper estimate of one scoring's time.
    """

    def __init__(
        self, parts: Sequence[Biology[Any]], joint: Callable[[Parts], Evaluation], scoring: str, seconds: float
    ) -> None:
        self._parts: Final = tuple(parts)
        self._joint: Final = joint
        self.scoring: Final = scoring
        self.seconds: Final = seconds

    def random(self, rng: np.random.Generator) -> Parts:
        """Draw each part."""
        return tuple(part.random(rng) for part in self._parts)

    def crossover(self, first: Parts, second: Parts, rng: np.random.Generator) -> tuple[Parts, Parts]:
        """Cross part with like part, all of them."""
        pairs = [part.crossover(a, b, rng) for part, a, b in zip(self._parts, first, second, strict=True)]
        return tuple(one for one, _ in pairs), tuple(other for _, other in pairs)

    def mutate(self, genotype: Parts, rng: np.random.Generator) -> Parts:
        """Mutate one part, each as likely, and each other one with a chance of one in their number."""
        count = len(self._parts)
        promised = int(rng.integers(0, count))
        chances = rng.random(count)
        return tuple(
            part.mutate(one, rng) if place == promised or chances[place] < 1 / count else one
            for place, (part, one) in enumerate(zip(self._parts, genotype, strict=True))
        )

    def encode(self, genotype: Parts) -> str:
        """Write a JSON list of the parts' encodings, each a string."""
        texts = [part.encode(one) for part, one in zip(self._parts, genotype, strict=True)]
        return json.dumps(texts, ensure_ascii=False, separators=(",", ":"))

    def decode(self, text: str) -> Parts:
        """Read the parts.

        Raises
        ------
        ValueError
            For another number of parts.
        """
        texts: list[str] = json.loads(text)
        return tuple(part.decode(one) for part, one in zip(self._parts, texts, strict=True))

    def evaluate(self, genotype: Parts) -> Evaluation:
        """Score all parts together."""
        return self._joint(genotype)

    def diversity(self, genotypes: Sequence[Parts]) -> float | None:
        """Give the mean of the parts' diversities; ``None`` where no part tells one."""
        found = [part.diversity([one[place] for one in genotypes]) for place, part in enumerate(self._parts)]
        told = [value for value in found if value is not None]
        return math.fsum(told) / len(told) if told else None

    def write_forms(self, genotype: Parts, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write the parts' forms, each under its number."""
        files: list[Path] = []
        for place, (part, one) in enumerate(zip(self._parts, genotype, strict=True), start=1):
            files += part.write_forms(one, stem.with_name(f"{stem.name}-part{place}"), formats, facts)
        return files
