"""Words and `.blocks` files, both ways."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from lsystem_strategies import systems, words

from genome.errors import InputError
from genome.lsystem import Branch, LSystem, Rule, Word, decode, encode, format_blocks, parse_blocks, parse_word

FILE = """# A tree.
axiom: G F   # with a label
iterations: 4
seed: 7
F -> F F [+F | -F [ ^ F ] ] (0.25)
F → F&F
G < F > H -> f$%F(1)
H->FZ
H > F -> F
"""


def message(text: str) -> str:
    with pytest.raises(InputError) as caught:
        parse_blocks(text, "x.blocks")
    return str(caught.value)


def test_a_file_becomes_the_system_that_it_says() -> None:
    tip = Word((Branch((Word(("+", "F")), Word(("-", "F", Branch((Word(("^", "F")),)))))),))
    assert parse_blocks(FILE) == LSystem(
        axiom=Word(("G", "F")),
        rules=(
            Rule("F", None, None, 0.25, Word(("F", "F", *tip.items))),
            Rule("F", None, None, 0.75, Word(("F", "&", "F"))),
            Rule("F", "G", "H", 1.0, Word(("£", "$", "%", "F"))),
            Rule("H", None, None, 1.0, Word(("F", "Z"))),
            Rule("H", None, "F", 1.0, Word(("F",))),
        ),
        iterations=4,
        seed=7,
    )


@settings(deadline=None)
@given(systems())
def test_a_written_system_is_read_back_equal(system: LSystem) -> None:
    assert decode(encode(system)) == system
    text = format_blocks(system)
    if system.draws:
        assert parse_blocks(text) == system
    else:
        with pytest.raises(InputError, match="lead from this axiom to an F"):
            parse_blocks(text)


@settings(deadline=None)
@given(words())
def test_a_written_word_is_read_back_equal_and_counts_what_is_written(word: Word) -> None:
    text = str(word)
    assert parse_word(text) == word
    assert word.count == sum(one not in "[]|" for one in text) == len(word.symbols)
    heights = [text[: end + 1].count("[") - text[: end + 1].count("]") for end in range(len(text))]
    assert word.depth == max(heights)


def test_rules_without_a_chance_share_evenly_what_the_others_of_their_head_leave() -> None:
    system = parse_blocks("axiom: F\niterations: 1\nF -> FF\nF -> F+F (0.4)\nF -> F-F\nG < F -> F&F\n")
    assert [rule.chance for rule in system.rules] == [0.3, 0.4, 0.3, 1.0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "x.blocks: expected a line 'axiom: ...', got none; add one, such as 'axiom: F'"),
        ("axiom: F", "x.blocks: expected a line 'iterations: ...', got none; add one, such as 'iterations: 4'"),
        ("axiom:  # none", "x.blocks:1:7: expected a word of one symbol or more, got the end of the line"),
        ("axiom: F\naxiom: F", "x.blocks:2:1: expected 'axiom' once, got a second one; remove it"),
        ("axim: F", "x.blocks:1:1: expected 'axiom', 'iterations' or 'seed' before a colon, got 'axim'"),
        ("axiom: F+x", "x.blocks:1:10: expected a symbol (a capital letter, + - & ^ £ $ %) or a bracket ([ | ])"),
        ("axiom: F[+F", "x.blocks:1:9: expected a ']' for this '[', got the end of the word; brackets must balance"),
        ("axiom: F+F]", "x.blocks:1:11: expected a '[' before this ']', got none; brackets must balance"),
        ("axiom: F|F", "x.blocks:1:9: expected a '[' before this '|', got none; brackets must balance"),
        ("axiom: F[]", "x.blocks:1:10: expected a symbol before this ']', got an empty branch"),
        ("axiom: F[F|]", "x.blocks:1:12: expected a symbol before this ']', got an empty branch"),
        ("axiom: F[|F]", "x.blocks:1:10: expected a symbol before this '|', got an empty branch"),
        ("axiom: F" + "[F" * 101, "x.blocks:1:209: expected at most 100 branches inside each other, got one more"),
        ("iterations: -1", "x.blocks:1:13: expected a whole number from 0 to 1000, got '-1'"),
        ("iterations: 1001", "x.blocks:1:13: expected a whole number from 0 to 1000, got '1001'"),
        ("iterations:", "x.blocks:1:12: expected a whole number from 0 to 1000, got nothing"),
        ("seed: 9223372036854775808", "x.blocks:1:7: expected a whole number from 0 to 9223372036854775807, got '9"),
        ("F F", "x.blocks:1:1: expected 'axiom: ...', 'iterations: ...' or a rule 'F -> ...', got 'F F'"),
        ("+ -> F", "x.blocks:1:1: expected a capital letter before '->', or 'G < F', 'F > H', 'G < F > H', got '+'"),
        (" G < < F -> F", "x.blocks:1:2: expected a capital letter before '->', or 'G < F', 'F > H', 'G < F > H', got"),
        ("F ->  # gone", "x.blocks:1:5: expected a successor of one symbol or more, got none; a letter that no rule"),
        ("F -> (0.5)", "x.blocks:1:5: expected a successor of one symbol or more, got none; a letter that no rule"),
        ("F -> F (0)", "x.blocks:1:9: expected a chance over 0 and up to 1, got '0'"),
        ("F -> F (1.5)", "x.blocks:1:9: expected a chance over 0 and up to 1, got '1.5'"),
        ("F -> F (nan)", "x.blocks:1:9: expected a chance over 0 and up to 1, got 'nan'"),
        ("F -> F ()", "x.blocks:1:9: expected a chance over 0 and up to 1, got ''"),
        (
            "axiom: F\niterations: 1\nF -> F (0.6)\nG < F -> F (0.6)\nF -> FF (0.6)",
            "x.blocks:5:1: expected chances of F that add up to 1 at most, got 1.2 up to this line",
        ),
        (
            "axiom: F\niterations: 1\nF -> F (1)\nF -> FF",
            "x.blocks:4:1: expected a chance left for this rule, got none: the others add up to 1; give it one, such",
        ),
        (
            "iterations: 1\n axiom: G\nG -> H\nH -> F",
            "x.blocks:2:1: expected rules that lead from this axiom to an F, got none; a word without one",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_line_and_column(text: str, said: str) -> None:
    assert message(text).startswith(said)


@pytest.mark.parametrize(
    ("axiom", "rules", "iterations", "draws"),
    [
        ("F", "", 0, True),
        ("F", "F -> G", 1, False),
        ("F", "F -> G", 0, True),
        ("F", "F -> G (0.5)", 1, True),
        ("F", "H < F -> G", 9, True),
        ("F", "H < F -> G\nF -> G", 9, False),
        ("F", "H < F -> G (0.9)\nF -> G", 9, True),
        ("G", "G -> H\nH -> F", 2, True),
        ("G", "G -> H\nH -> F", 1, False),
        ("[+G]", "G > H -> F", 1, True),
        ("F", "F -> G\nG -> F", 999, False),
        ("F", "F -> G\nG -> F", 1000, True),
    ],
)
def test_a_system_draws_where_its_last_word_can_hold_an_f(axiom: str, rules: str, iterations: int, draws: bool) -> None:
    text = f"axiom: {axiom}\niterations: {iterations}\n{rules}\n"
    if draws:
        assert parse_blocks(text).draws
    else:
        assert "lead from this axiom to an F" in message(text)


@pytest.mark.parametrize("items", [("x",), ("FF",), ("[",), ("",), (3,), (Word(("F",)),)])
def test_no_malformed_word_can_be_made(items: tuple) -> None:
    with pytest.raises(InputError):
        Word(items)


@pytest.mark.parametrize("siblings", [(), (Word(),), ("F",), (Word(("F",)), Word())])
def test_no_empty_branch_can_be_made(siblings: tuple) -> None:
    with pytest.raises(InputError):
        Branch(siblings)


GOOD = {"operand": "F", "left": None, "right": None, "chance": 1.0, "successor": Word(("F",))}


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("operand", "f"), ("operand", "+"), ("operand", "FF"), ("operand", None), ("left", ""), ("right", 1),
        ("chance", 0.0), ("chance", 1.1), ("chance", float("nan")), ("chance", 1), ("successor", Word()),
        ("successor", "F"),
    ],
)  # fmt: skip
def test_no_malformed_rule_can_be_made(key: str, value: object) -> None:
    Rule(**GOOD)
    with pytest.raises(InputError, match=f"rule: {key}"):
        Rule(**{**GOOD, key: value})


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("F", "genotype: expected an L-system as a JSON object, got 'F'"),
        ("[1]", "genotype: expected an L-system as a JSON object, got '[1]'"),
        ('{"format":2}', "genotype: format: expected 1, the version of this encoding, got 2"),
        ('{"format":true}', "genotype: format: expected 1, the version of this encoding, got True"),
        ('{"format":1,"sed":2}', "genotype: sed: expected a known key, got 'sed'; did you mean 'seed'?"),
        ('{"format":1,"rules":3}', "genotype: rules: expected a list of rules, got 3"),
        ('{"format":1,"rules":[3]}', "genotype: axiom: expected a word, got None"),
        ('{"format":1,"axiom":"F","rules":[3]}', "genotype: rules.0: expected a rule as a JSON object, got 3"),
        (
            '{"format":1,"axiom":"F","rules":[{"operand":"F","successor":"F]"}]}',
            "genotype: rules.0.successor, character 2: expected a '[' before this ']', got none; brackets must balance",
        ),
        (
            '{"format":1,"axiom":"F","rules":[{"operand":"F","successor":"F","chance":true}]}',
            "genotype: rules.0.chance: expected a number over 0 and up to 1, got True",
        ),
        (
            '{"format":1,"axiom":"F","rules":[],"iterations":1.5,"seed":0}',
            "genotype: iterations: expected a whole number from 0 to 1000, got 1.5",
        ),
        (
            '{"format":1,"axiom":"F","rules":[],"iterations":1,"seed":-1}',
            "genotype: seed: expected a whole number from 0 to 2**63 - 1, got -1",
        ),
    ],
)
def test_no_other_json_is_a_genotype(text: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        decode(text)
    assert str(caught.value) == said


def test_the_encoding_is_what_other_languages_read() -> None:
    system = parse_blocks("axiom: F\niterations: 2\nF -> F£F\nG < F > H -> [F|F] (0.5)\nseed: 3\n")
    assert encode(system) == (
        '{"format":1,"axiom":"F","iterations":2,"rules":[{"operand":"F","successor":"F£F"},'
        '{"operand":"F","left":"G","right":"H","chance":0.5,"successor":"[F|F]"}],"seed":3}'
    )
