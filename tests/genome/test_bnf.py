"""The reader of .bnf files."""

import re

import pytest
from grammar_strategies import grammars, written
from hypothesis import given
from hypothesis import strategies as st

from genome.bnf import parse_bnf
from genome.errors import InputError
from genome.grammar import ENDLESS, Grammar, NonTerminal, Option, Repeat, Terminal, least_depths, shortest

QUOTE, ROUND = "quote a bracket that is a terminal", "alternatives that lead back to it"


def rules(text):
    return dict(parse_bnf(text, "g.bnf").rules)


def seq(*words):
    return tuple(NonTerminal(word[1:-1]) if word.startswith("<") and word[1:] else Terminal(word) for word in words)


def test_a_production_goes_on_until_the_next_one_and_the_first_is_the_start():
    grammar = parse_bnf("# arithmetic\n<e> ::= <e> <op>\n   <e>\n | x   # a variable\n<op> ::= + | *\n", "g.bnf")
    assert grammar.start == "e"
    assert dict(grammar.rules) == {"e": (seq("<e>", "<op>", "<e>"), seq("x")), "op": (seq("+"), seq("*"))}


def test_tokens_need_no_spaces_between_them():
    assert rules("<e>::=<e>+<e>|(<e>)|{x}[y]") == {
        "e": (
            seq("<e>", "+", "<e>"),
            seq("(", "<e>", ")"),
            (Repeat((seq("x"),)), Option((seq("y"),))),
        )
    }


def test_quoted_brackets_are_terminals_of_either_quote():
    assert rules("""<a> ::= '[' "{" '|' "'" '"' '<a>' '# no comment' "::=" """) == {
        "a": (tuple(Terminal(word) for word in ("[", "{", "|", "'", '"', "<a>", "# no comment", "::=")),)
    }


def test_bare_angle_brackets_arrows_and_backslashes_are_terminals():
    assert rules(r"<a> ::= < > -> \ / ~ ^ & <= Edge_i+1 a<b") == {
        "a": (tuple(Terminal(word) for word in ("<", ">", "->", "\\", "/", "~", "^", "&", "<=", "Edge_i+1", "a<b")),)
    }


def test_names_may_have_hyphens_and_inner_spaces():
    assert parse_bnf("<L-System> ::= <if statement>\n<if statement> ::= if", "g").rules["L-System"] == (
        (NonTerminal("if statement"),),
    )


def test_groups_nest_and_hold_alternatives():
    assert rules("<a> ::= { [ x | y z ] | { w } }") == {
        "a": ((Repeat(((Option((seq("x"), seq("y", "z"))),), (Repeat((seq("w"),)),))),),)
    }


def test_an_explicit_empty_terminal_writes_nothing():
    assert rules("<a> ::= '' | x \"\" | { '' }") == {"a": ((), seq("x"), (Repeat(((),)),))}


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_places_count_lines_and_columns_from_one(newline):
    with pytest.raises(InputError) as caught:
        parse_bnf(newline.join(["# first", "<a> ::= x", "  | <b>"]), "g.bnf")
    assert str(caught.value) == ("g.bnf:3:5: expected a name that a production defines, got <b>; defined are <a>")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "g.bnf: expected a grammar, got a text without productions; write <Name> ::= ..."),
        ("# only this\n", "g.bnf: expected a grammar, got a text without productions; write <Name> ::= ..."),
        ("a ::= b", "g.bnf:1:1: expected <Name> ::= ..., got 'a'"),
        ("<a> = b", "g.bnf:1:1: expected <Name> ::= ..., got <a>"),
        (
            "<a> ::= x\n<a> ::= y",
            "g.bnf:2:1: expected one production for each name, got a second <a>; the first is at 1:1; join them with |",
        ),
        (
            "<a> ::= { x",
            "g.bnf:1:12: expected } for the { at 1:9, got the end of the text; quote a bracket that is a terminal",
        ),
        ("<a> ::= { x ]", "g.bnf:1:13: expected } for the { at 1:9, got ']'; quote a bracket that is a terminal"),
        (
            "<a> ::= [ x\n<b> ::= y",
            "g.bnf:2:1: expected ] for the [ at 1:9, got <b>; quote a bracket that is a terminal",
        ),
        (
            "<a> ::= x ] y",
            f"g.bnf:1:11: expected no closing bracket without its opening one, got ']'; {QUOTE}",
        ),
        ("<a> ::=", "g.bnf:1:8: expected a symbol, got the end of the text after an empty alternative; write ''"),
        ("<a> ::= x | | y", "g.bnf:1:13: expected a symbol, got '|' after an empty alternative; write ''"),
        ("<a> ::= { }", "g.bnf:1:11: expected a symbol, got '}' after an empty alternative; write ''"),
        (
            "<a> ::= <b>\n<b> ::=\n<c> ::= x",
            "g.bnf:3:1: expected a symbol, got <c> after an empty alternative; write ''",
        ),
        ("<a> ::= 'x", "g.bnf:1:9: expected a closing ' on the same line, got none; put the other kind round a quote"),
        (
            "<a> ::= x\n ::= y",
            "g.bnf:2:2: expected a name in angle brackets before ::=, got ::= alone; quote it as a terminal",
        ),
        (
            "<a> ::= x | <b>\n<b> ::= <b> x | <a> <b>",
            f"g.bnf:2:1: expected an alternative of <b> that ends, got only {ROUND}; add one without non-terminals",
        ),
        ("<a> ::= " + "{" * 200, "g.bnf:1:109: expected at most 100 groups inside one another, got more"),
    ],
)
def test_bad_grammars_are_refused_with_their_place(text, message):
    with pytest.raises(InputError) as caught:
        parse_bnf(text, "g.bnf")
    assert str(caught.value) == message


def test_recursion_that_an_option_or_a_repetition_can_leave_out_ends():
    assert least_depths(rules("<a> ::= { <a> } x [ <a> ]")) == {"a": 1}


@given(grammars())
def test_reading_what_was_written_gives_the_same_grammar(grammar):
    again = parse_bnf(written(grammar), "drawn")
    assert again == grammar
    assert list(again.rules) == list(grammar.rules)


@given(st.text(alphabet="<>a:=|{}[]'\"# \n", max_size=60))
def test_any_text_is_a_grammar_or_one_clear_error(text):
    try:
        found: object = parse_bnf(text, "g.bnf")
    except InputError as error:
        found = str(error)
    if isinstance(found, Grammar):
        assert all(1 <= depth < ENDLESS for depth in least_depths(found.rules).values())
    else:
        assert re.fullmatch(r"(?s)g\.bnf(:\d+:\d+)?: expected .+, got .+", found)


def test_least_depth_is_the_height_of_the_lowest_tree():
    assert least_depths(rules("<a> ::= <b> <c> | <a>\n<b> ::= x\n<c> ::= <b> | <c> y\n<d> ::= <a>")) == {
        "a": 3,
        "b": 1,
        "c": 2,
        "d": 4,
    }


@pytest.mark.parametrize(
    ("alternatives", "left"),
    [
        ("<a> | x | <b> y | { z }", (1, 3)),
        ("<a> y | <b> | { <a> } <b> | <c>", (1, 2)),
        ("<a> { <b> } | { <b> }", (1,)),
        ("{ <a> } | x { <b> | <c> }", (0, 1)),
    ],
)
def test_at_the_greatest_depth_the_plain_or_the_lowest_are_left(alternatives, left):
    found = rules(f"<a> ::= {alternatives}\n<b> ::= x\n<c> ::= <b>")
    assert shortest(found["a"], least_depths(found)) == left
