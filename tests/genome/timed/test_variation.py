"""Variation of timed systems: closed, bounded, deterministic, and structural as often as the rates say."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from timed_strategies import systems

from genome.bnf import parse_bnf
from genome.errors import InputError
from genome.timed import Birth, Number, check_system, format_tl, parse_expression, parse_tl
from genome.timed.genotype import TimedGenotype
from genome.timed.statements import read_birth_word
from genome.timed.variation import (
    Breeder,
    TimedGenome,
    bare_productions,
    differs_in_production,
    distances,
    diversity,
    own_grammar,
    shipped_systems,
    stochastic,
)
from genome.timed.variation.bounds import bounds_of, free
from genome.timed.variation.constants import constant, define_values, stillborn
from genome.timed.variation.crossover import by_symbol, by_words
from genome.timed.variation.events import EVENTS, Site
from genome.timed.variation.numbers import Numbers
from genome.timed.variation.places import Role, literals, with_literals
from genome.timed.variation.words import any_place, any_span, depth, levels, put
from genome.timed.variation.writer import Writer, read_whole

PLANT = parse_tl("""#define LIFE 1
#define LEAVES 6
#define BEND -20
axiom stem(5, 1) ring(LEAVES)
stem(n, s) @ LIFE : n > 0 -> F(2*s) [ +(30) leaf(0.5*s) @ 0.2 ] stem(n - 1, s*0.9)
stem(n, s) @ LIFE -> leaf(s) : 0.5
stem(n, s) @ LIFE -> &(BEND + normal(0, 4)) leaf(s)
ring(n) @ 0.5*LIFE : n > 0 -> /(360/LEAVES) [ leaf(1) ] ring(n - 1)
leaf(s) @ 3 -> leaf(s)
g leaf(s, age) = 1 - exp(-age)
""", "plant.tl")  # fmt: skip
NUMBERS = {"LIFE": [0.5, 2], "LEAVES": {"bounds": [3, 9], "whole": True}, "BEND": [-40, 40]}


def breeder(system=PLANT, numbers=NUMBERS, **changes) -> Breeder:
    return Breeder(TimedGenome.model_validate({"system": "x", "numbers": numbers, **changes}), system)


def word(text: str) -> tuple[Birth, ...]:
    return read_whole(text, "word", read_birth_word)


def sound(system) -> bool:
    """Tell whether it is of the language (or say what is wrong), and the same when it is written and read."""
    check_system(system)
    return parse_tl(format_tl(system)) == system


# -- closure -----------------------------------------------------------------------------------------------------------


@settings(max_examples=15)
@given(
    systems(contexts=True, random=True),
    systems(random=True),
    st.integers(0, 2**32),
    st.sampled_from(["symbols", "words"]),
)
def test_whatever_is_bred_from_any_system_is_a_system_of_the_language(system, stranger, seed, crossover) -> None:
    breeds = breeder(system, {}, crossover=crossover, rewritten=0.5, max_modules=12)
    rng = np.random.default_rng(seed)
    # One that was inserted from outside breeds with the others.
    family = [breeds.random(rng), breeds.random(rng), TimedGenotype(stranger, 1)]
    for one in family:
        assert sound(one.system)
    for _ in range(4):
        pair = breeds.crossover(family[int(rng.integers(3))], family[int(rng.integers(3))], rng)
        family = [breeds.mutate(one, rng) for one in (*pair, family[int(rng.integers(3))])]
        for one in family:
            assert sound(one.system)


@pytest.mark.parametrize("name", sorted(shipped_systems()))
def test_variants_of_the_shipped_systems_keep_to_the_language_and_the_limits(name) -> None:
    system = parse_tl(shipped_systems()[name].read_text(), name)
    breeds = breeder(system, {}, max_modules=20, max_depth=2, max_productions=9)
    rng = np.random.default_rng(5)
    longest = max(20, *(len(one.successor) for one in system.productions))
    family = [breeds.random(rng) for _ in range(4)]
    for _ in range(25):
        first, second = breeds.crossover(family[int(rng.integers(4))], family[int(rng.integers(4))], rng)
        family[int(rng.integers(4))] = breeds.mutate(first, rng)
        family[int(rng.integers(4))] = breeds.mutate(second, rng)
    for one in family:
        assert sound(one.system)
        assert len(one.system.productions) <= max(9, len(system.productions))
        assert all(len(production.successor) <= longest for production in one.system.productions)
        assert all(
            depth(production.successor) <= max(2, *map(depth, _words(system))) for production in one.system.productions
        )
        assert (one.system.developments, one.system.equivs) == (system.developments, system.equivs)


def _words(system):
    return [(), *(one.successor for one in system.productions)]


def test_the_same_stream_breeds_the_same() -> None:
    def line():
        breeds, rng = breeder(), np.random.default_rng(11)
        one = [breeds.random(rng) for _ in range(4)]
        for _ in range(20):
            pair = breeds.crossover(one[0], one[1], rng)
            one = [*one[2:], *(breeds.mutate(child, rng) for child in pair)]
        return one

    assert line() == line()


def test_modules_are_born_before_they_die_where_both_ages_are_constants() -> None:
    late = parse_tl("#define L 1\naxiom A\nA @ 2*L -> A B @ (L + 0.5)\nB @ 2*L -> A @ 0.5\n")
    assert stillborn(late) == ()
    assert stillborn(replace(late, defines=(replace(late.defines[0], value=Number(0.4)),))) == ("B",)
    assert stillborn(parse_tl("axiom A\nA @ 0 -> B\n")) == (), "a terminal age of 0 is meant"
    breeds, rng = breeder(late, {"L": [0.1, 3]}, literals=1.0), np.random.default_rng(0)
    bred = [breeds.random(rng) for _ in range(60)]
    bred += [breeds.mutate(one, rng) for one in bred]
    assert all(stillborn(one.system) == () for one in bred)
    breeds = breeder(late, {"L": [0.1, 3]}, literals=1.0, rewritten=0.0)
    lives = [define_values(breeds.random(rng).system)["L"] for _ in range(60)]
    assert min(lives) > 0.5, "under it the ages of B are over its terminal age"
    assert 1.0 not in lives, "another draw, not the file's own, takes the place of one that may not be"


def test_constants_are_those_of_plain_arithmetic() -> None:
    values = {"A": 2.0}
    told = {text: constant(parse_expression(text), values) for text in ("A*3 - 1", "2^-1", "-A^2", "pi/2", "inf", "B",
            "1/0", "(-1)^0.5", "10^400", "sin(A)", "A < 3", "!A")}  # fmt: skip
    assert told == {"A*3 - 1": 5.0, "2^-1": 0.5, "-A^2": -4.0, "pi/2": math.pi / 2, "inf": None, "B": None, "1/0": None,
                    "(-1)^0.5": None, "10^400": None, "sin(A)": None, "A < 3": None, "!A": None}  # fmt: skip


# -- numbers -----------------------------------------------------------------------------------------------------------


def test_literals_are_bounded_by_what_the_file_has_for_the_same() -> None:
    found = {(role.what, role.symbol, role.slot, role.alone): bounds for role, bounds in
             bounds_of(PLANT, 2.0, lambda _: True).items()}  # fmt: skip
    assert found["argument", "stem", 0, True] == (3.0, 10.0, True), "a count stays whole, and 1 at least"
    assert found["argument", "stem", 0, False] == (1.0, 2.0, True)
    assert found["argument", "stem", 1, True] == (0.5, 2.0, False)
    assert found["argument", "stem", 1, False] == (0.45, 1.8, False)
    assert found["argument", "+", 0, True] == (15.0, 60.0, False)
    assert found["age", "leaf", 0, True] == (0.1, 0.4, False)
    assert found["end", "leaf", 0, True] == (1.5, 6.0, False)
    assert found["end", "ring", 0, False] == (0.25, 1.0, False)
    assert found["chance", "stem", 0, True] == (0.25, 1.0, False)
    assert ("condition", "stem", 0, False) not in found, "a zero stays"


def numbers_of(system) -> list[float]:
    return [value for _, value in literals(system, lambda _: True)]


def test_numbers_keep_to_their_bounds_and_reach_them() -> None:
    breeds, rng = (
        breeder(rewritten=0.0, production_mutation=0.0, number_mutation=1.0, number_step=0.5),
        np.random.default_rng(1),
    )
    known = bounds_of(PLANT, 2.0, lambda _: True)
    one = breeds.random(rng)
    seen: dict[str, list[float]] = {name: [] for name in NUMBERS}
    for _ in range(300):
        one = breeds.mutate(one, rng)
        assert bare_productions(one.system) == bare_productions(PLANT)
        for role, value in literals(one.system, lambda _: True):
            if role in known and value > 0.0:
                assert known[role].low <= value <= known[role].high
                assert not known[role].whole or value == int(value)
        for name, value in define_values(one.system).items():
            seen[name].append(value)
    assert (min(seen["LIFE"]), max(seen["LIFE"])) == (0.5, 2.0)
    assert set(seen["LEAVES"]) == {3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0}
    assert min(seen["BEND"]) == -40.0 < 0.0 < max(seen["BEND"])


def test_first_numbers_are_drawn_evenly() -> None:
    breeds, rng = breeder(rewritten=0.0), np.random.default_rng(2)
    drawn = [define_values(breeds.random(rng).system) for _ in range(700)]
    whole = np.bincount([int(one["LEAVES"]) for one in drawn], minlength=10)[3:]
    assert ((whole - 100) ** 2 / 100).sum() < 22.5, "chi-squared of six degrees of freedom, 0.1 %"
    for name, (low, high) in {"LIFE": (0.5, 2.0), "BEND": (-40.0, 40.0)}.items():
        ranks = np.sort([(one[name] - low) / (high - low) for one in drawn])
        assert np.abs(ranks - (np.arange(700) + 0.5) / 700).max() < 0.074, "Kolmogorov and Smirnov, 0.1 %"


def test_steps_are_gaussian_shares_of_the_bounds() -> None:
    system = parse_tl("#define K 50\naxiom A(K)\n")
    breeds, rng = breeder(system, {"K": [0, 100]}, number_step=0.05, number_mutation=1.0), np.random.default_rng(3)
    steps = np.array([define_values(breeds.mutate(TimedGenotype(system), rng).system)["K"] - 50 for _ in range(2000)])
    assert abs(steps.mean()) < 0.4
    assert abs(steps.std() - 5.0) < 0.3
    assert 0.25 < (np.abs(steps) > 5.0).mean() < 0.39, "a normal one has 32 % beyond one deviation"


def test_a_terminal_age_stays_the_same_in_all_productions_of_a_symbol() -> None:
    system = parse_tl("axiom A(1)\nA(x) @ 2*x : x > 0.5 -> A(x/2)\nA(y) @ 2*y -> B\n")
    breeds, rng = breeder(system, {}, production_mutation=0.0, number_mutation=1.0), np.random.default_rng(4)
    ends = {numbers_of(breeds.mutate(TimedGenotype(system), rng).system)[2] for _ in range(20)}
    assert len(ends) > 15


def test_a_whole_number_that_changes_is_another_and_one_without_a_value_begins_in_the_middle() -> None:
    system = parse_tl("#define K 5\n#define M sin(1)\naxiom A(K*M)\n")
    breeds = breeder(
        system, {"K": {"bounds": [0, 10], "whole": True}, "M": [0, 10]}, number_mutation=1.0, number_step=0.01
    )
    rng = np.random.default_rng(15)
    found = [define_values(breeds.mutate(TimedGenotype(system), rng).system) for _ in range(200)]
    assert {one["K"] for one in found} == {4.0, 6.0}
    assert all(4.5 < one["M"] < 5.5 for one in found)


def test_what_the_grammar_wrote_varies_as_a_factor_or_stays() -> None:
    known = bounds_of(PLANT, 2.0, lambda _: True)
    strange = Role("argument", "F", 0, alone=True)
    assert free(strange, 0.7, known, 2.0) == (0.5, 2.0, False)
    assert free(strange, 22.5, known, 2.0) is None
    assert free(strange, 0.0, known, 2.0) is None
    counted = parse_tl("axiom A(1)\nA(n) -> A(n - 1)\n")
    low = {
        role.alone: bounds.low
        for role, bounds in bounds_of(counted, 4.0, lambda _: True).items()
        if role.what == "argument"
    }
    assert low == {True: 1.0, False: 1.0}
    signed = next(literals(parse_tl("axiom A(-2)\n"), lambda _: True))
    assert signed == (Role("argument", "A", 0, alone=True), 2.0), "a sign is a part of the number"


def test_numbers_of_protected_productions_stay() -> None:
    breeds, rng = breeder(protected=["leaf", "ring"], number_mutation=1.0), np.random.default_rng(5)
    bred = [breeds.mutate(breeds.random(rng), rng).system for _ in range(30)]
    assert breeds.symbols == ("stem",)
    assert all([one for one in system.productions if one.predecessor.symbol != "stem"] == list(PLANT.productions[3:])
               for system in bred)  # fmt: skip
    assert len({system.productions[:3] for system in bred}) == 30
    only = breeder(productions=["leaf"])
    assert only.symbols == ("leaf",)


def test_literals_of_factor_one_do_not_vary() -> None:
    numbers = Numbers(PLANT, {}, 1.0, lambda _: True)
    assert numbers.count(PLANT) == 0
    assert numbers.drawn(PLANT, np.random.default_rng(0)) == PLANT


def test_with_literals_asks_in_order_and_changes_what_it_is_told() -> None:
    system = parse_tl("axiom A(1, -2)\nA(x, y) @ 3 : x < 4 -> B(5*x)@6 : 0.5\n")
    assert numbers_of(system) == [1.0, 2.0, 0.0, 3.0, 4.0, 0.5, 5.0, 6.0]
    changed = with_literals(system, lambda _: True, lambda _, value: value / 2)
    assert changed == parse_tl("axiom A(0.5, -1)\nA(x, y) @ 1.5 : x < 2 -> B(2.5*x)@3 : 0.25\n")


# -- productions -------------------------------------------------------------------------------------------------------


def test_the_alphabet_is_written_with_its_types() -> None:
    grammar = own_grammar(PLANT, ("stem", "ring"))
    rules = parse_bnf(grammar, "own.bnf").rules
    assert next(iter(rules)) == "Successor.stem"
    lines = {line.split(" ::= ")[0]: line.split(" ::= ")[1] for line in grammar.splitlines() if "::=" in line}
    assert lines["<Argument.stem.2.0.stem>"] == '"5" | "n - 1"'
    assert lines["<Argument.stem.2.1.stem>"] == '"1" | "s * 0.9" | "(s * 0.9)" "*" <Factor>'
    assert lines["<Argument.stem.2.1.ring>"] == '"1"', "ring has no s"
    assert lines["<Argument.-plus.1.0.ring>"] == '"30"', "an angle stays one"
    assert lines["<Argument.-and.1.0.stem>"] == '"BEND + normal(0, 4)"'
    assert lines["<Condition.ring>"] == '"n > 0" | "n > 1" | "n > 2" | "random(0, 1) <" <Share>'
    assert '"leaf" "(" <Argument.leaf.1.0.ring> ")" "@" "(0.2)"' in lines["<Module.ring>"]
    assert own_grammar(PLANT, ()) == ""


@given(systems(random=True), st.integers(0, 2**32))
@settings(max_examples=20)
def test_whatever_its_own_grammar_writes_fits_into_the_system(system, seed) -> None:
    breeds = breeder(system, {})
    writer = Writer(parse_bnf(breeds.grammar, "own.bnf"), system, 60, 6)
    rng = np.random.default_rng(seed)
    for at, production in enumerate(system.productions):
        for make, key in (
            (writer.successor, "successor"),
            (writer.module, "successor"),
            (writer.condition, "condition"),
        ):
            made = make(production, rng)
            if made is not None:
                new = replace(production, **{key: made})
                check_system(
                    replace(system, productions=(*system.productions[:at], new, *system.productions[at + 1 :]))
                )


def test_names_are_those_of_the_production_that_is_written() -> None:
    system = parse_tl("axiom A(1)\nA(x) @ 1 : x > 0.5 -> B(x*0.7)\nA(y) @ 1 -> B(y)\n")
    writer = Writer(parse_bnf(own_grammar(system, ("A",)), "own.bnf"), system, 40, 6)
    rng = np.random.default_rng(6)
    for at, name in enumerate("xy"):
        words = [writer.successor(system.productions[at], rng) for _ in range(20)]
        texts = " ".join(str(one) for one in words)
        assert f"name='{name}'" in texts
        assert f"name='{'yx'[at]}'" not in texts


def site(at: int, others: int = 2) -> Site:
    grammar = parse_bnf(own_grammar(PLANT, breeder().symbols), "own.bnf")
    return Site(PLANT.productions[at], others, Writer(grammar, PLANT, 60, 6))


@pytest.mark.parametrize("name", EVENTS)
def test_every_event_changes_the_structure_and_leaves_the_rest(name) -> None:
    rng = np.random.default_rng(7)
    old = PLANT.productions[0]
    changed = 0
    for _ in range(40):
        new = EVENTS[name](site(0), rng)
        assert new is not None
        assert all(
            (one.predecessor, one.end, one.left, one.right) == (old.predecessor, old.end, None, None) for one in new
        )
        assert len(new) == {"split": 2, "drop": 0}.get(name, 1)
        if name == "split":
            assert new[1] == old
            assert new[0].condition is not None
        elif name == "condition":
            assert new[0].successor == old.successor
        elif name != "drop":
            assert new[0].condition == old.condition
        length = [len(one.successor) - len(old.successor) for one in new]
        assert {"insert": length > [0], "duplicate": length > [0], "remove": length < [0]}.get(name, True)
        changed += new != (old,)
    assert changed >= 30


def test_a_symbol_keeps_its_last_production_and_one_without_others_gets_no_condition() -> None:
    rng = np.random.default_rng(8)
    assert EVENTS["drop"](site(4, 0), rng) is None
    assert EVENTS["condition"](site(4, 0), rng) is None
    empty = replace(site(0), production=replace(PLANT.productions[0], successor=()))
    assert all(EVENTS[name](empty, rng) is None for name in ("graft", "remove", "duplicate"))


@pytest.mark.parametrize(("rate", "least", "most"), [(0.0, 0.0, 0.0), (0.5, 0.4, 0.6), (1.0, 0.97, 1.0)])
def test_mutations_change_productions_as_often_as_the_rate_says(rate, least, most) -> None:
    breeds, rng = breeder(production_mutation=rate), np.random.default_rng(9)
    parents = [breeds.random(rng) for _ in range(200)]
    children = [breeds.mutate(one, rng) for one in parents]
    assert all(one != other for one, other in zip(parents, children, strict=True)), "something changes always"
    share = np.mean([differs_in_production(*pair) for pair in zip(parents, children, strict=True)])
    assert least <= share <= most


def test_numbers_alone_are_no_difference_of_productions() -> None:
    one = TimedGenotype(PLANT, 1)
    other = TimedGenotype(with_literals(PLANT, lambda _: True, lambda _, value: value * 1.5), 2)
    assert not differs_in_production(one, other)
    turned = replace(PLANT, productions=(PLANT.productions[1], PLANT.productions[0], *PLANT.productions[2:]))
    assert differs_in_production(one, TimedGenotype(turned, 1)), "the order is asked in"


def test_one_that_becomes_stochastic_draws_a_seed() -> None:
    plain = parse_tl("axiom A(1)\nA(x) @ 1 -> A(x*0.5)\n")
    rng = np.random.default_rng(16)
    breeds = breeder(plain, {}, production_mutation=1.0, reseed=0.0)
    bred = [breeds.mutate(TimedGenotype(plain), rng) for _ in range(60)]
    assert {stochastic(one.system) for one in bred} == {True, False}, "by a condition of chance"
    assert all((one.seed != 0) == stochastic(one.system) for one in bred)


def test_an_event_that_changes_numbers_alone_does_not_count() -> None:
    grammar = parse_bnf("<Successor> ::= F '(7)' | F '(8)' | F '(9)' | G '(9)'", "g.bnf")
    system = parse_tl("axiom A\nA -> F(7)\n")
    rates = {"production_mutation": 1.0, "mutations": {"rewrite": 1, **dict.fromkeys(set(EVENTS) - {"rewrite"}, 0)}}
    breeds = Breeder(TimedGenome(system="x", grammar="g.bnf", **rates), system, grammar=grammar)
    rng = np.random.default_rng(17)
    bred = [breeds.mutate(TimedGenotype(system), rng) for _ in range(40)]
    assert np.mean([differs_in_production(one, TimedGenotype(system)) for one in bred]) > 0.9


def test_seeds_are_drawn_where_something_is_drawn_at_random() -> None:
    plain = parse_tl("axiom A(1)\nA(x) @ 1 -> A(x*0.5)\n")
    assert not stochastic(plain)
    assert stochastic(PLANT)
    assert stochastic(parse_tl("axiom A\nA -> B : 0.5\n"))
    assert stochastic(parse_tl("axiom A\nA -> B\ng A(age) = random(0, age)\n"))
    assert stochastic(parse_tl("axiom S\nsystem S\naxiom A(random(0, 1))\nend\n"))
    quiet, rng = breeder(plain, {}, rewritten=0.0, production_mutation=0.0), np.random.default_rng(10)
    assert {quiet.mutate(quiet.random(rng), rng).seed for _ in range(5)} == {0}
    seeds = [breeder(reseed=1.0).mutate(TimedGenotype(PLANT, 5), rng).seed for _ in range(9)]
    assert len(set(seeds)) == 9
    assert breeder(reseed=0.0).mutate(TimedGenotype(PLANT, 5), rng).seed == 5


# -- words -------------------------------------------------------------------------------------------------------------


def test_levels_are_trunk_and_branches() -> None:
    tree = word("A [ B [ C ] D ] E [ ]")
    assert levels(tree) == [[(0, 1), (1, 8), (8, 9), (9, 11)], [(2, 3), (3, 6), (6, 7)], [(4, 5)], []]
    assert (depth(tree), depth(word("A B"))) == (2, 0)


def test_spans_and_places_keep_brackets_balanced() -> None:
    tree, rng = word("A [ B [ C ] D ] E [ F ]"), np.random.default_rng(12)
    seen = set()
    for _ in range(300):
        span = any_span(tree, rng)
        assert span is not None
        seen.add(span)
        rest = put(tree, span, word("X [ Y ]"))
        assert _balanced(rest)
        at = any_place(tree, rng)
        assert _balanced(put(tree, (at, at), tree[span[0] : span[1]]))
    assert {(0, 1), (1, 8), (4, 5), (0, 12), (2, 7)} <= seen
    assert any_span((), rng) is None


def _balanced(births) -> bool:
    high = np.cumsum([(one.symbol == "[") - (one.symbol == "]") for one in births])
    return bool((high >= 0).all()) and int(high[-1]) == 0


# -- crossover ---------------------------------------------------------------------------------------------------------


def test_symbols_and_defines_come_whole_from_one_parent_or_the_other() -> None:
    other = parse_tl("""#define LIFE 2
#define LEAVES 9
#define BEND 0
axiom stem(3, 2)
leaf(s) @ 1 -> F(s)
stem(n, s) @ 1 -> F(7)
ring(n) @ 1 -> F(8)
g leaf(s, age) = 1 - exp(-age)
""")
    rng = np.random.default_rng(13)
    mixes = set()
    for _ in range(200):
        pair = by_symbol(PLANT, other, ("stem", "ring", "leaf"), rng)
        told = []
        for child, own in zip(pair, (PLANT, other), strict=True):
            mine = []
            for symbol in ("stem", "ring", "leaf"):
                groups = [[one for one in system.productions if one.predecessor.symbol == symbol]
                          for system in (child, PLANT, other)]  # fmt: skip
                assert groups[0] in groups[1:]
                mine.append(groups[0] == groups[1])
            for place in range(3):
                values = [system.defines[place].value for system in (child, PLANT, other)]
                assert values[0] in values[1:]
                mine.append(values[0] == values[1])
            mine.append(child.axiom == PLANT.axiom)
            assert child.developments == own.developments
            told.append(mine)
        assert [not one for one in told[0]] == told[1], "what one child has the other has not"
        mixes.add(tuple(told[0]))
    assert len(mixes) > 80, "of 128"


def test_words_are_exchanged_within_a_symbol() -> None:
    one = parse_tl("axiom A\nA -> F(1) [ F(2) ] F(3)\nB -> F(9)\n")
    other = parse_tl("axiom A\nA -> G(4) [ G(5) G(6) ]\n")
    rng = np.random.default_rng(14)
    for _ in range(60):
        first, second = by_words(one, other, ("A", "B"), rng)
        assert first.productions[1] == one.productions[1]
        kept = sorted(birth.symbol for system in (first, second) for birth in system.productions[0].successor)
        before = sorted(birth.symbol for system in (one, other) for birth in system.productions[0].successor)
        assert kept == before, "nothing is lost"
        assert any(birth.symbol == "G" or birth.symbol == "[" for birth in first.productions[0].successor)
    assert by_words(one, parse_tl("axiom A\nC -> A\n"), ("A",), rng)[0] == one


# -- distances ---------------------------------------------------------------------------------------------------------


def test_distances_are_shares_of_productions_and_numbers() -> None:
    texts = ("axiom A(1)\nA(x) @ 2 -> B(x)\n", "axiom A(1)\nA(x) @ 3 -> B(x)\n", "axiom A(1)\nA(x) @ 2 -> C(x)\n")
    family = [TimedGenotype(parse_tl(text), seed) for seed, text in enumerate((*texts, texts[0]))]
    found = distances(family)
    # Literals are 1 and 0 of A's birth, the terminal age, and 0 of the age of what is born.
    assert found[0].tolist() == pytest.approx([0.0, 0.5 * 1 / 4, 0.5 * 1 + 0.5 * 1 / 4, 0.0])
    assert (found == found.T).all()
    assert diversity(family) == pytest.approx(found[np.triu_indices(4, 1)].mean())
    assert diversity(family[:1]) is None
    assert diversity([family[0], family[3]]) == 0.0


# -- mistakes ----------------------------------------------------------------------------------------------------------

MISTAKES = [
    ({"numbers": {"LIVE": [1, 2]}}, "genome.numbers.LIVE: expected a define of x, got 'LIVE'; did you mean 'LIFE'?"),
    ({"productions": ["steam"]}, "genome.productions: expected symbols with a production in x, got 'steam'; did you"),
    (
        {"protected": ["F"]},
        "genome.protected: expected symbols with a production in x, got 'F'; known: leaf, ring, stem",
    ),
]


@pytest.mark.parametrize(("changes", "message"), MISTAKES)
def test_what_the_system_has_not_is_refused(changes, message) -> None:
    with pytest.raises(InputError) as caught:
        breeder(**changes)
    assert str(caught.value).startswith(message)


GRAMMARS = [
    ("<Word> ::= F", "for every symbol X that varies, got none for 'stem'; add one, or list the symbol under"),
    ("<Successor> ::= F '('", "expected <Successor> to write what the language takes, got 'F (', where a number"),
    ("<Successor> ::= stem", "got 'stem', which has 0 where 2 parameters of 'stem' is expected; <Successor.X> is for"),
    ("<Successor> ::= leaf '(s)'", "write what can stand in a production of 'ring', got 'leaf (s)', which has 's'"),
    ("<Successor> ::= F <Successor> F <Successor> | <Successor> F", "alternative of <Successor> that ends"),
    ("<Successor> ::= F\n<Condition> ::= n '>'", "expected <Condition> to write what the language takes, got 'n >'"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "message"), GRAMMARS)
def test_a_grammar_that_writes_nonsense_is_refused(text, message) -> None:
    with pytest.raises(InputError) as caught:
        Breeder(TimedGenome(system="x", grammar="g.bnf"), PLANT, grammar=parse_bnf(text, "g.bnf"))
    assert message in str(caught.value)


def test_a_grammar_of_ones_own_writes_the_productions() -> None:
    grammar = parse_bnf("<Successor> ::= F '(7)' | F '(8)' leaf '(1)'", "g.bnf")
    breeds = Breeder(TimedGenome(system="x", grammar="g.bnf", rewritten=1.0, literals=1.0), PLANT, grammar=grammar)
    system = breeds.random(np.random.default_rng(0)).system
    allowed = {word("F(7)"), word("F(8) leaf(1)")}
    assert {one.successor for one in system.productions} == allowed
    assert {one.condition for one in system.productions} == {one.condition for one in PLANT.productions}
