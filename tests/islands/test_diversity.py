"""Diversity is the mean pairwise Hamming distance, whatever the lengths."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from islands.diversity import hamming_diversity

genomes = st.lists(st.lists(st.integers(0, 3), max_size=6).map(tuple), min_size=2, max_size=7)


def plain(demes: list[tuple[int, ...]]) -> float:
    longest = max(map(len, demes))
    padded = [genome + (None,) * (longest - len(genome)) for genome in demes]
    pairs = [(a, b) for place, a in enumerate(padded) for b in padded[:place]]
    return np.mean([sum(x != y for x, y in zip(a, b, strict=True)) / longest for a, b in pairs]) if longest else 0.0


@given(genomes)
def test_it_equals_the_plain_reference(demes) -> None:
    assert hamming_diversity(demes) == pytest.approx(plain(demes), abs=1e-12)


def test_known_values() -> None:
    assert hamming_diversity([(0, 1), (0, 1)]) == 0
    assert hamming_diversity([(0, 1), (1, 0)]) == 1
    assert hamming_diversity([(0, 1), (0, 0)]) == 0.5
    assert hamming_diversity([(0,), (0, 0)]) == 0.5
    assert hamming_diversity([(2**62, 0), (2**62, 1)]) == 0.5
    assert hamming_diversity([(0, 1)]) is None
    assert hamming_diversity([]) is None
    assert hamming_diversity([(), ()]) == 0
