"""Composite individuals: several genotypes under one id, bred part by part and scored together."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import pytest
from archipelagos import spec
from bits import BitsBiology
from scipy import stats

from islands.individual import Evaluation
from islands.island import Island
from islands.kinds.composite import CompositeBiology
from islands.kinds.protocol import Biology
from islands.migration.routes import Routes
from islands.streams import Purpose, stream


def part(length: int, rate: float = 0.0) -> BitsBiology:
    return BitsBiology(spec(genome={"length": length, "rate": rate}), lambda: 0.0)


def together(genotype) -> Evaluation:
    first, second = genotype[0], genotype[-1]
    return Evaluation(float(sum(a == b for a, b in zip(first, second, strict=False))))


@pytest.fixture
def pair() -> CompositeBiology:
    return CompositeBiology([part(4), part(6)], together, "pair", 0.01)


def rng(epoch: int = 0) -> np.random.Generator:
    return stream(5, 0, Purpose.VARIATION, epoch)


def test_it_is_a_biology_whose_encoding_is_a_list_of_the_parts_own(pair) -> None:
    assert isinstance(pair, Biology)
    genotype = pair.random(rng())
    assert [len(one) for one in genotype] == [4, 6]
    text = pair.encode(genotype)
    assert json.loads(text) == [part(4).encode(genotype[0]), part(6).encode(genotype[1])]
    assert pair.decode(text) == genotype
    with pytest.raises(ValueError, match="zip"):
        pair.decode("[]")
    assert pair.evaluate(((1, 1), (1, 0))).fitness == 1.0


def test_each_part_is_crossed_with_its_like(pair) -> None:
    first, second = ((0,) * 4, (2,) * 6), ((1,) * 4, (3,) * 6)
    one, other = pair.crossover(first, second, rng())
    for a, b, low in zip(one, other, (0, 2), strict=True):
        assert set(a) == set(b) == {low, low + 1}
        assert all(x + y == 2 * low + 1 for x, y in zip(a, b, strict=True))


def test_at_least_one_part_is_mutated_each_as_likely() -> None:
    class Counted:
        def mutate(self, genotype, rng):
            return genotype + 1

    parts = CompositeBiology([Counted()] * 3, together, "x", 0.01)
    draws = rng()
    found = Counter(parts.mutate((0, 0, 0), draws) for _ in range(3000))
    assert (0, 0, 0) not in found
    # One promised, 1/3 each; the two others 1/3 each.
    expected = {1: 1 / 3 * 4 / 9, 2: 2 / 3 * 1 / 3 * 2 / 3, 3: 1 / 9}
    keys = list(found)
    assert len(keys) == 7
    shares = [3000 * expected[sum(key)] for key in keys]
    assert stats.chisquare([found[key] for key in keys], shares).pvalue > 1e-3


def test_diversity_is_the_parts_mean(pair) -> None:
    genotypes = [((0,) * 4, (0,) * 6), ((1, 1, 0, 0), (1,) * 6)]
    assert pair.diversity(genotypes) == pytest.approx(0.75)
    assert pair.diversity(genotypes[:1]) is None


def test_every_part_writes_its_form(pair, tmp_path) -> None:
    files = pair.write_forms(((0,) * 4, (1,) * 6), tmp_path / "best", (), {})
    assert [file.name for file in files] == ["best-part1.txt", "best-part2.txt"]
    assert files[1].read_text() == "111111"


def test_an_island_of_composites_is_bred_like_any_other(pair) -> None:
    rated = CompositeBiology([part(8, 0.05), part(8, 0.05)], together, "pair", 0.01)
    isle = Island(spec(), rated, 5, Routes(()), lambda: 0.0, lambda: None)
    step = isle.advance(isle.begin().state, 25, ())
    assert step.records.generations[-1].best == 8.0
    assert len({row.id for row in step.records.born}) == 250
    again = isle.advance(isle.begin().state, 25, ())
    assert again.state == step.state
