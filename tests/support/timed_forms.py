"""Timed forms for tests of islands: a small plant, its settings, experiments."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from archipelagos import spec

from genome.timed import parse_tl
from genome.timed.genotype import TimedGenotype
from islands.kinds.timed import TimedBiology, TimedKind

PLANT = """#define LIFE 1
#define FORK 30
axiom stem(3, 1)
stem(n, s) @ LIFE : n > 0 -> seg(s) [ +(FORK) seg(0.5*s) ] stem(n - 1, s*0.9)
stem(n, s) @ LIFE -> sphere(0.2*s)
equiv F seg
g seg(l, age) = min(age/LIFE, 1)
"""
NUMBERS = {"LIFE": [0.5, 1.5], "FORK": [5, 80]}
GROWTH = {"time": 4.0, "samples": 3, "max_modules": 400, "max_events": 4000, "turtle": {"sides": 4, "max_parts": 200}}


def plant(text: str = PLANT, seed: int = 0) -> TimedGenotype:
    return TimedGenotype(parse_tl(text, "plant.tl"), seed)


def timed_spec(folder: Path, **changes: Any):
    """Give an island of the plant with every default written out, as the orchestrator does."""
    (folder / "plant.tl").write_text(PLANT, encoding="utf-8")
    made = {"kind": "timed", "genome": {}, "growth": {}, "fitness": {"size": {"goal": "maximise"}}, "base": str(folder)}
    made |= changes
    made["genome"] = {"system": "plant.tl", "numbers": NUMBERS, **made["genome"]}
    made["genome"] = TimedKind.genome.model_validate(made["genome"]).model_dump(mode="json")
    made["growth"] = TimedKind.growth.model_validate({**GROWTH, **made["growth"]}).model_dump(mode="json")
    return spec(**made)


def timed(folder: Path, **changes: Any) -> TimedBiology:
    return TimedKind().build(timed_spec(folder, **changes), lambda: 0.0)


def garden(folder: Path, **changes: Any) -> dict[str, Any]:
    """An experiment of two small islands of plants."""
    (folder / "plant.tl").write_text(PLANT, encoding="utf-8")
    data: dict[str, Any] = {
        "name": "garden",
        "seed": 3,
        "epochs": 4,
        "epoch": 2,
        "backend": "inline",
        "islands": {
            "bed": {
                "kind": "timed",
                "count": 2,
                "population": 8,
                "genome": {"system": "plant.tl", "numbers": NUMBERS},
                "growth": GROWTH,
                "fitness": {"size": {"goal": "target", "value": 8}, "parts": {"goal": "target", "value": 20}},
                "algorithm": {"name": "plus", "crossover": 0.5, "mutation": 0.8},
            }
        },
        "channels": [{"kind": "migrants", "topology": "ring", "among": "bed", "count": 1}],
    }
    return {**data, **changes}
