"""A small island kind for tests of the engine: bit strings, scored by how many ones they hold (OneMax).

It is named in experiments by its import path, ``bits:BitsKind``, as a user's own kind would be.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from evaluators.fitness import Goal, total
from genome.errors import InputError
from genome.settings import Settings, near
from growth.protocol import Clock
from islands.diversity import hamming_diversity
from islands.individual import Evaluation
from islands.kinds.protocol import Facts, Keep
from islands.spec import IslandSpec

Bits = tuple[int, ...]
CRITERIA = ("ones", "zeros", "edges")


class BitsGenome(Settings):
    length: int = 32
    rate: float = 0.05


class BitsGrowth(Settings):
    """``invert`` makes islands score differently; the others make trouble on purpose."""

    invert: bool = False
    fail_ending: str = ""
    raise_ending: str = ""
    delay_ms: float = 0.0
    only_in_driver: bool = False


class BitsBiology:
    def __init__(self, spec: IslandSpec, clock: Clock) -> None:
        self.genome = BitsGenome.model_validate(dict(spec.genome))
        self.growth = BitsGrowth.model_validate(dict(spec.growth))
        self.goals = {name: Goal.model_validate(dict(goal)) for name, goal in spec.fitness.items()}
        for name in self.goals:
            if name not in CRITERIA:
                raise InputError(spec.where("fitness", name), "a criterion", f"'{name}'", near(name, list(CRITERIA)))
        if self.growth.only_in_driver and "RAY_RAYLET_PID" in os.environ:
            raise InputError(spec.where("growth"), "a machine with the plug-in's data", "this one")
        self.clock = clock
        meaning = [self.growth.model_dump(mode="json"), {k: v.model_dump(mode="json") for k, v in self.goals.items()}]
        self.scoring = hashlib.sha256(json.dumps(meaning, sort_keys=True).encode()).hexdigest()
        self.seconds = 0.01

    def random(self, rng: np.random.Generator) -> Bits:
        return tuple(rng.integers(0, 2, size=self.genome.length).tolist())

    def crossover(self, first: Bits, second: Bits, rng: np.random.Generator) -> tuple[Bits, Bits]:
        cut = int(rng.integers(1, self.genome.length))
        return first[:cut] + second[cut:], second[:cut] + first[cut:]

    def mutate(self, genotype: Bits, rng: np.random.Generator) -> Bits:
        flips = rng.random(len(genotype)) < self.genome.rate
        return tuple(int(bit) ^ int(flip) for bit, flip in zip(genotype, flips, strict=True))

    def encode(self, genotype: Bits) -> str:
        return json.dumps(list(genotype), separators=(",", ":"))

    def decode(self, text: str) -> Bits:
        return tuple(json.loads(text))

    def evaluate(self, genotype: Bits) -> Evaluation:
        started = self.clock()
        if self.growth.delay_ms:
            time.sleep(self.growth.delay_ms / 1e3)
        word = "".join(map(str, genotype))
        if self.growth.raise_ending and word.endswith(self.growth.raise_ending):
            raise ZeroDivisionError(word)
        if self.growth.fail_ending and word.endswith(self.growth.fail_ending):
            return Evaluation(None, error="growth: an ending that fails", notes=(("repair", {"labels": [1]}),))
        ones = sum(genotype)
        scores = {"ones": float(ones), "zeros": float(len(genotype) - ones), "edges": float(word.count("01"))}
        if self.growth.invert:
            scores["ones"], scores["zeros"] = scores["zeros"], scores["ones"]
        ms = (self.clock() - started) * 1e3
        return Evaluation(total(scores, self.goals), tuple(sorted(scores.items())), "", ms, 0.0)

    def diversity(self, genotypes: Sequence[Bits]) -> float | None:
        return hamming_diversity(genotypes)

    def write_forms(self, genotype: Bits, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        if unknown := [suffix for suffix in formats if suffix != "txt"]:
            raise InputError("--format", "txt", unknown[0])
        path = stem.with_name(f"{stem.name}.txt")
        path.write_text("".join(map(str, genotype)), encoding="utf-8")
        return [path]


class BitsKind:
    name: ClassVar[str] = "bits"
    genome: ClassVar[type[Settings]] = BitsGenome
    growth: ClassVar[type[Settings]] = BitsGrowth

    def build(self, spec: IslandSpec, clock: Clock) -> BitsBiology:
        return BitsBiology(spec, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        return spec.genome, spec.growth


def pairs(count: int) -> list[tuple[int, int]]:
    """A topology as a plug-in would bring it."""
    return [(place, place + 1) for place in range(0, count - 1, 2)]
