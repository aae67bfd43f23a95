"""The general mapper, against plain recursion and against what the paper says."""

import math

import numpy as np
import pytest
from grammar_strategies import genomes, grammars
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_mapper import OutOfGenesError, ReferenceMapper, TooLongError
from scipy.stats import chisquare

from genome.bnf import parse_bnf
from genome.errors import InputError
from genome.mapping import Derivation, Mapper, Unmapped
from genome.program import Labels


def mapped(text, genes, **limits):
    return Mapper(parse_bnf(text, "g.bnf"), **limits).map(genes)


@settings(max_examples=300, deadline=None)
@given(
    grammars(),
    genomes,
    st.sampled_from([None, Labels(), Labels("a", ("+",), 0)]),
    st.none() | st.integers(1, 8),
    st.integers(0, 3),
    st.integers(0, 80),
)
def test_the_compiled_mapper_equals_plain_recursion(grammar, genes, labels, max_depth, wraps, max_tokens):
    plain = ReferenceMapper(grammar, labels, math.inf if max_depth is None else max_depth, wraps, max_tokens)
    mapper = Mapper(grammar, labels, max_depth, wraps, max_tokens)
    found = mapper.derive(genes)
    try:
        text = plain.map(genes)
    except OutOfGenesError:
        assert found == Unmapped(
            f"the genome ran out after {len(genes) * (wraps + 1)} genes ({wraps} wraps of {len(genes)})"
        )
    except TooLongError:
        assert found == Unmapped(f"the text grew past {max_tokens} tokens")
    else:
        assert found == Derivation(text, len(plain.out), plain.reads, plain.labels)


ARITHMETIC = "<e> ::= <e> <op> <e> | ( <e> ) | x | 1\n<op> ::= + | - | *"


def test_a_grammar_without_labels_maps_plainly():
    assert mapped(ARITHMETIC, (0, 2, 5, 3)) == "x * 1"
    assert mapped(ARITHMETIC, (1, 2)) == "( x )"


def test_a_single_production_costs_a_gene():
    assert mapped("<a> ::= <b>\n<b> ::= x | y", (0, 1)) == "y"
    assert Mapper(parse_bnf("<a> ::= <b>\n<b> ::= x", "g")).derive((7, 7)).genes_read == 2


def test_the_separator_is_free():
    assert mapped("<a> ::= x '' y", (0,), separator="") == "xy"


@pytest.mark.parametrize(
    ("genes", "text"),
    [((0, 0), ""), ((0, 1, 0), "x"), ((0, 1, 1), "x"), ((0, 1, 2, 2), "x x"), ((0, 3, 5, 3, 2), "x x x")],
)
def test_repetition_goes_on_while_the_gene_exceeds_the_counter(genes, text):
    assert mapped("<a> ::= { x }", genes, wraps=0) == text


def test_the_number_of_repetitions_has_the_distribution_of_the_rule():
    rng = np.random.default_rng(1)
    mapper = Mapper(parse_bnf("<a> ::= { x }", "g"))
    counts = np.zeros(5, dtype=int)
    total = 0
    for genes in rng.integers(0, 5040 * 1000, size=(50_000, 40)):
        repeats = mapper.derive(genes).tokens
        total += repeats
        counts[min(repeats, 4)] += 1
    # n repetitions and then a stop: P(n) = (n + 1) / (n + 2)!, that is 1/2, 1/3, 1/8, 1/30, ...
    expected = [(n + 1) / math.factorial(n + 2) for n in range(4)]
    expected.append(1 - sum(expected))
    assert chisquare(counts, 50_000 * np.array(expected)).pvalue > 0.001
    assert total / 50_000 == pytest.approx(math.e - 2, abs=0.015)


@pytest.mark.parametrize(("gene", "text"), [(0, "y"), (1, "x y"), (2, "y"), (213, "x y")])
def test_an_option_is_written_for_an_odd_gene(gene, text):
    assert mapped("<a> ::= [ x ] y", (0, gene)) == text


def test_alternatives_in_a_group_read_one_more_gene():
    assert mapped("<a> ::= { x | y | z }", (0, 1, 2, 2, 0, 0)) == "z x"
    assert mapped("<a> ::= [ x | y ]", (0, 1, 1)) == "y"


def test_labels_start_at_two_and_new_ones_are_counted_as_they_are_written():
    # counts 2, 2, 3, 3, 4: genes mod 3, 3, 4, 4, 5
    assert mapped("<a> ::= Edge Edge Edge Edge Edge", (9, 3, 5, 4, 7, 4), labels=Labels()) == (
        "Edge0 Edge2 Edge0 Edge3 Edge4"
    )


def test_a_bound_label_is_read_once_for_an_instance_and_afresh_inside():
    text = "<a> ::= EdgeX EdgeY EdgeX <b> EdgeX EdgeY Edge\n<b> ::= EdgeX EdgeX"
    genes = (0, 1, 2, 0, 3, 4)
    assert mapped(text, genes, labels=Labels()) == "Edge1 Edge2 Edge1 Edge3 Edge3 Edge1 Edge2 Edge4"


def test_all_rounds_of_a_repetition_share_the_bound_label_of_their_instance():
    assert mapped("<a> ::= { EdgeX Edge }", (0, 1, 2, 0, 2, 1, 0), labels=Labels()) == "Edge2 Edge0 Edge2 Edge1"


DEEP = "<a> ::= <b> y | x <a> | z | { <a> } w\n<b> ::= <a> | <b> b"


@pytest.mark.parametrize(
    ("max_depth", "genes", "text"),
    [
        (1, (0,), "z"),  # only `z` has no non-terminals
        (1, (1,), "z"),
        (2, (1, 7), "x z"),  # depth 1 is one short of 2
        (3, (1, 1, 7), "x x z"),
        (2, (0, 1, 0), "z y"),  # <b> has no plain one: <a> has the least depth
    ],
)
def test_one_short_of_the_greatest_depth_only_short_productions_are_chosen(max_depth, genes, text):
    assert mapped(DEEP, genes, max_depth=max_depth) == text


def test_repetitions_are_read_as_usual_at_the_greatest_depth():
    assert mapped("<a> ::= { x } | <a> y", (1, 1, 2, 0), max_depth=1, wraps=0) == "x x"


def test_the_genome_wraps_around_up_to_its_limit():
    text = "<a> ::= x <a> | y"
    assert mapped(text, (0, 0, 0, 1), wraps=0) == "x x x y"
    assert mapped("<a> ::= <b> <b> <b>\n<b> ::= x | y", (1, 0), wraps=1) == "x y x"
    assert mapped(text, (0, 2), wraps=3) == Unmapped("the genome ran out after 8 genes (3 wraps of 2)")


def test_a_long_text_and_an_empty_genome_are_unmapped():
    assert mapped("<a> ::= x x x", (0,), max_tokens=2) == Unmapped("the text grew past 2 tokens")
    assert mapped("<a> ::= x x x", (0,), max_tokens=3) == "x x x"
    assert mapped("<a> ::= x", ()) == Unmapped("the genome has no genes")


def test_deep_derivations_and_long_texts_need_no_recursion():
    genes = (0,) * 200_000 + (1,)
    assert mapped("<a> ::= x <a> y | z", genes, max_tokens=10**6) == " ".join(["x"] * 200_000 + ["z"] + ["y"] * 200_000)


@pytest.mark.parametrize("genes", [(0, -1), (2**63,), (0.5,), ("a",)])
def test_genes_that_are_no_integers_of_zero_or_more_are_refused(genes):
    with pytest.raises(
        InputError, match=r"^genome: expected integers from 0 to 9223372036854775807, got something else"
    ):
        mapped("<a> ::= x", genes)


def test_terminals_and_separators_may_be_any_text():
    assert mapped("<a> ::= é '日本' ü", (0,), separator=" → ") == "é → 日本 → ü"


def test_large_labels_are_written_whole():
    assert (
        mapped("<a> ::= Edge Edge", (0, 10**18, 999), labels=Labels(first=10**18)) == "Edge1000000000000000000 Edge999"
    )
    counted = mapped(
        "<a> ::= Edge <a> | Edge", [x for n in range(1203) for x in (0, n)] + [1, 0], labels=Labels(first=0)
    )
    assert counted.split() == [*(f"Edge{n}" for n in range(1203)), "Edge0"]


def test_the_largest_gene_is_read():
    assert mapped("<a> ::= Edge", (0, 2**63 - 1), labels=Labels()) == f"Edge{(2**63 - 1) % 3}"
