"""Derivation by events against the plain reference, and independence of how time is sampled."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_timed import Reference, TroubleError
from timed_strategies import systems

from genome.timed import Module, TimedSystem, parse_tl
from growth.protocol import Failure
from growth.timed import Derivation, TimedGrowth, Word, begin, derive
from growth.timed.tables import KEY

BUDGET = TimedGrowth(max_modules=3000, max_events=20_000)
TIMES = st.lists(st.sampled_from((0.0, 0.3, 0.5, 1.0, 1.2, 1.5, 2.1, 3.0, 3.7)), min_size=2, max_size=4).map(sorted)


def word_of(text: str, time: float, seed: int = 0, **budget: int) -> list[Module]:
    word = derive(parse_tl(text, "x.tl"), time, seed, TimedGrowth(**budget))
    assert isinstance(word, Word), word
    return word.modules()


def symbols(text: str, time: float, seed: int = 0) -> str:
    return "".join(module.symbol for module in word_of(text, time, seed))


def failure(text: str, time: float, **budget: int) -> str:
    found = derive(parse_tl(text, "x.tl"), time, 0, TimedGrowth(**budget))
    assert isinstance(found, Failure), found
    return str(found)


def same(one: Derivation, other: Derivation) -> bool:
    """Whether two derivations are equal to the bit."""
    if one.time != other.time or one.events != other.events:
        return False
    return all(a.shape == b.shape and a.tobytes() == b.tobytes() for a, b in zip(one.state, other.state, strict=True))


def difference(system: TimedSystem, seed: int, times: list[float]) -> object:
    """Compare the engine with the plain reference at some times, bit for bit; give what differs first, or ``None``."""
    derivation = begin(system, seed, BUDGET)
    reference = None
    for time in times:
        if isinstance(derivation, Derivation):
            derivation = derivation.at(time)
        found = derivation.word() if isinstance(derivation, Derivation) else derivation
        if isinstance(found, Failure) and found.reason == "budget":
            return None
        try:
            reference = reference or Reference(system, seed)
            expected = reference.at(time)
        except TroubleError as trouble:
            failed = isinstance(found, Failure) and found.reason == "expression"
            return None if failed else (time, found, trouble)
        if not isinstance(found, Word) or not isinstance(derivation, Derivation):
            return time, found, expected
        modules = [(m.symbol, list(m.parameters), m.age) for m in found.modules()]
        keys = derivation.state.whole[:, KEY].astype(np.uint64).tolist()
        if modules != expected or keys != [cell.key for cell in reference.word]:
            return time, modules, expected
    return None


@settings(max_examples=100)
@given(systems(), st.integers(0, 2**63 - 1), TIMES)
def test_words_are_those_of_the_plain_reference(system: TimedSystem, seed: int, times: list[float]) -> None:
    assert difference(system, seed, times) is None


@settings(max_examples=100)
@given(systems(contexts=True), st.integers(0, 2**63 - 1), TIMES)
def test_words_with_contexts_are_those_of_the_plain_reference(
    system: TimedSystem, seed: int, times: list[float]
) -> None:
    assert difference(system, seed, times) is None


@settings(max_examples=100)
@given(st.booleans(), st.data(), TIMES)
def test_the_word_does_not_depend_on_how_time_is_sampled(
    contexts: bool, data: st.DataObject, times: list[float]
) -> None:
    system = data.draw(systems(contexts=contexts, random=True))
    start = begin(system, 5, BUDGET)
    if isinstance(start, Failure):
        return
    reached: Derivation | Failure = start
    for time in times:
        if isinstance(reached, Derivation):
            reached = reached.at(time)
    direct = start.at(times[-1])
    if isinstance(reached, Derivation):
        assert isinstance(direct, Derivation)
        assert same(reached, direct)
        one, other = reached.word(), direct.word()
        if isinstance(one, Word) and isinstance(other, Word):
            assert one.values.tobytes() == other.values.tobytes()
        else:
            assert one == other
    else:
        assert isinstance(direct, Failure)


def test_an_earlier_time_is_derived_anew() -> None:
    start = begin(parse_tl("axiom A\nA @ 0.7 -> A @ 0.1 B(random(0, 1)) : 0.5\nA @ 0.7 -> A\n"), 3)
    assert isinstance(start, Derivation)
    late = start.at(9.0)
    assert isinstance(late, Derivation)
    back, direct = late.at(4.0), start.at(4.0)
    assert isinstance(back, Derivation)
    assert isinstance(direct, Derivation)
    assert same(back, direct)
    assert not same(back, late)


def test_a_module_dies_at_its_exact_terminal_age_and_its_children_carry_the_overshoot() -> None:
    text = "axiom A\nA @ 2 -> B @ 0.5 C\nB @ 2.5 -> D @ 0.25\n"
    assert word_of(text, np.nextafter(2.0, 0.0) - 1e-9)[0].symbol == "A"
    assert word_of(text, 2.0) == [Module("B", (), 0.5), Module("C", (), 0.0)]
    assert word_of(text, 3.5) == [Module("B", (), 2.0), Module("C", (), 1.5)]
    assert word_of(text, 4.0) == [Module("D", (), 0.25), Module("C", (), 2.0)]
    assert word_of(text, 10.0) == [Module("D", (), 6.25), Module("C", (), 8.0)]


def test_instants_that_differ_by_rounding_are_one() -> None:
    text = "axiom A(0)\nA(n) @ 0.1 -> A(n + 1)\n"
    for count in (3, 6, 7, 10, 1000):
        assert word_of(text, count * 0.1)[0].parameters == (count,)
        assert word_of(text, count / 10)[0].parameters == (count,)
        assert word_of(text, count * 0.1 - 1e-6)[0].parameters == (count - 1,)
    assert all(module.age >= 0.0 for module in word_of(text, 0.3))


def test_without_ages_time_counts_rewritings_of_all_modules_at_once() -> None:
    """The two oracles of word counts."""
    bush = "axiom F\nF -> F[+F]F[-F]F\n"
    for steps in range(6):
        word = symbols(bush, float(steps))
        assert word.count("F") == 5**steps
    assert len(symbols(bush, 5.0)) == 7811
    assert symbols(bush, 1.5) == "F[+F]F[-F]F"
    tree = symbols("#define R 1.456\naxiom A(1)\nA(s) -> F(s)[+(85)A(s/R)][-(85)A(s/R)]\n", 11.0)
    assert (tree.count("A"), tree.count("F")) == (2048, 2047)


def test_a_birth_age_over_the_terminal_age_is_a_lifetime_of_nothing() -> None:
    # The paper's own second example does it at t = 1: 3.0/1 is the terminal age.
    text = "axiom A(0.5)\nA(t) @ 3.0 -> A(t + 1) @ 3.0/t\n"
    assert word_of(text, 3.0) == [Module("A", (2.5,), 2.0)]
    assert word_of("axiom A @ 9\nA @ 3 -> B @ 0.5", 0.0) == [Module("B", (), 0.5)]
    assert word_of("axiom A @ 9\nA @ 3 -> B @ 0.5", 1.0) == [Module("B", (), 1.5)]


def test_lifetimes_of_nothing_are_passed_in_no_time_and_never_endless() -> None:
    text = "axiom A(4)\nA(n) @ 0 : n > 0 -> B A(n - 1)\n"
    assert symbols(text, 0.0) == "BBBBA"
    assert failure("axiom A\nA @ 0 -> A", 0.0, max_events=1000).startswith(
        "budget: more births and askings up to time 0"
    )
    assert failure("axiom A\nA @ 0 -> A A", 1.0, max_events=1000).startswith("budget: more births and askings")
    assert failure("axiom B A\nB < A @ 0 -> A", 1.0, max_events=1000).startswith("budget: more births and askings")


def test_without_production_a_symbol_never_dies() -> None:
    assert word_of("axiom A(2) @ 3\ng A(x, age, end) = if(end == inf, age, 0)", 1e6) == [
        Module("A", (2e6 + 6.0,), 1e6 + 3)
    ]
    assert symbols("axiom A\nA @ inf -> B", 1e9) == "A"


def test_a_module_that_no_production_matches_lives_on() -> None:
    assert word_of("axiom A(1)\nA(x) @ 2 : x > 1 -> B", 50.0) == [Module("A", (1.0,), 50.0)]


def test_a_chance_that_is_left_asks_again_after_as_long() -> None:
    text = "axiom " + "A " * 4000 + "\nA @ 2 -> B : 0.25\n"
    counts = [symbols(text, 2.0 * k + 0.5).count("A") / 4000 for k in range(6)]
    assert counts == pytest.approx([0.75**k for k in range(6)], abs=0.03)
    ages = {module.age for module in word_of(text, 8.5) if module.symbol == "A"}
    assert ages == {8.5}


def test_without_time_passing_a_chance_is_asked_once() -> None:
    counts = [symbols("axiom " + "A " * 2000 + "\nA @ 0 -> B : 0.25\n", time).count("A") for time in (0.0, 50.0)]
    assert counts[0] == counts[1] == pytest.approx(1500, abs=90)


def test_productions_share_by_their_chances() -> None:
    text = "axiom " + "A " * 6000 + "\nA -> B : 0.2\nA -> C : 0.3\nA -> D\nA -> E\n"
    word = symbols(text, 1.0)
    shares = [word.count(letter) / 6000 for letter in "BCDE"]
    assert shares == pytest.approx([0.2, 0.3, 0.5, 0.0], abs=0.03)
    assert symbols(text, 1.0, 1) != word
    assert symbols(text, 1.0, 0) == word


def test_random_numbers_belong_to_modules() -> None:
    # What one module draws has nothing to do with what stands beside it.
    rule = "\nA -> B(random(0, 1), normal(0, 1)) A\n"
    alone, beside = word_of("axiom A" + rule, 3.0), word_of("axiom A C A" + rule, 3.0)
    assert beside[: len(alone)] == alone
    drawn = [module.parameters for module in word_of("axiom " + "A " * 3000 + rule, 1.0) if module.symbol == "B"]
    even, normal = np.array(drawn).T
    assert len(np.unique(even)) == 3000
    assert (even.min() >= 0.0, even.max() < 1.0, abs(even.mean() - 0.5) < 0.02) == (True, True, True)
    assert (abs(normal.mean()) < 0.06, abs(normal.std() - 1.0) < 0.05) == (True, True)
    assert abs(np.corrcoef(even, normal)[0, 1]) < 0.06


def test_a_development_function_draws_once_for_a_module() -> None:
    start = begin(parse_tl("axiom A(1) A(1)\ng A(x, age) = random(1, 2)"))
    assert isinstance(start, Derivation)
    early, late = start.at(1.0), start.at(5.0)
    assert isinstance(early, Derivation)
    assert isinstance(late, Derivation)
    first, second = early.word(), late.word()
    assert isinstance(first, Word)
    assert isinstance(second, Word)
    assert first.values.tolist() == second.values.tolist()
    assert first.values[0] != first.values[1]


def test_signals_pass_one_module_a_rewriting() -> None:
    """Contexts are read from the word as it stood before the instant (Prusinkiewicz and Lindenmayer 1990, 1.8)."""
    text = "axiom B A A A A\nB < A -> B\nB -> A\n"
    assert [symbols(text, float(k)) for k in range(5)] == ["BAAAA", "ABAAA", "AABAA", "AAABA", "AAAAB"]
    back = "axiom A A A B\nA > B -> B\nB -> A\n"
    assert [symbols(back, float(k)) for k in range(4)] == ["AAAB", "AABA", "ABAA", "BAAA"]


def test_contexts_look_past_branches_and_ignored_symbols() -> None:
    text = "ignore + -\naxiom B [ + C [ D ] ] - A + E\nB(x) < A > E -> X\nB < A > E -> Y\n".replace(
        "B(x) < A > E -> X\n", ""
    )
    assert symbols(text, 1.0) == "B[+C[D]]-Y+E"
    root = "ignore +\naxiom B [ + A ] C\nB < A -> X\nA > C -> Y\n"
    assert symbols(root, 1.0) == "B[+X]C"
    assert symbols("axiom A [ A ] C\nA > C -> Y\n", 1.0) == "Y[A]C"
    assert symbols("axiom A [ C ] A [ A C ]\nA > C -> Y\n", 1.0) == "A[C]A[YC]"
    assert symbols("axiom [ C ] A [ A ]\nC < A -> X\nA < A -> Y\n", 1.0) == "[C]A[Y]"
    values = "axiom B(2) A(3) C(4)\nB(p) < A(x) > C(q) : p < x -> A(p + 10*x + 100*q)\n"
    assert word_of(values, 1.0)[1].parameters == (432.0,)


def test_a_system_inside_another_runs_in_its_own_time() -> None:
    text = """
axiom A part(5) @ 1.5 A
A @ 9 -> Z
B @ 9 -> Z
system part(n)
  #define K 2
  axiom B(n) @ 0.5 A
  B(m) @ 1 -> B(m*K) A
  g A(age) = 1
end
"""
    # At its birth it is as old as its module: 1.5. B has been rewritten at 0.5 and at 1.5.
    word = word_of(text, 0.0)
    assert [(m.symbol, m.parameters, m.age) for m in word] == [
        ("A", (), 0.0), ("B", (20.0,), 0.0), ("A", (), 0.0), ("A", (), 1.0), ("A", (), 1.5), ("A", (), 0.0),
    ]  # fmt: skip
    assert symbols(text, 1.0) == "ABAAAAA"
    # The outer A has its production, the inner one has none.
    assert symbols(text, 9.0) == "ZB" + "A" * 12 + "Z"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("axiom A(0)\nA(x) @ 2 -> B(1/x)", "expression: division by zero, in a parameter of B at time 2"),
        ("axiom A(2)\nA(x) @ 2 : 1/(x-2) -> B", "expression: division by zero, in a condition of A(2) at time 2"),
        ("axiom A(2)\nA(x) @ 2 -> B : x", "expression: a chance outside of 0 to 1, in a chance of A(2) at time 2"),
        ("axiom A(2)\nA(x) -> B @ (x - 3)", "expression: a negative age, in the birth age of B at time 1"),
        ("axiom A(2)\nA(x) -> B @ exp(1e9)", "expression: overflow: a value that is not finite, in the birth age of B"),
        ("axiom A(2)\nA(x) @ (x - 3) -> B", "expression: a negative age, in the terminal age of A(2) at time 0"),
        ("axiom A(2)\nA(x) -> B(10^999)", "expression: overflow: a value that is not finite, in a parameter of B at t"),
        (
            "axiom A(2)\ng A(x, age) = log(age - 3)",
            "expression: domain error: a logarithm of a number that is not posi",
        ),
        (
            "axiom A(2)\ng A(x, age) = sqrt(age - 4)",
            "expression: domain error: a root of a negative number, in the dev",
        ),
        (
            "axiom A(2)\ng A(x, age) = asin(age)",
            "expression: domain error: asin or acos of a number outside of -1 to 1",
        ),
        ("axiom A(2)\ng A(x, age) = (age - 4)^0.5", "expression: domain error: a power of a negative number to an exp"),
        (
            "axiom A(2)\ng A(x, age) = besselj(0.5, x)",
            "expression: domain error: besselj of an order that is not whole",
        ),
        ("axiom A(2)\nA(x) -> B(normal(0, -1))", "expression: domain error: normal() with a negative spread, in a par"),
        ("axiom A(2)\ng A(x, end) = end - end", "expression: overflow: a value that is not finite, in the development"),
        ("#define K 1/0\naxiom A", "rules: x.tl:1:9: expected a value of K, got division by zero"),
    ],
)
def test_what_goes_wrong_in_an_expression_is_named_with_module_and_time(text: str, said: str) -> None:
    assert failure(text, 3.0).startswith(said)


def test_development_functions_name_their_module_and_the_time_asked_for() -> None:
    said = "expression: division by zero, in the development function of A(2) at time 3"
    assert failure("axiom A(2)\ng A(x, age) = 1/(age - 3)", 3.0) == said


def test_what_goes_round_for_long_is_derived_in_one_go() -> None:
    text = "axiom A(0) F\nA(n) @ 0.5 -> B A(n + 1)\nB @ 0.25 ->\n"
    assert word_of(text, 100_000.25) == [Module("A", (200_000.0,), 0.25), Module("F", (), 100_000.25)]


def test_systems_that_stand_for_themselves_are_a_failure() -> None:
    assert failure("axiom A\nsystem A\naxiom A A\nend", 1.0, max_events=5000).startswith("budget: ")
    nested = "axiom A\nsystem A\naxiom B\nB @ 1 -> A C\nend"
    assert symbols(nested, 3.5) == "BCCC"


def test_growth_that_explodes_is_a_failure() -> None:
    said = failure("axiom F\nF -> F F", 1e9)
    assert said == "budget: more births and askings up to time 1e+09 than the 5000000 that max_events allows"
    assert failure("axiom A\nA -> A B", 50.0, max_modules=20).startswith("budget: more modules at time 50 than the 20")
    assert failure("axiom A\nC < B -> X\nA -> A B", 50.0, max_modules=20).startswith("budget: more modules at time 50 ")


def test_a_word_that_was_large_and_is_not_any_more_is_no_failure() -> None:
    text = "axiom A(6)\nA(n) : n > 0 -> A(n - 1) A(n - 1)\nA(n) ->\n"
    assert word_of(text, 7.0, max_modules=10) == []
    assert failure(text, 5.5, max_modules=10).startswith("budget: more modules at time 5.5")


def test_a_clock_that_strikes_ends_the_growth() -> None:
    start = begin(parse_tl("axiom A\nA -> A"))
    assert isinstance(start, Derivation)
    ticks = iter((0.0, 100.0))
    assert str(start.at(5.0, lambda: next(ticks))).startswith("clock: ")


@pytest.mark.parametrize("time", [-1.0, float("nan"), float("inf")])
def test_times_that_are_none_are_refused(time: float) -> None:
    from genome.errors import InputError

    with pytest.raises(InputError, match="time: expected a time of 0 or more"):
        derive(parse_tl("axiom A"), time)
