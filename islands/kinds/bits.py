"""The island kind of bit strings: functions whose behaviour on islands is known, and a species that needs partners.

It has no form. It is there to try channels, topologies and schedules with, and `atoll validate` runs on it.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, ClassVar, Final, Literal, final

import numpy as np
from pydantic import Field

from evaluators.fitness import Goal, total
from genome.errors import InputError
from genome.files import write_whole
from genome.settings import Settings, near
from growth.protocol import Clock
from islands.individual import Evaluation
from islands.kinds.protocol import Facts, Keep
from islands.migration.channel import ChannelKind, Migrant
from islands.spec import IslandSpec

FORMATS: Final = ("txt",)
ALONE: Final = 0.0
"""What agreement with a partner, and what rivalry, are worth while there is no partner."""


class BitsGenome(Settings):
    """Strings of ``length`` bits.

    Attributes
    ----------
    length
        Bits of a string.
    crossover
        ``uniform``: each bit from either parent; ``one_point``: cut at one place.
    flip
        The probability that mutation flips a bit; unset, one over the length. With 0 a mutation changes nothing.
    """

    length: Annotated[int, Field(ge=1, le=1_000_000)] = 64
    crossover: Literal["uniform", "one_point"] = "uniform"
    flip: Annotated[float, Field(ge=0, le=1)] | None = None


class BitsGrowth(Settings):
    """The blocks of the functions that have blocks.

    Attributes
    ----------
    block
        Bits of a block.
    zeros
        Leading zeros of a block that ``lolz`` pays for.
    """

    block: Annotated[int, Field(ge=1)] = 8
    zeros: Annotated[int, Field(ge=0)] = 4


@final
class BitsBiology:
    """Breeds and scores bit strings; see :class:`islands.kinds.protocol.Biology`.

    A genotype is an int whose highest bit is the string's first.

    Parameters
    ----------
    spec
        The island's settings.
    clock
        Not looked at: an evaluation takes microseconds.
    """

    seconds: Final = 0.01

    def __init__(self, spec: IslandSpec, clock: Clock) -> None:
        del clock
        genome = BitsGenome.model_validate(dict(spec.genome))
        growth = BitsGrowth.model_validate(dict(spec.growth))
        self._length: Final = genome.length
        self._full: Final = (1 << genome.length) - 1
        self._flip: Final = 1 / genome.length if genome.flip is None else genome.flip
        self._one_point: Final = genome.crossover == "one_point"
        self._goals: Final = {name: Goal.model_validate(dict(goal)) for name, goal in spec.fitness.items()}
        for name in self._goals:
            known = [*FUNCTIONS, *RELATIONS]
            if name not in known:
                raise InputError(spec.where("fitness", name), "a criterion of bits", f"'{name}'", near(name, known))
        if genome.length % growth.block and BLOCKWISE & self._goals.keys():
            got = f"{growth.block}, which does not divide the length of {genome.length}"
            raise InputError(spec.where("growth", "block"), "blocks that fill the string", got)
        self._functions: Final = tuple((name, FUNCTIONS[name]) for name in sorted(self._goals) if name in FUNCTIONS)
        self._relations: Final = tuple((name, RELATIONS[name]) for name in sorted(self._goals) if name in RELATIONS)
        self._growth: Final = growth
        goals = {name: goal.model_dump(mode="json") for name, goal in sorted(self._goals.items())}
        meaning = [genome.length, growth.model_dump(mode="json"), goals]
        self.scoring: Final = hashlib.sha256(json.dumps(meaning, sort_keys=True).encode()).hexdigest()

    def random(self, rng: np.random.Generator) -> int:
        """Draw a string, each as likely."""
        return _number(rng.bytes(-(-self._length // 8))) & self._full

    def crossover(self, first: int, second: int, rng: np.random.Generator) -> tuple[int, int]:
        """Cross two strings; each bit of theirs is in one of the two offspring."""
        if self._one_point:
            mask = (1 << int(rng.integers(1, self._length))) - 1 if self._length > 1 else 0
        else:
            mask = _number(rng.bytes(-(-self._length // 8))) & self._full
        swapped = (first ^ second) & mask
        return first ^ swapped, second ^ swapped

    def mutate(self, genotype: int, rng: np.random.Generator) -> int:
        """Flip each bit with the probability ``flip``; none may be flipped."""
        count = int(rng.binomial(self._length, self._flip)) if self._flip else 0
        mask = 0
        while mask.bit_count() < count:
            mask |= 1 << int(rng.integers(self._length))
        return genotype ^ mask

    def encode(self, genotype: int) -> str:
        """Write a string as zeros and ones."""
        return f"{genotype:0{self._length}b}"

    def decode(self, text: str) -> int:
        """Read zeros and ones.

        Raises
        ------
        ValueError
            For a text of other signs, or of another length.
        """
        if len(text) != self._length:
            raise ValueError(f"{len(text)} bits in place of {self._length}")
        # A number may have a sign, underscores between its digits, and digits of other scripts.
        if text.count("0") + text.count("1") != len(text):
            raise ValueError("a text that is not all zeros and ones")
        return int(text, 2)

    def evaluate(self, genotype: int) -> Evaluation:
        """Score a string by the criteria that have goals; those of partners are 0 without one."""
        scores = {name: measure(genotype, self._length, self._growth) for name, measure in self._functions}
        scores.update((name, ALONE) for name, _ in self._relations)
        return self._evaluation(scores)

    def evaluate_with(self, genotype: int, partners: tuple[Migrant, ...]) -> Evaluation:
        """Score a string with one partner of each channel; what it makes of them is the mean over them."""
        scores = {name: measure(genotype, self._length, self._growth) for name, measure in self._functions}
        others = [self.decode(one.text) for one in partners] if self._relations else []
        for name, relate in self._relations:
            found = [relate(genotype, other, self._length, self._growth) for other in others]
            scores[name] = sum(found) / len(found)
        return self._evaluation(scores)

    def _evaluation(self, scores: dict[str, float]) -> Evaluation:
        return Evaluation(total(scores, self._goals), tuple(sorted(scores.items())))

    def diversity(self, genotypes: Sequence[int]) -> float | None:
        """Give the mean pairwise Hamming distance over the length."""
        count = len(genotypes)
        if count < 2:
            return None
        if count == 2:
            return (genotypes[0] ^ genotypes[1]).bit_count() / self._length
        text = "".join(map(self.encode, genotypes)).encode()
        ones = (np.frombuffer(text, np.uint8) & 1).reshape(count, self._length).sum(axis=0, dtype=np.int64)
        return int((ones * (count - ones)).sum()) / (count * (count - 1) // 2 * self._length)

    def write_forms(self, genotype: int, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write the string as text (txt)."""
        del facts
        for suffix in formats:
            if suffix not in FORMATS:
                raise InputError("--format", f"one of {', '.join(FORMATS)}", f"'{suffix}'")
        path = stem.with_name(f"{stem.name}.txt")
        write_whole(path, f"{self.encode(genotype)}\n".encode())
        return [path]


@final
class BitsKind:
    """The kind ``bits``."""

    name: ClassVar[str] = "bits"
    genome: ClassVar[type[Settings]] = BitsGenome
    growth: ClassVar[type[Settings]] = BitsGrowth
    variation: ClassVar[frozenset[str]] = frozenset({"crossover", "flip"})

    def gives(self, spec: IslandSpec) -> Mapping[ChannelKind, str]:
        """Give strings of the island's length to partners."""
        return {"partners": f"bits of {spec.genome['length']}"}

    def takes(self, spec: IslandSpec) -> Mapping[ChannelKind, tuple[str, ...]]:
        """Take partners of the island's own length: strings of different lengths do not agree or disagree."""
        return {"partners": (f"bits of {spec.genome['length']}",)}

    def needs(self, spec: IslandSpec) -> tuple[ChannelKind, ...]:
        """Give ``partners`` where what one makes of them is a goal."""
        return ("partners",) if RELATIONS.keys() & spec.fitness.keys() else ()

    def build(self, spec: IslandSpec, clock: Clock) -> BitsBiology:
        """Make the biology of one island."""
        return BitsBiology(spec, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, object], Mapping[str, object]]:
        """Keep nothing: no setting names a file."""
        del keep
        return spec.genome, spec.growth


# -- the functions -----------------------------------------------------------------------------------------------------


def ones(genotype: int, length: int, growth: BitsGrowth) -> float:
    """Count the ones (OneMax)."""
    del length, growth
    return float(genotype.bit_count())


def leading_ones(genotype: int, length: int, growth: BitsGrowth) -> float:
    """Count the ones before the first zero (LeadingOnes; Rudolph 1997)."""
    del growth
    return float(length - (genotype ^ ((1 << length) - 1)).bit_length())


def lolz(genotype: int, length: int, growth: BitsGrowth) -> float:
    """Count leading ones or, up to ``zeros``, leading zeros, block by block up to the first that is not all ones.

    A block that begins with zeros is soon at a dead end (Lässig and Sudholt 2010, "The benefit of migration in parallel
    evolutionary algorithms").
    """
    block, full = growth.block, (1 << growth.block) - 1
    found = 0
    for shift in range(length - block, -1, -block):
        bits = genotype >> shift & full
        if bits != full:
            led = block - (bits ^ full).bit_length()
            return float(found + max(led, min(block - bits.bit_length(), growth.zeros)))
        found += block
    return float(found)


def trap(genotype: int, length: int, growth: BitsGrowth) -> float:
    """Sum over the blocks: a block of ones counts whole, any other its zeros less one (Deb and Goldberg 1993)."""
    block, full = growth.block, (1 << growth.block) - 1
    blocks = [genotype >> shift & full for shift in range(0, length, block)]
    return float(sum(block if bits == full else block - 1 - bits.bit_count() for bits in blocks))


FUNCTIONS: Final[Mapping[str, Callable[[int, int, BitsGrowth], float]]] = {
    "ones": ones,
    "leading_ones": leading_ones,
    "lolz": lolz,
    "trap": trap,
}


# -- what two strings make of each other -------------------------------------------------------------------------------


def agreement(genotype: int, partner: int, length: int, growth: BitsGrowth) -> float:
    """Give the share of bits that are alike."""
    del growth
    return 1 - (genotype ^ partner).bit_count() / length


def rivalry(genotype: int, partner: int, length: int, growth: BitsGrowth) -> float:
    """Tell who has more ones in the block in which the two come closest without being even: 1, or -1, or 0 if in none.

    Of blocks that are equally close the first counts. It is intransitive: one may beat another that beats a third that
    beats the first, and have fewer ones than any whom it beats (after the numbers games of Watson and Pollack 2001,
    "Coevolutionary dynamics in a minimal substrate").
    """
    block, full = growth.block, (1 << growth.block) - 1
    closest = 0
    for shift in range(length - block, -1, -block):
        ahead = (genotype >> shift & full).bit_count() - (partner >> shift & full).bit_count()
        if ahead and (not closest or abs(ahead) < abs(closest)):
            closest = ahead
    return float((closest > 0) - (closest < 0))


RELATIONS: Final[Mapping[str, Callable[[int, int, int, BitsGrowth], float]]] = {
    "agreement": agreement,
    "rivalry": rivalry,
}
BLOCKWISE: Final = frozenset({"lolz", "trap", "rivalry"})


def _number(raw: bytes) -> int:
    return int.from_bytes(raw, "big")
