"""The kind `bits`: its functions in closed form, its operators by conservation and distribution."""

from __future__ import annotations

import itertools
import time
from collections import Counter

import numpy as np
import pytest
from archipelagos import spec
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from genome.errors import InputError
from islands.individual import Evaluation
from islands.kinds.bits import BitsBiology, BitsGrowth, BitsKind, leading_ones, lolz, ones, rivalry, trap
from islands.kinds.protocol import Biology, Kind, Symbiotic
from islands.kinds.registry import resolve_kind
from islands.kinds.trade import gives, takes
from islands.migration.channel import Migrant


def biology(goal: str = "ones", length: int = 12, growth: dict | None = None, **genome) -> BitsBiology:
    made = spec(
        kind="bits",
        genome={"length": length, **genome},
        growth=growth or {"block": 4, "zeros": 2},
        fitness={goal: {"goal": "maximise"}},
    )
    return BitsKind().build(made, time.perf_counter)


def test_it_is_a_kind_by_name_and_its_biology_has_partners() -> None:
    kind = resolve_kind("bits", "x")
    assert isinstance(kind, Kind)
    assert isinstance(biology(), Biology)
    assert isinstance(biology(), Symbiotic)
    lengths = [spec(genome={"length": length}) for length in (12, 12, 16)]
    offered = [gives(kind, "partners", one) for one in lengths]
    assert [one in takes(kind, "partners", lengths[0]) for one in offered] == [True, True, False]
    assert gives(kind, "components", lengths[0]) == ""


@given(st.text("01", min_size=12, max_size=12))
def test_the_functions_are_what_a_reader_of_the_string_counts(text) -> None:
    number, blocks = int(text, 2), BitsGrowth(block=4, zeros=2)
    assert ones(number, 12, blocks) == text.count("1")
    assert leading_ones(number, 12, blocks) == len(text) - len(text.lstrip("1"))
    expected = 0
    for block in (text[0:4], text[4:8], text[8:12]):
        led = len(block) - len(block.lstrip("1"))
        expected += max(led, min(len(block) - len(block.lstrip("0")), 2))
        if led < 4:
            break
    assert lolz(number, 12, blocks) == expected
    worth = [4 if block == "1111" else 3 - block.count("1") for block in (text[0:4], text[4:8], text[8:12])]
    assert trap(number, 12, blocks) == sum(worth)


@pytest.mark.parametrize("goal", ["ones", "leading_ones", "lolz", "trap"])
def test_only_all_ones_is_best(goal) -> None:
    made = biology(goal, 8)
    values = {number: made.evaluate(number).fitness for number in range(256)}
    best = max(values.values())
    assert [number for number, value in values.items() if value == best] == [255]


@given(st.text("01", min_size=12, max_size=12), st.text("01", min_size=12, max_size=12))
def test_rivals_are_compared_where_they_are_closest_without_being_even(text, other) -> None:
    blocks = BitsGrowth(block=4)
    ahead = [text[n : n + 4].count("1") - other[n : n + 4].count("1") for n in (0, 4, 8)]
    uneven = [gap for gap in ahead if gap]
    nearest = min(uneven, key=abs, default=0)
    expected = (nearest > 0) - (nearest < 0)
    assert rivalry(int(text, 2), int(other, 2), 12, blocks) == expected
    assert rivalry(int(other, 2), int(text, 2), 12, blocks) == -expected


def test_rivalry_goes_round_in_circles() -> None:
    # Ones in the two blocks: 0 and 1, 2 and 0, 0 and 3. Who has fewer wins, but in the last of the three.
    first, second, third = ("000000100000", "110000000000", "000000111000")
    made = biology("rivalry", growth={"block": 6})
    for one, other in ((first, second), (second, third), (third, first)):
        partner = Migrant(1, other, 0.0, (), "")
        assert made.evaluate_with(int(one, 2), (partner,)).fitness == 1.0, one
        assert made.evaluate(int(one, 2)).fitness == 0.0  # alone there is nobody to beat


def test_what_one_makes_of_partners_is_the_mean_over_them() -> None:
    made = biology("rivalry")
    others = [Migrant(n, made.encode(one), 0.0, (), "") for n, one in enumerate((0, 2**12 - 1, 0))]
    assert made.evaluate_with(0b000100000000, tuple(others)).scores == (("rivalry", 1 / 3),)
    assert made.evaluate_with(0b000100000000, (others[1],)).fitness == -1.0
    assert BitsKind().needs(spec(fitness={"rivalry": {"goal": "minimise"}})) == ("partners",)
    assert BitsKind().needs(spec()) == ()
    with pytest.raises(InputError, match="blocks that fill the string"):
        biology("rivalry", growth={"block": 5})


@given(st.integers(0, 2**12 - 1))
def test_texts_read_back(number) -> None:
    made = biology()
    assert len(made.encode(number)) == 12
    assert made.decode(made.encode(number)) == number


@pytest.mark.parametrize(
    "text", ["", "01", "2" * 12, "0" * 13, "-00000000001", "1_1_1_1_1_11", " 0000000001 ", "\u0661" * 12]
)
def test_a_text_of_another_species_is_no_genotype(text) -> None:
    with pytest.raises(ValueError, match=r"bits in place of 12|not all zeros and ones"):
        biology().decode(text)


@pytest.mark.parametrize("crossover", ["uniform", "one_point"])
@given(first=st.integers(0, 2**12 - 1), second=st.integers(0, 2**12 - 1), seed=st.integers(0, 99))
def test_crossing_keeps_every_bit_of_a_place(crossover, first, second, seed) -> None:
    made = biology(crossover=crossover)
    one, other = made.crossover(first, second, np.random.default_rng(seed))
    assert one & other == first & second
    assert one | other == first | second
    if crossover == "one_point":
        texts = [made.encode(value) for value in (first, second, one, other)]
        cuts = [
            (texts[0][:at] + texts[1][at:], texts[1][:at] + texts[0][at:]) == (texts[2], texts[3])
            or (texts[1][:at] + texts[0][at:], texts[0][:at] + texts[1][at:]) == (texts[2], texts[3])
            for at in range(1, 12)
        ]
        assert any(cuts)


def test_each_bit_flips_with_the_rate_and_the_number_of_flips_is_binomial() -> None:
    made, rng = biology(flip=0.2), np.random.default_rng(4)
    flips = [made.mutate(0, rng) for _ in range(20_000)]
    counts = Counter(one.bit_count() for one in flips)
    expected = stats.binom.pmf(np.arange(13), 12, 0.2) * len(flips)
    seen, hoped = [counts[k] for k in range(7)], list(expected[:7])
    seen.append(len(flips) - sum(seen))
    hoped.append(len(flips) - sum(hoped))
    assert stats.chisquare(seen, hoped).pvalue > 0.001
    places = [sum(one >> place & 1 for one in flips) for place in range(12)]
    assert stats.chisquare(places).pvalue > 0.001


def test_every_string_is_drawn_alike_and_no_flip_means_no_change() -> None:
    made, rng = biology(length=4, growth={"block": 4}, flip=0.0), np.random.default_rng(4)
    counts = Counter(made.random(rng) for _ in range(8000))
    assert stats.chisquare([counts[number] for number in range(16)]).pvalue > 0.001
    assert all(made.mutate(number, rng) == number for number in range(16))


@given(st.lists(st.integers(0, 2**12 - 1), min_size=2, max_size=7))
def test_diversity_is_the_mean_pairwise_distance(numbers) -> None:
    pairs = [(one ^ other).bit_count() / 12 for one, other in itertools.combinations(numbers, 2)]
    assert biology().diversity(numbers) == pytest.approx(sum(pairs) / len(pairs))


def test_agreement_is_with_the_partners_and_nothing_alone() -> None:
    made = biology("agreement", 4, {"block": 4})
    assert made.evaluate(0b1100).fitness == 0.0
    partners = (Migrant(1, "1100", None, (), ""), Migrant(2, "1111", None, (), ""))
    assert made.evaluate_with(0b1100, partners) == Evaluation(0.75, (("agreement", 0.75),))


def test_unknown_criteria_and_blocks_that_do_not_fit_are_refused() -> None:
    with pytest.raises(InputError, match="a criterion of bits, got 'onse'; did you mean 'ones'"):
        biology("onse")
    with pytest.raises(InputError, match="blocks that fill the string, got 5, which does not divide the length of 12"):
        biology("trap", growth={"block": 5})


def test_islands_that_score_differently_have_different_keys() -> None:
    keys = [biology(goal, growth={"block": block}).scoring for goal in ("ones", "trap") for block in (3, 4)]
    assert len(set(keys)) == 4


def test_a_form_is_its_string(tmp_path) -> None:
    (path,) = biology().write_forms(0b101, tmp_path / "x", (), {})
    assert path.read_text(encoding="utf-8") == "000000000101\n"
    with pytest.raises(InputError, match="one of txt, got 'glb'"):
        biology().write_forms(0, tmp_path / "x", ("glb",), {})
