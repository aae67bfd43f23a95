"""Genomes, their variation, and the fence around the global random stream."""

import random
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import binom, chisquare

from genome.errors import InputError
from genome.fence import fenced
from genome.integers import decode, encode, random_genes
from genome.variation import crossover, mutate

A, B = tuple(range(10)), tuple(range(100, 110))
GENES = st.lists(st.integers(0, 999), max_size=30).map(tuple)
SEEDS = st.integers(0, 2**32)


def rng(seed=0):
    return np.random.default_rng(seed)


class TestGenomes:
    @given(st.lists(st.integers(0, 2**63 - 1)).map(tuple))
    def test_decoding_undoes_encoding(self, genes):
        assert decode(encode(genes)) == genes

    def test_the_encoding_is_a_json_list(self):
        assert encode((212, 187, 0)) == "[212,187,0]"
        assert decode(" [ 1, 2 ] ") == (1, 2)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("[1, 2", "row 3: expected a JSON list of integers, got '[1, 2'"),
            ('{"a": 1}', "row 3: expected a JSON list of integers, got {'a': 1}"),
            ("[1, 2.0]", "row 3: expected integers from 0 to 2**63 - 1, got 2.0"),
            ("[true]", "row 3: expected integers from 0 to 2**63 - 1, got True"),
            ("[-1]", "row 3: expected integers from 0 to 2**63 - 1, got -1"),
            ("[9223372036854775808]", "row 3: expected integers from 0 to 2**63 - 1, got 9223372036854775808"),
            ("[NaN]", "row 3: expected integers from 0 to 2**63 - 1, got nan"),
            ("[" * 100_000, f"row 3: expected a JSON list of integers, got '{'[' * 56}..."),
        ],
    )
    def test_anything_else_is_refused(self, text, message):
        with pytest.raises(InputError) as caught:
            decode(text, "row 3")
        assert str(caught.value) == message

    def test_random_genes_are_plain_integers_uniform_below_the_ceiling(self):
        genes = random_genes(rng(), 100_000, 10)
        assert {type(gene) for gene in genes} == {int}
        counts = Counter(genes)
        assert sorted(counts) == list(range(10))
        assert chisquare([counts[i] for i in range(10)]).pvalue > 0.001


class TestFence:
    def test_what_lies_outside_is_as_it_was(self):
        random.seed(1)
        expected = [random.random() for _ in range(3)]
        random.seed(1)
        first = random.random()
        with fenced(rng()):
            random.random()
        assert [first, random.random(), random.random()] == expected

    def test_it_holds_after_an_exception(self):
        state = random.getstate()
        with pytest.raises(IndexError), fenced(rng()):
            random.choice([])
        assert random.getstate() == state

    def test_only_the_passed_generator_decides(self):
        drawn = []
        for outside in (1, 2):
            random.seed(outside)
            with fenced(rng(7)):
                drawn.append(random.random())
        assert drawn[0] == drawn[1]
        with fenced(rng(8)):
            assert random.random() != drawn[0]

    @given(GENES, GENES, SEEDS, st.sampled_from(["one_point", "two_point"]))
    def test_variation_neither_sees_nor_moves_the_global_stream(self, a, b, seed, kind):
        state = random.getstate()
        first = crossover(a, b, rng(seed), kind), mutate(a, rng(seed), 0.1, 1000)
        assert random.getstate() == state
        random.random()
        assert (crossover(a, b, rng(seed), kind), mutate(a, rng(seed), 0.1, 1000)) == first


class TestCrossover:
    def test_one_point_exchanges_all_behind_the_cut(self):
        for seed in range(50):
            child, other = crossover(A, B, rng(seed))
            cut = child.index(next(gene for gene in child if gene >= 100))
            assert 1 <= cut <= 9
            assert (child, other) == (A[:cut] + B[cut:], B[:cut] + A[cut:])

    def test_two_point_exchanges_what_lies_between(self):
        for seed in range(50):
            child, other = crossover(A, B, rng(seed), "two_point")
            swapped = [gene >= 100 for gene in child]
            first, last = swapped.index(True), 10 - swapped[::-1].index(True)
            assert first >= 1
            assert all(swapped[first:last])
            assert child == A[:first] + B[first:last] + A[last:]
            assert other == B[:first] + A[first:last] + B[last:]

    @pytest.mark.parametrize(("within", "cuts"), [(None, 9), (4, 3), (1, 1), (50, 9)])
    def test_cuts_are_uniform_within_the_genes_that_are_read(self, within, cuts):
        generator = rng(3)
        counts = Counter(sum(gene < 100 for gene in crossover(A, B, generator, within=within)[0]) for _ in range(6000))
        assert sorted(counts) == list(range(1, cuts + 1))
        if cuts > 1:
            assert chisquare(list(counts.values())).pvalue > 0.001

    def test_two_point_within_leaves_the_rest(self):
        for seed in range(30):
            child, other = crossover(A, B, rng(seed), "two_point", within=5)
            assert (child[5:], other[5:]) == (A[5:], B[5:])
            assert child != A

    @settings(max_examples=200)
    @given(GENES, GENES, SEEDS, st.sampled_from(["one_point", "two_point"]), st.none() | st.integers(0, 40))
    def test_every_gene_goes_to_one_child_at_its_place(self, a, b, seed, kind, within):
        child, other = crossover(a, b, rng(seed), kind, within)
        assert sorted(child + other) == sorted(a + b)
        lengths = (len(b), len(a)) if kind == "one_point" and min(len(a), len(b)) > 1 else (len(a), len(b))
        assert (len(child), len(other)) == lengths
        for i in range(min(len(a), len(b))):
            assert {child[i], other[i]} == {a[i], b[i]}

    def test_too_short_parents_come_back(self):
        assert crossover((1,), (2, 3), rng()) == ((1,), (2, 3))
        assert crossover((), (), rng()) == ((), ())


class TestMutation:
    def test_each_gene_is_redrawn_with_its_chance(self):
        generator, parent = rng(4), (5000,) * 200
        changed = np.array([sum(gene != 5000 for gene in mutate(parent, generator, 0.02, 5000)) for _ in range(5000)])
        # the value 5000 lies beyond the ceiling, so that a redrawn gene always shows; 0 changes become 1
        expected = binom.pmf(np.arange(10), 200, 0.02)
        expected[1] += expected[0]
        expected = np.append(expected[1:], 1 - expected[1:].sum())
        counts = np.bincount(np.minimum(changed, 10), minlength=11)[1:]
        assert chisquare(counts, expected * 5000).pvalue > 0.001

    def test_at_least_one_gene_changes_and_is_uniform_over_place_and_value(self):
        generator = rng(6)
        children = [mutate((1, 1, 1), generator, 0.0, 4) for _ in range(6000)]
        counts = Counter(children)
        assert len(counts) == 9
        assert all(sum(x != 1 for x in child) == 1 for child in counts)
        assert chisquare(list(counts.values())).pvalue > 0.001

    def test_the_promised_change_falls_among_the_genes_that_are_read(self):
        generator = rng(8)
        for _ in range(300):
            assert mutate(A, generator, 0.1, 1000, within=3)[:3] != A[:3]

    @given(GENES, SEEDS, st.floats(0, 1), st.integers(2, 2000), st.none() | st.integers(0, 40))
    def test_children_keep_their_length_and_stay_below_the_ceiling(self, genes, seed, rate, ceiling, within):
        child = mutate(genes, rng(seed), rate, ceiling, within)
        assert len(child) == len(genes)
        assert all(
            type(new) is int and (new == old or 0 <= new < ceiling) for new, old in zip(child, genes, strict=True)
        )
        assert child != genes or not genes

    def test_where_nothing_can_change_the_parent_comes_back(self):
        assert mutate((), rng(), 0.5, 10) == ()
        assert mutate((0, 0), rng(), 0.5, 1) == (0, 0)
