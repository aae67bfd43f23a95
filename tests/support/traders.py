"""Island kinds that trade: bit strings that show partners, are assembled from parts, or grow among forms."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from bits import Bits, BitsBiology, BitsGenome, BitsGrowth, BitsKind

from genome.settings import Settings
from growth.protocol import Clock
from islands.individual import Evaluation
from islands.migration.channel import ChannelKind, Migrant
from islands.spec import IslandSpec


def _more(found: Evaluation, score: float) -> Evaluation:
    """The same with a score on top."""
    if found.fitness is None:
        return found
    scores = dict(found.scores) | {"trade": score}
    return replace(found, fitness=found.fitness + score, scores=tuple(sorted(scores.items())))


class GuestBiology(BitsBiology):
    """Scored by how many bits it shares with its partners; shows its word backwards."""

    def evaluate_with(self, genotype: Bits, partners: tuple[Migrant, ...]) -> Evaluation:
        words = [json.loads(partner.text)[::-1] for partner in partners]
        shared = [sum(a == b for a, b in zip(genotype, word, strict=True)) / len(genotype) for word in words]
        return _more(self.evaluate(genotype), sum(shared))

    def offer(self, genotype: Bits, kind: ChannelKind) -> str:
        return json.dumps(list(genotype[::-1])) if kind == "partners" else self.encode(genotype)


class HouseBiology(BitsBiology):
    """Its genotype ends with the word of the part that it was assembled from, after that part's id in 64 bits."""

    parts: tuple[Migrant, ...] = ()

    def supplied(self, parts: tuple[Migrant, ...]) -> HouseBiology:
        made = HouseBiology.__new__(HouseBiology)
        made.__dict__.update(self.__dict__, parts=parts)
        return made

    def components(self, genotype: Bits) -> tuple[int, ...]:
        if len(genotype) == self.genome.length:
            return ()
        return (int("".join(map(str, genotype[self.genome.length : self.genome.length + 64])), 2),)

    def mutate(self, genotype: Bits, rng: np.random.Generator) -> Bits:
        changed = super().mutate(genotype[: self.genome.length], rng)
        if not self.parts:
            return (*changed, *genotype[self.genome.length :])
        part = self.parts[int(rng.integers(len(self.parts)))]
        return (*changed, *(int(bit) for bit in f"{part.id:064b}"), *json.loads(part.text))

    def crossover(self, first: Bits, second: Bits, rng: np.random.Generator) -> tuple[Bits, Bits]:
        length = self.genome.length
        one, other = super().crossover(first[:length], second[:length], rng)
        return (*one, *first[length:]), (*other, *second[length:])

    def evaluate(self, genotype: Bits) -> Evaluation:
        word = genotype[self.genome.length + 64 :]
        return _more(super().evaluate(genotype[: self.genome.length]), float(sum(word)))


class SkinBiology(BitsBiology):
    """Scored also by the forms around it."""

    forms: tuple[Migrant, ...] = ()

    def surrounded(self, forms: tuple[Migrant, ...]) -> SkinBiology:
        made = SkinBiology.__new__(SkinBiology)
        made.__dict__.update(self.__dict__, forms=forms)
        made.scoring = f"{self.scoring}/{[(form.id, form.text) for form in forms]}"
        return made

    def evaluate(self, genotype: Bits) -> Evaluation:
        words = [json.loads(form.text) for form in self.forms]
        overlap = sum(a & b for word in words for a, b in zip(genotype, word, strict=True))
        return _more(super().evaluate(genotype), float(-overlap))

    def offer(self, genotype: Bits, kind: ChannelKind) -> str:
        """Its form hangs on those around it."""
        words = [genotype, *(json.loads(form.text) for form in self.forms)]
        return json.dumps([sum(bits) % 2 for bits in zip(*words, strict=True)])


class GuestKind(BitsKind):
    name: ClassVar[str] = "guest"
    gives: ClassVar[Mapping[str, str]] = {"partners": "word", "components": "part", "surroundings": "form"}
    takes: ClassVar[Mapping[str, tuple[str, ...]]] = {"partners": ("word",)}

    def build(self, spec: IslandSpec, clock: Clock) -> GuestBiology:
        return GuestBiology(spec, clock)


class NeedyKind(GuestKind):
    name: ClassVar[str] = "needy"
    needs: ClassVar[tuple[str, ...]] = ("partners",)


class HouseKind(BitsKind):
    name: ClassVar[str] = "house"
    takes: ClassVar[Mapping[str, tuple[str, ...]]] = {"components": ("part", "beam")}

    def build(self, spec: IslandSpec, clock: Clock) -> HouseBiology:
        return HouseBiology(spec, clock)


class SkinKind(BitsKind):
    name: ClassVar[str] = "skin"
    genome: ClassVar[type[Settings]] = BitsGenome
    growth: ClassVar[type[Settings]] = BitsGrowth
    gives: ClassVar[Mapping[str, str]] = {"surroundings": "form"}
    takes: ClassVar[Mapping[str, tuple[str, ...]]] = {"surroundings": ("form",)}

    def build(self, spec: IslandSpec, clock: Clock) -> SkinBiology:
        return SkinBiology(spec, clock)


class ModelBiology(SkinBiology):
    """Shows partners its form, which hangs on those around it as one of its scores does, and its fitness does not."""

    def evaluate(self, genotype: Bits) -> Evaluation:
        alone, among = BitsBiology.evaluate(self, genotype), super().evaluate(genotype)
        return replace(alone, scores=among.scores) if alone.fitness is not None else alone


class ModelKind(SkinKind):
    name: ClassVar[str] = "model"
    gives: ClassVar[Mapping[str, str]] = {"partners": "word"}

    def build(self, spec: IslandSpec, clock: Clock) -> ModelBiology:
        return ModelBiology(spec, clock)


class JudgeBiology(BitsBiology):
    """Scored by its partners' words, and by their scores."""

    def evaluate_with(self, genotype: Bits, partners: tuple[Migrant, ...]) -> Evaluation:
        words = [json.loads(partner.text) for partner in partners]
        shared = sum(a == b for word in words for a, b in zip(genotype, word, strict=True))
        return _more(self.evaluate(genotype), shared + sum(value for one in partners for _, value in one.scores) / 64)


class JudgeKind(GuestKind):
    name: ClassVar[str] = "judge"

    def build(self, spec: IslandSpec, clock: Clock) -> JudgeBiology:
        return JudgeBiology(spec, clock)


class HollowKind(GuestKind):
    """Says that it takes everything, and can make use of nothing."""

    name: ClassVar[str] = "hollow"
    takes: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "partners": ("word",), "components": ("part",), "surroundings": ("form",)
    }  # fmt: skip

    def build(self, spec: IslandSpec, clock: Clock) -> Any:
        return BitsBiology(spec, clock)


class HalfKind(HollowKind):
    """Takes parts, and cannot say which its genotypes hold."""

    name: ClassVar[str] = "half"

    def build(self, spec: IslandSpec, clock: Clock) -> Any:
        made = BitsBiology(spec, clock)
        made.supplied = lambda parts: made
        return made


class Shorten:
    """An adapter of the tests' bit strings: cut or filled with zeros."""

    source: ClassVar[tuple[str, ...]] = ("bits",)
    target: ClassVar[tuple[str, ...]] = ("bits",)

    def build(self, source: IslandSpec, target: IslandSpec) -> Any:
        length = target.genome["length"]
        if source.genome["length"] > 100:
            from genome.errors import InputError

            raise InputError("", "a source of at most 100 bits", str(source.genome["length"]))
        return lambda text: json.dumps((json.loads(text) + [0] * length)[:length])


def judging(pairing: Mapping[str, Any], **changes: Any) -> dict[str, Any]:
    """Models that wander between islands which score otherwise, among forms that change, shown to a judge."""
    data: dict[str, Any] = {
        "name": "judging",
        "seed": 2,
        "epochs": 10,
        "epoch": 1,
        "backend": "inline",
        "defaults": {
            "population": 6, "genome": {"length": 12}, "fitness": {"ones": {"goal": "maximise"}},
            "algorithm": {"elite": 2, "mutation": 1.0},
        },
        "islands": {
            "sun": {"kind": "traders:GuestKind", "algorithm": {"elite": 1}},
            "model": {"kind": "traders:ModelKind", "count": 2},
            "odd": {"kind": "traders:ModelKind", "count": 2, "growth": {"invert": True}},
            "judge": {"kind": "traders:JudgeKind"},
        },
        "channels": [
            {"kind": "surroundings", "from": "sun", "to": ["model", "odd"], "select": "random", "weight": 0.6},
            {"topology": "ring", "among": ["model", "odd"], "count": 2},
            {"kind": "partners", "from": ["model", "odd"], "to": "judge", **pairing},
        ],
    }  # fmt: skip
    return {**data, **changes}


def trading(**changes: Any) -> dict[str, Any]:
    """Every kind of channel, between species of which one is as long as the other."""
    data: dict[str, Any] = {
        "name": "trading",
        "seed": 3,
        "epochs": 5,
        "epoch": 2,
        "backend": "inline",
        "defaults": {"population": 8, "genome": {"length": 12}, "fitness": {"ones": {"goal": "maximise"}}},
        "islands": {
            "host": {"kind": "traders:NeedyKind", "count": 2},
            "guest": {"kind": "traders:GuestKind", "count": 2},
            "house": {"kind": "traders:HouseKind"},
            "skin": {"kind": "traders:SkinKind"},
            "pelt": {"kind": "traders:SkinKind", "growth": {"fail_ending": "111"}},
            "long": {"kind": "bits:BitsKind", "genome": {"length": 16}},
            "short": {"kind": "bits:BitsKind"},
        },
        "channels": [
            {"topology": "ring", "among": "host", "count": 2},
            {"kind": "partners", "from": "guest", "to": "host", "pairing": "several", "pairings": 3, "count": 2},
            {"kind": "partners", "from": "host", "to": "guest", "join": "matching", "every": 2},
            {"kind": "components", "from": "guest", "to": "house", "count": 3, "keep": 4},
            {"kind": "surroundings", "from": "guest-0", "to": "skin"},
            {"from": "long", "to": "short", "adapter": "traders:Shorten", "count": 3, "mode": "move"},
            {"kind": "surroundings", "from": "skin", "to": "pelt", "count": 2, "every": 2},
        ],
        "log": {"flush_generations": 4},
    }
    return {**data, **changes}
