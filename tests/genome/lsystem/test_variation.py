"""Random L-systems, crossover and mutation: what comes out, and how likely."""

from __future__ import annotations

import itertools
import random
from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from deap import gp
from hypothesis import given, settings
from hypothesis import strategies as st
from lsystem_strategies import systems, words
from scipy.stats import chisquare

from genome.errors import InputError
from genome.lsystem import (
    LSystem,
    LSystemGenome,
    Rule,
    Word,
    crossover,
    decode,
    encode,
    mutate,
    parse_word,
    random_system,
    system_diversity,
)
from genome.lsystem.crossover import as_tree, as_word, common_region
from genome.lsystem.initial import random_symbol, random_word
from genome.lsystem.mutations import EVENTS
from genome.settings import validated

SETTINGS = LSystemGenome(symbols="F+-&^£$%GH", contexts=0.3, max_symbols=20, max_depth=3, rules=4)
SEEDS = st.integers(0, 2**32 - 1)


def rng_of(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


def system_of(*successors: str) -> LSystem:
    rules = tuple(Rule("F", None, None, 1.0 / len(successors), parse_word(text)) for text in successors)
    return LSystem(parse_word("F"), rules, 3, 0)


def even(counts: Counter[str], expected: dict[str, float] | set[str]) -> bool:
    """Whether counts go with the expected chances (evenly, for a set), and nothing else came out."""
    chances = expected if isinstance(expected, dict) else dict.fromkeys(sorted(expected), 1.0 / len(expected))
    assert set(counts) == set(chances)
    total = sum(counts.values())
    return chisquare([counts[key] for key in chances], [total * share for share in chances.values()]).pvalue > 1e-4


def outcomes(make: Callable[[np.random.Generator], object], count: int = 4000) -> Counter[str]:
    rng = rng_of(1)
    return Counter(str(make(rng)) for _ in range(count))


@settings(deadline=None)
@given(SEEDS, st.booleans())
def test_a_random_system_draws_within_bounds_and_travels(seed: int, chances: bool) -> None:
    settings = SETTINGS.model_copy(update={"chances": chances})
    system = random_system(settings, rng_of(seed))
    assert system == random_system(settings, rng_of(seed))
    assert system.draws
    assert len(system.rules) == 4
    assert all(settings.fits(rule.successor) and "F" in rule.successor.symbols for rule in system.rules)
    assert system.rules[0].left is system.rules[0].right is None
    assert system.rules[0].operand in system.axiom.symbols
    assert 2 <= system.iterations <= 4
    assert 1 <= len(system.axiom.items) <= 4
    heads = Counter(rule.head for rule in system.rules)
    for head in heads:
        assert sum(rule.chance for rule in system.rules if rule.head == head) == pytest.approx(1.0)
    assert chances or max(heads.values()) == 1
    assert (system.seed != 0) == system.stochastic
    assert decode(encode(system)) == system


def test_random_symbols_words_and_chances_are_as_likely_as_said() -> None:
    settings = LSystemGenome(symbols="F+G", forward=0.5, branching=0.3, siblings=2, length=(2, 4), depth=2)
    assert even(outcomes(lambda rng: random_symbol(settings, rng)), {"F": 0.5, "+": 0.25, "G": 0.25})
    rng = rng_of(2)
    trunks = [random_word(settings, rng, 1, 1, 99) for _ in range(4000)]
    assert even(Counter("[" if str(word)[0] == "[" else "F" for word in trunks), {"[": 0.3, "F": 0.7})
    points = [word.items[0] for word in trunks if not isinstance(word.items[0], str)]
    assert even(Counter(str(len(point.siblings)) for point in points), {"1", "2"})
    lengths = Counter(str(len(one.items)) for point in points for one in point.siblings)
    assert even(lengths, {"1", "2", "3", "4"})
    drawn = [random_system(settings, rng) for _ in range(2000)]
    assert even(Counter(str(len(system.rules[0].successor.items)) for system in drawn), {"2", "3", "4"})
    assert even(Counter(str(system.iterations) for system in drawn), {"2", "3", "4"})
    shared = Counter(str(round(s.rules[0].chance * 99 // 11)) for s in drawn if s.rules[0].head == s.rules[1].head)
    assert even(shared, {str(tenth) for tenth in range(9)})
    contexts = LSystemGenome(rules=2, contexts=0.25)
    lefts = Counter(str(random_system(contexts, rng).rules[1].left) for _ in range(2000))
    assert even(lefts, {"None": 0.75, "F": 0.25})


@settings(deadline=None)
@given(words())
def test_a_word_as_a_tree_is_one_that_deap_takes_and_back(word: Word) -> None:
    tree = gp.PrimitiveTree(as_tree(word))
    assert tree.searchSubtree(0) == slice(0, len(tree))
    assert as_word(tree) == word


@pytest.mark.parametrize("kind", ["one_point", "common_region"])
@settings(deadline=None)
@given(first=systems(), second=systems(), seed=SEEDS)
def test_crossover_exchanges_parts_of_one_rule_and_loses_none(
    kind: str, first: LSystem, second: LSystem, seed: int
) -> None:
    settings = SETTINGS.model_copy(update={"crossover": kind})
    state = random.getstate()
    children = crossover(first, second, rng_of(seed), settings)
    assert random.getstate() == state
    assert children == crossover(first, second, rng_of(seed), settings)
    changed = 0
    for parent, child in zip((first, second), children, strict=True):
        assert replace(child, rules=parent.rules) == parent
        pairs = list(zip(parent.rules, child.rules, strict=True))
        assert all(old == replace(new, successor=old.successor) for old, new in pairs)
        assert sum(old != new for old, new in pairs) <= 1
        changed += child != parent
        assert child == parent or (
            child.draws and all(new == old or settings.fits(new.successor) for old, new in pairs)
        )
    if changed == 2:
        before, after = (
            Counter(s for one in pair for rule in one.rules for s in rule.successor.symbols)
            for pair in ((first, second), children)
        )
        assert before == after


def test_one_point_crossover_takes_every_pair_of_places_alike() -> None:
    settings = LSystemGenome(max_symbols=5, max_depth=1, length=(1, 5), depth=1)
    first, second = system_of("F[+]"), system_of("F-")
    # What follows each place: the whole but its root, what is on the branch, the ends of branch and trunk.
    tails = {"[+]": "F{}", "+": "F[{}]", "": "F[+{}]", "end": "F[+]{}"}
    other = {"-": "F{}", "": "F-{}"}
    expected: Counter[str] = Counter()
    for (a, one), (b, two) in itertools.product(tails.items(), other.items()):
        words = one.format(b), two.format("" if a == "end" else a)
        expected["{} {}".format(*(text.replace("[]", "") for text in words))] += 1
    del expected["F[+] F-"]  # no change: drawn again
    got = outcomes(lambda rng: "{} {}".format(*(s.rules[0].successor for s in crossover(first, second, rng, settings))))
    total = expected.total()
    assert even(got, {key: count / total for key, count in expected.items()})


def test_the_common_region_ends_where_the_trees_part() -> None:
    first, second = as_tree(parse_word("F+[F|F]F")), as_tree(parse_word("G-[+-|G]"))
    # Both go symbol, symbol, point of two; within it the first siblings go on for one symbol, the second for one.
    assert common_region(first, second) == [(1, 1), (2, 2), (3, 3), (4, 4), (5, 6), (6, 7), (7, 8)]
    parted = as_tree(parse_word("[F]F"))
    assert common_region(first, parted) == [(0, 0)]


def test_crossover_in_the_common_region_keeps_places_and_takes_each_alike() -> None:
    settings = LSystemGenome(crossover="common_region")
    first, second = system_of("F[+|G]F"), system_of("-[^|&]F-")
    got = outcomes(lambda rng: crossover(first, second, rng, settings)[0].rules[0].successor, 1000)
    # Behind the first symbol; either sibling; behind the point and behind what follows it. Ends alone change nothing.
    assert even(got, {"F[^|&]F-": 0.2, "F[^|G]F": 0.2, "F[+|&]F": 0.2, "F[+|G]F-": 0.4})
    same = crossover(first, first, rng_of(0), settings)
    assert same == (first, first)


def test_crossover_pairs_rules_of_one_operand_where_there_are_some() -> None:
    first = LSystem(parse_word("F"), (Rule("F", None, None, 1.0, parse_word("FF")),), 1, 0)
    rules = (Rule("G", None, None, 1.0, parse_word("F---")), Rule("F", "G", None, 1.0, parse_word("F+++")))
    second = LSystem(parse_word("GF"), rules, 1, 0)
    settings = LSystemGenome()
    seen = outcomes(lambda rng: crossover(first, second, rng, settings)[1].rules[0].successor, 200)
    assert set(seen) == {"F---"}
    other = replace(first, rules=(Rule("H", None, None, 1.0, parse_word("FF")),))
    seen = outcomes(lambda rng: crossover(other, second, rng, settings)[1].rules[0].successor, 200)
    assert len(seen) > 1


def test_parents_without_rules_come_back() -> None:
    bare = LSystem(parse_word("F"), (), 1, 0)
    assert crossover(bare, system_of("FF"), rng_of(0), SETTINGS) == (bare, system_of("FF"))
    assert mutate(bare, rng_of(0), SETTINGS) == bare


@pytest.mark.parametrize("kind", ["one_point", "common_region"])
def test_offspring_of_many_generations_stay_within_bounds(kind: str) -> None:
    settings = SETTINGS.model_copy(update={"crossover": kind})
    rng = rng_of(3)
    deme = [random_system(settings, rng) for _ in range(20)]
    largest = deepest = 0
    for _ in range(60):
        rng.shuffle(deme)
        pairs = [crossover(deme[i], deme[i + 1], rng, settings) for i in range(0, 20, 2)]
        deme = [mutate(one, rng, settings) for pair in pairs for one in pair]
        for rule in (rule for one in deme for rule in one.rules):
            assert 1 <= rule.successor.count <= 20
            assert rule.successor.depth <= 3
            largest, deepest = max(largest, rule.successor.count), max(deepest, rule.successor.depth)
        assert all(one.draws for one in deme)
    assert (largest, deepest) == (20, 3)


@settings(deadline=None)
@given(systems(), SEEDS)
def test_a_mutation_changes_successors_alone(parent: LSystem, seed: int) -> None:
    child = mutate(parent, rng_of(seed), SETTINGS)
    assert child == mutate(parent, rng_of(seed), SETTINGS)
    assert replace(child, rules=parent.rules, seed=parent.seed) == parent
    assert all(old == replace(new, successor=old.successor) for old, new in zip(parent.rules, child.rules, strict=True))
    assert child.seed == parent.seed or parent.stochastic
    for old, new in zip(parent.rules, child.rules, strict=True):
        assert new == old or SETTINGS.fits(new.successor)


def test_a_mutation_changes_something_and_events_come_at_their_rates() -> None:
    parent = system_of("F[+F|G]-")
    rates = {"add": 0.0, "delete": 0.0, "duplicate": 0.0, "invert": 0.0, "change": 0.3, "reseed": 0.6}
    settings = validated(LSystemGenome, {"mutations": rates, "symbols": "F+-G"}, "here")
    pair = replace(parent, rules=(replace(parent.rules[0], chance=0.5), replace(parent.rules[0], chance=0.5)))
    seen = Counter()
    rng = rng_of(4)
    for _ in range(4000):
        child = mutate(pair, rng, settings)
        assert child != pair
        seen["change" * (child.rules != pair.rules) + "seed" * (child.seed != pair.seed)] += 1
    neither = 0.7 * 0.4
    assert even(seen, {
        "changeseed": 0.3 * 0.6, "change": 0.3 * 0.4 + neither / 3, "seed": 0.6 * 0.7 + neither * 2 / 3,
    })  # fmt: skip
    assert mutate(parent, rng, LSystemGenome()) != parent
    assert all(mutate(parent, rng, settings).seed == 0 for _ in range(50))
    still = validated(LSystemGenome, {"mutations": dict.fromkeys(rates, 0.0)}, "here")
    assert mutate(parent, rng, still) == parent


def event(name: str, text: str, count: int = 4000, **settings: object) -> Counter[str]:
    given = LSystemGenome(**{"symbols": "FG", "forward": 0.5, "length": (2, 2), **settings})
    return outcomes(lambda rng: EVENTS[name](parse_word(text), rng, given), count)


def test_change_takes_every_symbol_and_every_other_one_alike() -> None:
    expected = {"GF[G]", "+F[G]", "FG[G]", "F+[G]", "FF[F]", "FF[+]"}
    assert even(event("change", "FF[G]", symbols="F+G"), expected)
    assert event("change", "FF", 5, symbols="F") == {"FF": 5}


def test_delete_takes_every_branch_alike_and_every_other_time_an_heir_of_it() -> None:
    got = event("delete", "F[+[G|H]|-]")
    assert even(got, {"F[-]": 0.125, "F[G|-]": 0.0625, "F[H|-]": 0.0625, "F[+[H]|-]": 0.25, "F[+[G]|-]": 0.25,
                      "F[+[G|H]]": 0.25})  # fmt: skip
    assert even(event("delete", "F+G"), {"+G": 0.2, "FG": 0.2, "F+": 0.2, "G": 0.2, "F": 0.2})
    assert event("delete", "F[G]", 5) == {"F": 5}
    assert event("delete", "F", 5) == {"F": 5}


def test_duplicate_grows_every_branch_at_every_place_alike() -> None:
    # Places: three on the trunk, two on the branch, one as a sibling.
    assert even(event("duplicate", "F[G]"), {
        "[G]F[G]": 1 / 6, "F[G][G]": 2 / 6, "F[[G]G]": 1 / 6, "F[G[G]]": 1 / 6, "F[G|G]": 1 / 6,
    })  # fmt: skip
    assert even(event("duplicate", "F+"), {"[F]F+", "F[F]+", "F+[F]", "[+]F+", "F[+]+", "F+[+]"})


def test_invert_turns_the_items_of_every_branch_alike() -> None:
    assert even(event("invert", "FG[+F|-[FG]H]"), {"FG[F+|-[FG]H]", "FG[+F|H[FG]-]", "FG[+F|-[GF]H]"})
    assert event("invert", "F+G", 5) == {"G+F": 5}


def test_add_grows_a_random_branch_at_every_place_alike() -> None:
    branches = {"F": 0.25, "G": 0.25, "FF": 0.125, "FG": 0.125, "GF": 0.125, "GG": 0.125}
    expected = {}
    for text, chance in branches.items():
        expected[f"[{text}]H"] = expected[f"H[{text}]"] = chance / 2
    assert even(event("add", "H"), expected)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ({"symbols": "+-"}, "x: symbols: expected symbols, each once and F among them, got '+-'"),
        ({"symbols": "FF"}, "x: symbols: expected symbols, each once and F among them, got 'FF'"),
        ({"symbols": "F[]"}, "x: symbols: expected symbols: capital letters, + - & ^ £ $ %, got '['; brackets are not"),
        ({"axiom": "+"}, "x: axiom: expected a word with a letter that rules can rewrite, got '+'; such as F"),
        ({"axiom": "F["}, "x: axiom: expected a ']' for this '[', got the end of the word; brackets must balance"),
        ({"length": [4, 2]}, "x: length: expected the least and the most: [2, 4], got [4, 2]; write the smaller first"),
        ({"length": 0}, "x: length: expected greater than or equal to 1, got 0"),
        ({"iterations": [1, 2, 3]}, "x: iterations: expected a whole number, or the least and the most: [2, 4], got"),
        ({"length": 61}, "x: expected a length of 60 at most, as max_symbols says, got (61, 61)"),
        ({"depth": 5}, "x: expected a depth of 4 at most, as max_depth says, got 5"),
        ({"chances": False}, "x: expected 1 rules at most where no two may share an operand, got 2; list more letters"),
        ({"mutations": {"copy": 1}}, "x: mutations.copy: expected a known key, got 'copy'"),
        ({"rules": 101}, "x: rules: expected less than or equal to 100, got 101"),
        ({"forward": 0.0}, "x: forward: expected greater than 0, got 0.0"),
    ],
)
def test_settings_that_make_no_sense_are_told(data: dict[str, object], said: str) -> None:
    with pytest.raises(InputError) as caught:
        validated(LSystemGenome, data, "x")
    assert str(caught.value).startswith(said)


def test_settings_take_what_they_write() -> None:
    settings = validated(LSystemGenome, {"symbols": "f F +", "axiom": "f F", "iterations": 3}, "x")
    assert (settings.symbols, settings.axiom, settings.iterations) == ("£F+", "£F", (3, 3))
    assert validated(LSystemGenome, settings.model_dump(mode="json"), "x") == settings


def test_diversity_is_the_mean_distance_of_pairs() -> None:
    rng = rng_of(5)
    assert system_diversity([]) is None
    assert system_diversity([system_of("FF")]) is None
    assert system_diversity([system_of("FF")] * 3) == 0.0
    deme = [random_system(SETTINGS, rng) for _ in range(12)]
    apart = replace(system_of("GG"), axiom=parse_word("+"), rules=(Rule("G", None, None, 1.0, parse_word("GG")),))
    assert system_diversity([system_of("FF"), apart]) == 1.0

    def shares(system: LSystem) -> Counter:
        words = [("", system.axiom), *((rule.operand, rule.successor) for rule in system.rules)]
        pairs = Counter((mark, *pair) for mark, word in words for pair in itertools.pairwise(f".{word}."))
        return Counter({pair: count / pairs.total() for pair, count in pairs.items()})

    distances = []
    for a, b in itertools.combinations(map(shares, deme), 2):
        distances.append(0.5 * sum(abs(a[pair] - b[pair]) for pair in {*a, *b}))
    assert system_diversity(deme) == pytest.approx(np.mean(distances), abs=1e-12)
