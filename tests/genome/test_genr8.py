"""Genr8's grammar, its profiles, and repair."""

import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_mapper import OutOfGenesError, ReferenceMapper, TooLongError

from genome import _kernels as kernels
from genome.bnf import parse_bnf
from genome.errors import InputError
from genome.genr8 import Genr8Genome, Genr8Mapper, Mapped, compile_kernels, load_grammar, of_profile
from genome.mapping import Derivation, Mapper, Unmapped
from genome.program import Labels
from genome.settings import validated

HERE = Path()
GENR8 = load_grammar("genr8", HERE)
PAPER = (212, 187, 632, 832, 800, 517, 338, 39, 878, 185, 954, 863)
GENOMES = st.lists(st.integers(0, 999), min_size=20, max_size=250)


def lines_of(found):
    assert isinstance(found, Mapped)
    assert found.text.endswith("\n")
    return found.text.splitlines()


def with_rules(text):
    """A grammar whose <Rules> are given, to test repair by."""
    return parse_bnf(
        f"<L> ::= Edge + Edge + Edge ';' {text} Angle 45 ';' BranchAngle 30\n<Successor> ::= Edge", "g.bnf"
    )


class TestTheWorkedExample:
    def test_the_axiom_of_the_paper(self):
        found = Genr8Mapper(GENR8, "paper").map(PAPER * 20)
        assert lines_of(found)[0] == "Edge2 + Edge0 + Edge0 + Edge2"

    def test_the_next_gene_read_is_878(self):
        mapper = Mapper(of_profile(GENR8, "paper"), Labels())
        after_the_start_symbol = Derivation("", 0, genes_read=1, labels=2)
        found = mapper.derive(PAPER, "Axiom", 1, after_the_start_symbol)
        assert found.text == "Edge2 + Edge0 + Edge0 + Edge2"
        assert PAPER[found.genes_read] == 878
        assert found.labels == 3

    def test_by_default_each_turn_of_the_axiom_reads_a_gene(self):
        genes = (0, 0, 2, 1, 0, 0, 1, 1, 1, 2, 0, *[0] * 200)
        assert lines_of(Genr8Mapper(GENR8).map(genes))[0] == "Edge2 ~ + Edge0 + Edge1 ~ + Edge2"

    def test_the_paper_keeps_other_options(self):
        texts = [lines_of(Genr8Mapper(GENR8, "paper").map((0, 0, 0, 0, 0, 0, 0, *[gene] * 200))) for gene in (0, 1)]
        assert any("Sync" in text for text in texts)


def test_the_shipped_grammar_is_figure_6_with_three_mandatory_edges():
    assert GENR8.start == "L-System"
    assert {name: len(found) for name, found in GENR8.rules.items()} == {
        "L-System": 1,
        "Axiom": 1,
        "RewriteRule": 1,
        "Successor": 1,
        "Predecessor": 4,
        "Modifier": 10,
        "AngleValue": 2,
        "BranchAngleValue": 5,
    }


LABEL = r"Edge\d+"
SYMBOLS = rf"(?:{LABEL}|[-+&^\\/~\[\]])"
LINE = {
    "axiom": re.compile(rf"{LABEL}(?: ~)?(?: \+ {LABEL}(?: ~)?){{2,}}"),
    "rule": re.compile(
        rf"(?:{LABEL}(?: {LABEL})*|{LABEL} < {LABEL}|{LABEL} > {LABEL}|{LABEL} < {LABEL} > {LABEL})"
        rf" -> (?:{SYMBOLS} )*{LABEL}"
    ),
}


@settings(max_examples=300, deadline=None)
@given(GENOMES, st.sampled_from(["default", "paper"]), st.integers(1, 12))
def test_every_mapped_genome_is_a_rule_file(genes, profile, max_depth):
    found = Genr8Mapper(GENR8, profile, max_depth=max_depth).map(genes)
    if isinstance(found, Unmapped):
        return
    lines = lines_of(found)
    assert LINE["axiom"].fullmatch(lines[0])
    tail = [line for line in lines if "->" not in line][1:]
    assert re.fullmatch(r"Angle (30|45)\n(Sync\n)?BranchAngle (15|30|45|60|75)", "\n".join(tail))
    rules = lines[1 : len(lines) - len(tail)]
    assert rules
    for rule in rules:
        assert LINE["rule"].fullmatch(rule)
        successor = rule.split(" -> ")[1].split()
        for left, right in ("[]", "+-", "&^", "\\/"):
            assert successor.count(left) == successor.count(right)


@settings(max_examples=300, deadline=None)
@given(GENOMES, st.integers(1, 12))
def test_after_repair_every_label_has_a_rule_and_repaired_rules_come_last_in_order(genes, max_depth):
    found = Genr8Mapper(GENR8, max_depth=max_depth).map(genes)
    if isinstance(found, Unmapped):
        return
    lines = lines_of(found)
    rules = [line.split(" -> ")[0] for line in lines if "->" in line]
    mains = [re.sub(r".* <|>.*", "", rule).split() for rule in rules]
    used = {int(n) for n in re.findall(r"Edge(\d+)", found.text)} | {0, 1}
    assert {int(word[4:]) for main in mains for word in main} == used == set(range(len(used)))
    assert list(found.repaired) == sorted(set(found.repaired))
    last = rules[len(rules) - len(found.repaired) :]
    assert last == [f"Edge{label}" for label in found.repaired]
    before = {word for main in mains[: len(rules) - len(last)] for word in main}
    assert not before & set(last)


@settings(max_examples=300, deadline=None)
@given(GENOMES, st.sampled_from(["default", "paper"]), st.integers(1, 12), st.integers(0, 2), st.integers(20, 300))
def test_mapping_and_repair_equal_plain_recursion(genes, profile, max_depth, wraps, max_tokens):
    plain = ReferenceMapper(of_profile(GENR8, profile), Labels(), max_depth, wraps, max_tokens)
    found = Genr8Mapper(GENR8, profile, max_depth, wraps, max_tokens).map(genes)
    try:
        text, repaired = plain.map_with_repair(genes, "Successor", 2)
    except (OutOfGenesError, TooLongError):
        assert isinstance(found, Unmapped)
    else:
        assert found == Mapped(text, plain.reads, tuple(repaired))


TOKENS = ("Edge", "EdgeX", "'<'", "'>'", "->", "';'", "Edge7", "Edge99999999999999999999", "Edges", "+")


@settings(max_examples=200, deadline=None)
@given(
    st.lists(st.sampled_from(TOKENS), min_size=1, max_size=14),
    st.lists(st.integers(0, 20), min_size=8, max_size=60),
)
def test_any_sentence_is_repaired_as_plain_recursion_does(tokens, genes):
    grammar = parse_bnf(f"<L> ::= {' '.join(tokens)}\n<Successor> ::= Edge | + Edge", "drawn")
    plain = ReferenceMapper(grammar, Labels(), 8)
    found = Genr8Mapper(grammar).map(genes)
    try:
        text, repaired = plain.map_with_repair(genes, "Successor", 1)
    except OutOfGenesError:
        assert isinstance(found, Unmapped)
    else:
        assert found == Mapped(text, plain.reads, tuple(repaired))


class TestRepair:
    def test_each_label_without_a_rule_gets_one_from_the_genes_that_follow(self):
        # Edge1, Edge0, Edge2; the rule of Edge1 reads a label each side; then 0 and 2 are repaired
        found = Genr8Mapper(with_rules("Edge -> Edge ';'")).map((0, 1, 0, 2, 1, 1, 9, 0, 9, 2, 5))
        assert found == Mapped(
            "Edge1 + Edge0 + Edge2\nEdge1 -> Edge1\nEdge0 -> Edge0\nEdge2 -> Edge2\nAngle 45\nBranchAngle 30\n",
            10,
            (0, 2),
        )

    def test_a_label_that_repair_brings_is_repaired_too(self):
        found = Genr8Mapper(with_rules("Edge -> Edge ';'")).map((0, 1, 0, 1, 1, 1, 9, 2, 9, 3, 9, 0))
        assert lines_of(found)[1:5] == ["Edge1 -> Edge1", "Edge0 -> Edge2", "Edge2 -> Edge3", "Edge3 -> Edge0"]
        assert found.repaired == (0, 2, 3)

    def test_a_context_is_no_rule_and_a_list_is_one_for_each(self):
        text = "Edge '<' Edge '>' Edge -> Edge ';' Edge Edge -> Edge ';'"
        genes = (0, 0, 0, 0, 2, 1, 0, 1, 0, 3, 1, 9, 1)
        found = Genr8Mapper(with_rules(text)).map(genes)
        assert lines_of(found)[1:3] == ["Edge2 < Edge1 > Edge0 -> Edge1", "Edge0 Edge3 -> Edge1"]
        assert found.repaired == (2,)

    def test_labels_0_and_1_are_in_use_from_the_start(self):
        found = Genr8Mapper(with_rules("Edge -> Edge ';'")).map((0, 2, 2, 2, 2, 2, *[2] * 10))
        assert found.repaired == (0, 1)

    def test_repaired_rules_stand_behind_the_axiom_where_there_are_no_others(self):
        found = Genr8Mapper(with_rules("")).map((0, 0, 0, 0, 9, 1, 9, 1))
        assert lines_of(found) == [
            "Edge0 + Edge0 + Edge0",
            "Edge0 -> Edge1",
            "Edge1 -> Edge1",
            "Angle 45",
            "BranchAngle 30",
        ]

    def test_genes_that_run_out_in_repair_say_so(self):
        found = Genr8Mapper(with_rules(""), wraps=0).map((0, 0, 0, 0, 9, 1))
        assert found == Unmapped("the genome ran out after 6 genes (0 wraps of 6), while repairing Edge1")

    def test_repair_counts_towards_the_longest_text(self):
        plain = Genr8Mapper(with_rules(""), max_tokens=12)
        assert plain.map((0, 0, 0, 0, 9, 1, 9, 1)) == Unmapped("the text grew past 12 tokens, while repairing Edge1")

    def test_a_successor_in_repair_stands_as_deep_as_in_a_rule(self):
        # <Modifier> stands at depth 3: with max_depth 4 it may only take productions without non-terminals
        found = Genr8Mapper(GENR8, max_depth=4).map([1] * 300)
        assert not re.search(r"-> [-+&^\\/~]", found.text) if isinstance(found, Mapped) else True
        deeper = Genr8Mapper(GENR8, max_depth=5).map((*[0] * 40, 0, 1, 1, 0, 0, 1, 1) * 5)
        assert isinstance(deeper, Mapped)

    def test_a_grammar_without_labels_is_not_repaired(self):
        plain = parse_bnf("<L> ::= A + B + A ';' A -> B ';' Angle <v> ';' BranchAngle <v>\n<v> ::= 30 | 45", "g.bnf")
        assert Genr8Mapper(plain).map((0, 0, 1)) == Mapped("A + B + A\nA -> B\nAngle 30\nBranchAngle 45\n", 3, ())

    def test_a_grammar_with_labels_needs_a_successor(self):
        with pytest.raises(InputError) as caught:
            Genr8Mapper(parse_bnf("<L> ::= Edge -> Edge", "g.bnf"))
        assert str(caught.value) == (
            "g.bnf: expected a production <Successor> (repair expands it), got none; name it so, or add it"
        )


class TestLoading:
    def test_an_unknown_name_suggests_the_near_one(self):
        with pytest.raises(InputError) as caught:
            load_grammar("gener8", HERE)
        assert str(caught.value) == (
            "grammar: expected a grammar's name or file, got 'gener8'; "
            "did you mean 'genr8'?; a file's name ends in .bnf"
        )

    def test_a_file_is_read_from_the_base_folder(self, tmp_path):
        (tmp_path / "own.bnf").write_bytes(b"\xef\xbb\xbf<a> ::= x\r\n")
        assert load_grammar("own.bnf", tmp_path).start == "a"

    @pytest.mark.parametrize("content", [None, b"<a> ::= \xff"])
    def test_a_file_that_cannot_be_read_is_named(self, tmp_path, content):
        if content:
            (tmp_path / "own.bnf").write_bytes(content)
        got = "bytes that are not UTF-8" if content else "No such file or directory"
        with pytest.raises(InputError) as caught:
            load_grammar("own.bnf", tmp_path)
        assert str(caught.value) == (
            f"{tmp_path / 'own.bnf'}: expected a readable grammar file, got {got}; "
            "check the path, from the experiment's folder"
        )


def test_the_kernels_can_be_compiled_ahead():
    compile_kernels()
    assert kernels.expand_with_repair.signatures


@pytest.mark.parametrize("genes", [(0, -1), (2**63,), (0.5,), ("a",)])
def test_genes_that_are_no_integers_of_zero_or_more_are_refused(genes):
    with pytest.raises(InputError, match=r"^genome: expected integers from 0"):
        Genr8Mapper(GENR8).map(genes)


def test_an_empty_genome_maps_to_nothing():
    assert Genr8Mapper(GENR8).map(()) == Unmapped("the genome has no genes")


class TestSettings:
    def test_the_defaults_map_nearly_every_random_genome(self):
        import numpy as np

        from genome.integers import random_genes

        chosen = Genr8Genome()
        mapper = chosen.mapper(HERE)
        rng = np.random.default_rng(2)
        found = [mapper.map(random_genes(rng, chosen.length, chosen.gene_ceiling)) for _ in range(1000)]
        assert sum(isinstance(each, Mapped) for each in found) == 1000
        assert max(each.genes_read for each in found) <= 2 * chosen.length

    @pytest.mark.parametrize(
        ("data", "message"),
        [
            ({"lenght": 3}, "x.yaml: lenght: expected a known key, got 'lenght'; did you mean 'length'?"),
            ({"length": 1}, "x.yaml: length: expected greater than or equal to 2, got 1"),
            ({"gene_mutation": 1.5}, "x.yaml: gene_mutation: expected less than or equal to 1, got 1.5"),
            ({"profile": "papr"}, "x.yaml: profile: expected 'default' or 'paper', got 'papr'"),
        ],
    )
    def test_bad_settings_are_refused(self, data, message):
        with pytest.raises(InputError) as caught:
            validated(Genr8Genome, data, "x.yaml")
        assert str(caught.value) == message
