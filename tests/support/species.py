"""Species of bit strings that need each other: friends, houses of parts, skins round bodies; and what changes one."""

from __future__ import annotations

import copy
import json
from typing import Any, ClassVar

import numpy as np
from bits import BitsBiology, BitsKind

from islands.individual import Evaluation
from islands.migration.channel import Migrant


class FriendBiology(BitsBiology):
    """Alone its ones count; with partners the ones that it shares with each. One without ones is no friend."""

    def evaluate_with(self, genotype, partners: tuple[Migrant, ...]) -> Evaluation:
        shared = [sum(a & b for a, b in zip(genotype, self.decode(one.text), strict=True)) for one in partners]
        if any(sum(self.decode(one.text)) == 0 for one in partners):
            return Evaluation(None, error="growth: a partner without ones", growth_ms=1.0)
        value = float(sum(shared))
        return Evaluation(value, (("first", float(shared[0])), ("ones", value)), growth_ms=1.0, evaluation_ms=2.0)


class HouseBiology(BitsBiology):
    """A genotype is a tuple of parts, each an id and a text; it takes new ones from those supplied, and no others."""

    parts: tuple[Migrant, ...] = ()

    def supplied(self, parts):
        if any(one.text == "rubble" for one in parts):
            raise ValueError("rubble")
        changed = copy.copy(self)
        changed.parts = parts
        return changed

    def components(self, genotype) -> tuple[int, ...]:
        return tuple(identity for identity, _ in genotype)

    def random(self, rng: np.random.Generator):
        return tuple(self._drawn(rng) for _ in range(2)) if self.parts else ()

    def crossover(self, first, second, rng):
        return first, second

    def mutate(self, genotype, rng):
        return (*genotype[1:], self._drawn(rng)) if self.parts and len(genotype) > 1 else self.random(rng)

    def encode(self, genotype) -> str:
        return json.dumps(genotype)

    def decode(self, text: str):
        return tuple((identity, part) for identity, part in json.loads(text))

    def evaluate(self, genotype) -> Evaluation:
        if not genotype:
            return Evaluation(None, error="growth: no parts")
        return Evaluation(float(sum(part.count("1") for _, part in genotype)))

    def diversity(self, genotypes):
        return None

    def _drawn(self, rng: np.random.Generator):
        one = self.parts[int(rng.integers(0, len(self.parts)))]
        return one.id, one.text


class SkinBiology(BitsBiology):
    """Its ones count less the ones of the bodies that it surrounds."""

    bodies: tuple[Migrant, ...] = ()

    def surrounded(self, forms):
        if any(one.text == "rubble" for one in forms):
            raise ValueError("rubble")
        changed = copy.copy(self)
        changed.bodies = forms
        changed.scoring = self.scoring + "".join(one.text for one in forms)
        return changed

    def evaluate(self, genotype) -> Evaluation:
        taken = sum(one.text.count("1") for one in self.bodies)
        return Evaluation(float(sum(genotype) - taken), (("ones", float(sum(genotype))),))


class BodyBiology(BitsBiology):
    """Shows its form, a word, and has none to show where it begins with 1."""

    def offer(self, genotype, kind: str) -> str:
        if genotype[0]:
            raise ValueError(f"no form for {kind}")
        return f"{kind}:{''.join(map(str, genotype))}"


class _Kind(BitsKind):
    biology: ClassVar[Any] = BitsBiology

    def build(self, spec, clock):
        return self.biology(spec, clock)


class FriendKind(_Kind):
    name: ClassVar[str] = "friend"
    biology: ClassVar[Any] = FriendBiology
    gives: ClassVar[dict] = {"partners": "bits"}
    takes: ClassVar[dict] = {"partners": ("bits",)}


class HouseKind(_Kind):
    name: ClassVar[str] = "house"
    biology: ClassVar[Any] = HouseBiology
    takes: ClassVar[dict] = {"components": ("bits",)}
    needs: ClassVar[tuple] = ("components",)


class SkinKind(_Kind):
    name: ClassVar[str] = "skin"
    biology: ClassVar[Any] = SkinBiology
    gives: ClassVar[dict] = {"components": "bits"}
    takes: ClassVar[dict] = {"surroundings": ("word",)}


class BodyKind(_Kind):
    name: ClassVar[str] = "body"
    biology: ClassVar[Any] = BodyBiology
    gives: ClassVar[dict] = {"surroundings": "word", "components": "bits"}


class Inverted:
    """An adapter from bits to bits that turns every bit over, and breaks on a genome without ones."""

    source: ClassVar[tuple[str, ...]] = ("bits",)
    target: ClassVar[tuple[str, ...]] = ("bits",)

    def build(self, source, target):
        def translate(text: str) -> str:
            genes = json.loads(text)
            if not any(genes):
                raise ValueError("no ones\nat all")
            return json.dumps([1 - gene for gene in genes])

        return translate


class Idle(Inverted):
    """An adapter that makes nothing."""

    def build(self, source, target):
        return None
