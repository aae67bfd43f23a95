"""Expressions as the kernels evaluate them: precedence, functions, and the plain reference."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.special
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_timed import TroubleError, evaluate
from timed_strategies import expressions

from genome.timed import Birth, Development, Expression, Scope, TimedSystem, parse_expression, parse_tl
from genome.timed.expression import CONSTANTS
from growth.protocol import Failure
from growth.timed import Word, derive

VALUES = st.one_of(st.sampled_from((0.0, 1.0, -1.0, 0.5, -2.0, 3.0, math.pi)), st.floats(-1e6, 1e6))


def value(text: str, time: float = 0.0) -> float:
    return of_tree(parse_expression(text), {}, time)


def of_tree(expression: Expression, names: dict[str, float], time: float = 0.0) -> float:
    """Evaluate by the engine; NaN where it fails."""
    births = (Birth("A", tuple(parse_expression(repr(given)) for given in (1.0, *names.values()))),)
    system = TimedSystem(births, developments=(Development("A", ("one", *names), expression),))
    word = derive(system, time)
    if isinstance(word, Failure):
        assert word.reason == "expression"
        return math.nan
    assert isinstance(word, Word)
    return float(word.factors[0])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("2*3^2", 18), ("-2^2", -4), ("2^3^2", 512), ("2^-1", 0.5), ("(-2)^2", 4), ("-2*-3", 6), ("--2", 2),
        ("!0", 1), ("!2", 0), ("!!2", 1), ("-!0", -1), ("!2^0", 0),
        ("1 + 2*3", 7), ("(1 + 2)*3", 9), ("7 - 3 - 2", 2), ("24/4/2", 3), ("24/4*2", 12), ("7 % 4 * 2", 6),
        ("-7 % 4", -3), ("7.5 % 2", 1.5), ("2 + 7 % 4", 5),
        ("1 + 1 < 3", 1), ("1 < 2 + 1", 1), ("3 > 2 > 1", 0), ("1 < 2 == 1", 1), ("2 == 2 < 1", 0), ("1 = 1", 1),
        ("1 != 1", 0), ("2 <= 2", 1), ("2 >= 3", 0), ("1 == 1 != 0", 1),
        ("2 & 4", 1), ("2 && 0", 0), ("0 | 4", 1), ("0 || 0", 0), ("0 & 0 == 0", 0), ("1 | 0 & 0", 1),
        ("1 || 0 && 0", 1), ("1 && 0 | 1", 1), ("0 && 0 | 1", 0), ("1 | 1 && 0", 0), ("0 & 1 | 1 && 1", 1),
        ("if(2 > 1, 5, 1/0)", 5), ("if(0, log(0), 3)", 3), ("1 || 1/0", 1), ("0 && 1/0", 0),
        ("sqrt(9)", 3), ("root(3, -8)", -2), ("root(4, 16)", 2), ("root(-1, 4)", 0.25), ("sign(-3)", -1),
        ("sign(0)", 0),
        ("floor(-1.5)", -2), ("ceil(-1.5)", -1), ("floor(1e300)", 1e300), ("abs(-2)", 2), ("min(2, 3)", 2),
        ("max(2, 3)", 3),
        ("exp(0)", 1), ("log(exp(1))", 1), ("asin(1)*2", math.pi), ("acos(0)*2", math.pi), ("atan(1)*4", math.pi),
        ("sin(pi/2)", 1), ("cos(pi)", -1), ("tan(0)", 0), ("TRUE + true + FALSE + false", 2), ("1/inf", 0),
        (".5 + 1. + 1e-1", 1.6), ("besselj(0, 0)", 1), ("0^0", 1), ("besselj(0, 2.404825557695773)", 0),
    ],
)  # fmt: skip
def test_precedence_and_functions(text: str, expected: float) -> None:
    assert value(text) == pytest.approx(expected, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("text", ["1/0", "0/0", "1 % 0", "0^-1", "root(0, 2)", "(-8)^(1/3)", "root(2, -1)", "sqrt(-1)",
                                  "log(0)", "asin(1.1)", "acos(-1.1)", "inf - inf", "0*inf", "exp(1000)", "10^400",
                                  "inf % 2", "besselj(0.5, 1)", "besselj(0, 1e6)", "normal(0, -1)", "sin(inf)",
                                  "if(1/0, 1, 2)"])  # fmt: skip
def test_what_has_no_value_fails(text: str) -> None:
    assert math.isnan(value(text))


@settings(max_examples=300)
@given(expressions(("x", "y")), VALUES, VALUES)
def test_expressions_are_evaluated_as_the_plain_reference_does(expression: Expression, x: float, y: float) -> None:
    names = {"x": abs(x), "y": abs(y)}
    scope = Scope(TimedSystem((Birth("A"),)))
    try:
        expected = evaluate(expression, {**CONSTANTS, **names}, scope, {})
    except TroubleError:
        expected = math.nan
    if math.isinf(expected):
        expected = math.nan
    found = of_tree(expression, names)
    assert found == expected or (math.isnan(found) and math.isnan(expected))


def test_bessel_functions_are_those_of_scipy() -> None:
    from growth.timed import _expressions

    for order in (0, 1, 2, 5, 40, -3):
        for x in (0.0, 1e-3, 0.7, 2.4, 10.0, -7.5, 33.3, 400.0, 5000.0):
            found, trouble = _expressions.bessel(float(order), x)
            assert trouble == 0
            assert found == pytest.approx(scipy.special.jv(order, x), abs=3e-13)


def test_development_functions_call_each_other_with_values() -> None:
    text = "axiom A(1) B(10)\ng A(x, age) = 2*age\ng B(y, age, end) = g_A(y, age + 1) + g_C(2, 5)\ng C(p, q) = p^q"
    word = derive(parse_tl(text), 3.0)
    assert isinstance(word, Word)
    assert word.factors.tolist() == [6.0, 40.0]
    drawn = derive(parse_tl("axiom A(1)\ng A(x) = g_T(random(0, 1))\ng T(u) = u - u"), 0.0)
    assert isinstance(drawn, Word)
    assert drawn.factors.tolist() == [0.0]


def test_branches_of_keys_spread() -> None:
    from growth.timed import _expressions

    drawn = np.array([_expressions.uniform(np.uint64(key), number) for key in range(300) for number in range(30)])
    assert len(np.unique(drawn)) == len(drawn)
    assert np.histogram(drawn, 10, (0.0, 1.0))[0] == pytest.approx(900, rel=0.15)
