"""Expressions and `.tl` files, both ways, and what is wrong with them."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from timed_strategies import expressions, written_systems

from genome.errors import InputError
from genome.timed import (
    Binary,
    Birth,
    Call,
    Define,
    Development,
    Equiv,
    Expression,
    Formal,
    Name,
    Number,
    Production,
    Section,
    Sheet,
    TimedSystem,
    Unary,
    decode,
    encode,
    format_expression,
    format_tl,
    parse_expression,
    parse_tl,
)

FILE = """# Everything that a file may have.
#define K 2   # a constant
#define L -K*3
angles radians
equiv f mov
equiv \\ roll
section bar(a) = 1 + cos(a)/3
surface leaf(u, v) = u, v*K, 3
ignore + -
axiom: A(1) @ 0.5 [ -(L) B ] && part(K)
A(j) @ 3.0 : j < 2 -> B @ 0 A(j*2) @ K/2 -(3) +(1)/(2)
B < A(j) > B @ 3.0 -> : 0.25
A(j) @ 3.0 → A(j + 1)...
  @ (3/j) ! C
g A(age, j) = g_mov(2) + age
g mov(x) = x^2
system part(n)
  axiom D(n)
  D(x) -> D(x)
end
"""


def message(text: str) -> str:
    with pytest.raises(InputError) as caught:
        parse_tl(text, "x.tl")
    return str(caught.value)


def test_a_file_becomes_the_system_that_it_says() -> None:
    j, k = Name("j"), Name("K")
    three = Number(3.0)
    assert parse_tl(FILE) == TimedSystem(
        axiom=(
            Birth("A", (Number(1.0),), Number(0.5)), Birth("["), Birth("-", (Name("L"),)), Birth("B"), Birth("]"),
            Birth("&"), Birth("&"), Birth("part", (k,)),
        ),
        productions=(
            Production(
                Formal("A", ("j",)), three, condition=Binary("<", j, Number(2.0)),
                successor=(
                    Birth("B"), Birth("A", (Binary("*", j, Number(2.0)),), Binary("/", k, Number(2.0))),
                    Birth("-", (three,)), Birth("+", (Number(1.0),)), Birth("/", (Number(2.0),)),
                ),
            ),
            Production(Formal("A", ("j",)), three, left=Formal("B"), right=Formal("B"), chance=Number(0.25)),
            Production(
                Formal("A", ("j",)), three,
                (Birth("A", (Binary("+", j, Number(1.0)),), Binary("/", three, j)), Birth("!"), Birth("C")),
            ),
        ),
        developments=(
            Development("A", ("age", "j"), Binary("+", Call("g_mov", (Number(2.0),)), Name("age"))),
            Development("mov", ("x",), Binary("^", Name("x"), Number(2.0))),
        ),
        defines=(Define("K", Number(2.0)), Define("L", Binary("*", Unary("-", k), three))),
        equivs=(Equiv("f", "mov"), Equiv("\\", "roll")),
        ignored=("+", "-"),
        systems=(
            TimedSystem(
                (Birth("D", (Name("n"),)),),
                (Production(Formal("D", ("x",)), successor=(Birth("D", (Name("x"),)),)),),
                name="part", parameters=("n",),
            ),
        ),
        sections=(
            Section("bar", ("a",), Binary("+", Number(1.0), Binary("/", Call("cos", (Name("a"),)), three))),
        ),
        surfaces=(Sheet("leaf", ("u", "v"), (Name("u"), Binary("*", Name("v"), k), three)),),
        radians=True,
    )  # fmt: skip


@settings(max_examples=200)
@given(expressions(("a", "b")))
def test_expressions_are_read_as_they_are_written(expression: Expression) -> None:
    assert parse_expression(format_expression(expression)) == expression


@settings(max_examples=100)
@given(written_systems())
def test_systems_are_read_as_they_are_written(system: TimedSystem) -> None:
    assert parse_tl(format_tl(system)) == system
    assert decode(encode(system)) == system
    assert encode(decode(encode(system))) == encode(system)


@settings(max_examples=300)
@given(st.lists(st.sampled_from([*FILE.split(), *"()[]@:<>+-*/^&|!=,#.\n", "->", "end", "1", "x", " "]), max_size=40))
def test_any_text_is_read_or_refused(pieces: list[str]) -> None:
    for joint in ("", " "):
        try:
            system = parse_tl(joint.join(pieces), "x.tl")
        except InputError as error:
            told = str(error)
            assert told.startswith("x.tl")
        else:
            assert parse_tl(format_tl(system)) == system


@settings(max_examples=300)
@given(st.text("ab1.5+-*/%^&|!<>=()[], #", max_size=30))
def test_any_expression_is_read_or_refused(text: str) -> None:
    try:
        expression = parse_expression(text, "x")
    except InputError as error:
        told = str(error)
        assert told.startswith("x")
    else:
        assert parse_expression(format_expression(expression)) == expression


def test_precedence_is_that_of_c_with_powers_above_signs() -> None:
    for text, same in [
        ("a+b*c", "a+(b*c)"), ("a*b+c", "(a*b)+c"), ("a-b-c", "(a-b)-c"), ("a/b*c", "(a/b)*c"), ("a*b^c", "a*(b^c)"),
        ("-a^b", "-(a^b)"), ("-a*b", "(-a)*b"), ("!a==b", "(!a)==b"), ("a^b^c", "a^(b^c)"), ("a^-b^c", "a^(-(b^c))"),
        ("a<b+c", "a<(b+c)"), ("a==b<c", "a==(b<c)"), ("a&b==c", "a&(b==c)"), ("a|b&c", "a|(b&c)"),
        ("a&&b|c", "a&&(b|c)"),
        ("a||b&&c", "a||(b&&c)"), ("a=b", "a==b"), ("a%b+c", "(a%b)+c"), ("a<b<c", "(a<b)<c"), ("!a^b", "!(a^b)"),
    ]:  # fmt: skip
        assert parse_expression(text) == parse_expression(same)
        assert parse_expression(text.replace("a", "(a)")) == parse_expression(same)


def test_an_operator_behind_a_birth_age_is_a_symbol_where_a_blank_stands_before_it() -> None:
    def word(text: str) -> list[tuple[str, str]]:
        return [(birth.symbol, format_expression(birth.age)) for birth in parse_tl(f"axiom {text}").axiom]

    assert word("A @ 3/2 B") == [("A", "3 / 2"), ("B", "0")]
    assert word("A @ 3 /(2) B") == [("A", "3"), ("/", "0"), ("B", "0")]
    assert word("A @ 0 + B") == [("A", "0"), ("+", "0"), ("B", "0")]
    assert word("A @ 1 * 2 ^ B") == [("A", "1 * 2"), ("^", "0"), ("B", "0")]
    assert word("A @ (1 + 2) & B @ -1+2") == [("A", "1 + 2"), ("&", "0"), ("B", "-1 + 2")]
    assert word("A @ max(1, 2) !(3)") == [("A", "max(1, 2)"), ("!", "0")]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "x.tl: expected a line 'axiom ...', got none; add one, such as 'axiom A(1) @ 0'"),
        ("axiom", "x.tl:1:6: expected a module, got the end of the line"),
        ("axiom A\naxiom A", "x.tl:2:1: expected 'axiom' once, got 'axiom'; remove the second"),
        ("A B", "x.tl:1:1: expected a production with '->', or a line that begins with axiom, #define, equiv, g, se"),
        ("axiom A ?", "x.tl:1:9: expected a symbol, a name, a number or an operator, got '?'"),
        ("axiom A(1", "x.tl:1:10: expected ',', got the end of the line"),
        ("axiom A 3", "x.tl:1:9: expected a symbol: a name or one of + - ^ & / \\ [ ] ! | $ { } ~ ', got '3'"),
        ("axiom A(1 2)", "x.tl:1:11: expected ',', got '2'"),
        ("axiom A(", "x.tl:1:9: expected a number, a name, a function or '(', got the end of the line"),
        ("axiom A @", "x.tl:1:10: expected a number, a name, a function or '(', got the end of the line"),
        ("axiom A @ 0+(3)", "x.tl:1:12: expected a blank before the symbol '+', or parentheses around the birth age"),
        ("axiom A(sine(1))", "x.tl:1:9: expected a function that there is, got 'sine'; did you mean 'sin'?"),
        ("axiom A(sin(1, 2))", "x.tl:1:9: expected 1 argument of sin(), got 2"),
        ("axiom A(" + "(" * 101 + "1", "x.tl:1:110: expected an expression nested at most 100 deep, got '1'"),
        ("axiom A(1" + "+1" * 101 + ")", "x.tl:1:210: expected an expression nested at most 100 deep, got '+'"),
        ("axiom A(1e999)", "x.tl:1:9: expected a number that a double can hold, got '1e999'"),
        ("axiom A(q)", "x.tl:1:9: expected a parameter or a define, got 'q'; known:"),
        ("axiom A(g_B(1))", "x.tl:1:9: expected a function, or the development function of a symbol that has one, got"),
        ("axiom A ]", "x.tl:1:9: expected a '[' before this ']', got none; brackets must balance"),
        ("axiom A [ [ B ]", "x.tl:1:9: expected a ']' for this '[', got none; brackets must balance"),
        ("axiom A\nA -> B ] [", "x.tl:2:8: expected a '[' before this ']', got none; brackets must balance"),
        ("axiom A\n[ -> B", "x.tl:2:1: expected a symbol other than a bracket, got '['; brackets are not rewritten"),
        ("axiom A(1, 2)\nA(x) -> B", "x.tl:1:7: expected 1 parameter of 'A', got 2; a symbol has the same number of"),
        ("axiom A(1)\nA(x) -> A(x, x)", "x.tl:2:9: expected 1 parameter of 'A', got 2"),
        ("axiom A(1)\nA(x) -> B\nA(x, y) -> B", "x.tl:3:1: expected 1 parameter of 'A', got 2"),
        ("axiom B\nB(x) < A -> A\nB -> B", "x.tl:2:1: expected 0 parameters of 'B', got 1"),
        ("axiom A\nA @ 3 -> B\nA @ 4 -> C", "x.tl:3:1: expected the terminal age that 'A' has in its first production"),
        ("axiom A(1)\nA(x) @ x -> B\nA(y) @ 2*y -> C", "x.tl:3:1: expected the terminal age that 'A' has in its first"),
        ("axiom A(1, 2)\nA(x, x) -> B", "x.tl:2:6: expected each name once, got 'x'"),
        ("axiom A(1)\nB(x) < A(x) -> B", "x.tl:2:1: expected each name of a parameter once, got 'x' twice"),
        ("axiom A(1)\nA(age) -> B", "x.tl:2:1: expected names of parameters that have no meaning yet, got 'age'"),
        ("#define K 1\naxiom A(1)\nA(K) -> B", "x.tl:3:1: expected names of parameters that have no meaning yet, go"),
        ("axiom A(1)\nA(t) @ 3 -> A(t) @ 3 / t", "x.tl:2:24: expected a symbol, got 't', a parameter; put a birth a"),
        ("axiom A\nA @ 1 : 1 : 2 -> B", "x.tl:2:11: expected an operator or '->', got ':'"),
        ("axiom A\nA B -> C", "x.tl:2:3: expected '<', '>', '@', ':' or '->', got 'B'"),
        ("axiom A\nA -> B -> C", "x.tl:2:8: expected a symbol: a name or one of"),
        ("axiom A\nA -> B : 0.6\nA -> C : 0.6", "x.tl:3:1: expected chances of 'A' that add up to 1 at most, got 1."),
        ("#define A", "x.tl:1:10: expected a number, a name, a function or '(', got the end of the line"),
        ("#define K 1 2", "x.tl:1:13: expected the end of the line, got '2'"),
        ("#define pi 3\naxiom A", "x.tl:1:9: expected a name that has no meaning yet, got 'pi'"),
        ("#define K L\n#define L 1\naxiom A", "x.tl:1:11: expected a parameter or a define, got 'L'"),
        ("#define K 1\n#define K 2\naxiom A", "x.tl:2:9: expected 'K' defined once, got a second define; remove one"),
        ("#define K random(0, 1)\naxiom A", "x.tl:1:9: expected a constant expression, got one that draws at random"),
        ("equiv f\naxiom A", "x.tl:1:8: expected a symbol: a name or one of"),
        ("equiv f A\nequiv + A\naxiom A", "x.tl:2:9: expected one equiv of 'A', got a second; remove one"),
        ("equiv A B\nequiv B A\naxiom A", "x.tl:2:9: expected equivs that lead to a symbol, got a circle: B A B"),
        ("equiv f [\naxiom A", "x.tl:1:9: expected a symbol other than a bracket, got '['"),
        ("angles grads", "x.tl:1:8: expected 'degrees' or 'radians', got 'grads'"),
        ("axiom A\ng A = 1\ng A = 2", "x.tl:3:3: expected one development function of 'A', got a second; remove one"),
        ("axiom A\ng A(age, age) = 1", "x.tl:2:10: expected each name once, got 'age'"),
        ("axiom A\ng A(age)", "x.tl:2:9: expected '=', got the end of the line; such as 'g A(age, end) = age/end'"),
        ("axiom A(1, 2)\ng A(x) = x", "x.tl:1:7: expected 1 parameter of 'A', got 2"),
        ("axiom A(1, 2)\nA(x, y) -> A(x, y)\ng A(y, z) = 1", "x.tl:3:3: expected the parameters of A: x, y, age or "),
        ("axiom A\ng A = g_B()\ng B = g_A()", "x.tl:2:3: expected development functions that call no circle, got g_"),
        ("axiom A\ng A = g_B(1)\ng B = 1", "x.tl:2:7: expected 0 arguments of g_B(), got 1"),
        ("axiom A\nsystem B\naxiom C", "x.tl:2:8: expected a line 'end' for this system, got the end of the file"),
        ("axiom A\nsystem B\nend", "x.tl:2:8: expected a line 'axiom ...', got none"),
        ("axiom A\nsystem A\naxiom C\nend\nA -> B", "x.tl:2:8: expected neither productions nor a development funct"),
        ("axiom A\nsystem B(n)\naxiom C(n)\nC(x) -> D(n)\nend", "x.tl:4:11: expected a parameter or a define, got 'n'"),
        ("axiom B\nsystem B(n)\naxiom C\nend", "x.tl:1:7: expected 1 parameter of 'B', got 0"),
        ("axiom A\nsection b = 1", "x.tl:2:9: expected the name of an angle, got 'b'; such as 'section b(a) ="),
        ("axiom A\nsection b(a, c) = 1", "x.tl:2:9: expected the name of an angle, got 'b'"),
        ("axiom A\nsection +(a) = 1", "x.tl:2:9: expected the name of a section, got '+'"),
        ("axiom A\nsection F(a) = 1", "x.tl:2:9: expected a name that means nothing else to the turtle, got 'F'"),
        ("axiom A\nsection b(a) = 1\nsurface b(u, v) = u, v, 0", "x.tl:3:9: expected a name that means nothing"),
        ("axiom A\nsection b(a) = c", "x.tl:2:16: expected a parameter or a define, got 'c'"),
        ("axiom A\nsection b(a) = random(1, 2)", "x.tl:2:9: expected an expression of these names and of defines"),
        ("axiom A\ng A = 1\nsection b(a) = g_A()", "x.tl:3:16: expected an expression of these names"),
        ("axiom A\nsection b(pi) = 1", "x.tl:2:9: expected names of parameters that have no meaning yet, got 'pi'"),
        ("axiom A\nsurface b(u) = u, u, u", "x.tl:2:9: expected two names, got 'b'; such as 'surface b(u, v) ="),
        ("axiom A\nsurface b(u, v) = u, v", "x.tl:2:23: expected ',', got the end of the line; a surface has three"),
        ("axiom A\nsurface b(u, v) = u, v, 0, 1", "x.tl:2:26: expected the end of the line, got ','"),
        ("axiom A\nequiv f b\nsurface b(u, v) = u, v, 0", "x.tl:3:9: expected a name that means nothing else"),
        ("axiom A\nend", "x.tl:2:1: expected a production with '->', or a line that begins with"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_line_and_column(text: str, said: str) -> None:
    assert message(text).startswith(said)


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{", '{"format":2}', '{"format":1}', '{"format":1,"axiom":"A","x":1}', '{"format":1,"axiom":3}',
     '{"format":1,"axiom":"A ]"}', '{"format":1,"axiom":"A\\nB"}', '{"format":1,"axiom":"A","productions":"A -> B"}',
     '{"format":1,"axiom":"A","name":"x"}', '{"format":1,"axiom":"A","systems":[{"axiom":"B"}]}',
     '{"format":1,"axiom":"A","radians":1}', '{"format":1,"axiom":"A","productions":["A"]}'],
)  # fmt: skip
def test_what_is_no_encoding_is_refused(text: str) -> None:
    with pytest.raises(InputError, match=r"^genotype"):
        decode(text)


def test_names_of_a_development_function_are_those_of_the_production() -> None:
    """As the paper has it: its g_st(tau, beta, phi, n) belongs to st(n, phi)."""
    from growth.timed import Word, derive

    for head, expected in (("A(age, y, x)", [5.0]), ("A(p, q, age)", [2.0]), ("A(y)", [5.0])):
        body = {"A(age, y, x)": "y", "A(p, q, age)": "p", "A(y)": "y"}[head]
        word = derive(parse_tl(f"axiom A(2, 5)\nA(x, y) @ 9 -> A(x, y)\ng {head} = {body}"), 0.0)
        assert isinstance(word, Word)
        assert word.factors.tolist() == expected
