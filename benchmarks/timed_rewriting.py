"""Rewriting a timed system to 200,000 modules, against plain Python rewriters of tuples.

Both peers hold modules as tuples (symbol, parameters, birth, death) and rewrite by events; they read no file, check
nothing and draw nothing. The plain one has productions as data, with a function for each expression. The bare one has
each production as a function written by hand for it, so that it rewrites that system and no other. Limit: at least 5
times as fast as the plain one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from benchmarks.timing import best_of
from genome.timed import parse_tl
from growth.protocol import Failure
from growth.timed import Derivation, begin

Given = tuple[float, ...]
Cell = tuple[str, Given, float, float]
Bare = Callable[[Given, float], tuple[Cell, ...]]
Expression = Callable[..., float]
Successor = Sequence[tuple[str, Sequence[Expression], Expression]]

NEVER = float("inf")
RATIO = 1.456
LEAST_RATIO = 5.0

BUSH = "axiom F(1)\nF(l) -> F(l)[+(25.7)F(l)]F(l)[-(25.7)F(l)]F(l)\n"
TREE = f"#define R {RATIO}\naxiom A(1)\nA(s) -> F(s)[+(85)A(s/R)][-(85)A(s/R)]\n"


def born(symbol: str, *arguments: Expression) -> tuple[str, Sequence[Expression], Expression]:
    """Give a birth at age 0."""
    return symbol, arguments, lambda *_: 0.0


def same(x: float) -> float:
    """Give the parameter."""
    return x


def smaller(x: float) -> float:
    """Give the parameter divided."""
    return x / RATIO


PLAIN: Mapping[str, tuple[str, Successor]] = {
    "bush": ("F", [
        born("F", same), born("["), born("+", lambda _: 25.7), born("F", same), born("]"), born("F", same), born("["),
        born("-", lambda _: 25.7), born("F", same), born("]"), born("F", same),
    ]),
    "tree": ("A", [
        born("F", same), born("["), born("+", lambda _: 85.0), born("A", smaller), born("]"), born("["),
        born("-", lambda _: 85.0), born("A", smaller), born("]"),
    ]),
}  # fmt: skip
"""The symbol that is rewritten, and by what."""


def bush(given: Given, now: float) -> tuple[Cell, ...]:
    """Do as the production of BUSH."""
    ends, segment = now + 1.0, (given[0],)
    return (
        ("F", segment, now, ends), ("[", (), now, NEVER), ("+", (25.7,), now, NEVER), ("F", segment, now, ends),
        ("]", (), now, NEVER), ("F", segment, now, ends), ("[", (), now, NEVER), ("-", (25.7,), now, NEVER),
        ("F", segment, now, ends), ("]", (), now, NEVER), ("F", segment, now, ends),
    )  # fmt: skip


def tree(given: Given, now: float) -> tuple[Cell, ...]:
    """Do as the production of TREE."""
    ends, less = now + 1.0, given[0] / RATIO
    return (
        ("F", (given[0],), now, NEVER), ("[", (), now, NEVER), ("+", (85.0,), now, NEVER), ("A", (less,), now, ends),
        ("]", (), now, NEVER), ("[", (), now, NEVER), ("-", (85.0,), now, NEVER), ("A", (less,), now, ends),
        ("]", (), now, NEVER),
    )  # fmt: skip


def by_data(rules: Mapping[str, Successor], word: list[Cell], until: float) -> list[Cell]:
    """Rewrite by events, all that die at a time in one pass."""
    while any(cell[3] <= until for cell in word):
        after: list[Cell] = []
        for cell in word:
            _, given, _, dies = cell
            if dies > until:
                after.append(cell)
                continue
            for symbol, arguments, age in rules[cell[0]]:
                origin = dies - age(*given)
                ends = origin + 1.0 if symbol in rules else NEVER
                after.append((symbol, tuple(argument(*given) for argument in arguments), origin, ends))
        word = after
    return word


def by_hand(rule: Bare, word: list[Cell], until: float) -> list[Cell]:
    """Rewrite by events, all that die at a time in one pass."""
    while any(cell[3] <= until for cell in word):
        after: list[Cell] = []
        for cell in word:
            if cell[3] <= until:
                after.extend(rule(cell[1], cell[3]))
            else:
                after.append(cell)
        word = after
    return word


def ratio(name: str, text: str, rule: Bare, until: float) -> float:
    """Print and give how many times as fast the engine is."""
    start = begin(parse_tl(text, name))
    assert not isinstance(start, Failure)
    symbol, successor = PLAIN[name]
    axiom: list[Cell] = [(symbol, (1.0,), 0.0, 1.0)]

    def ours() -> Derivation | Failure:
        return start.at(until)

    def plain() -> list[Cell]:
        return by_data({symbol: successor}, axiom, until)

    def bare() -> list[Cell]:
        return by_hand(rule, axiom, until)

    reached, expected = ours(), plain()
    assert expected == bare()
    assert not isinstance(reached, Failure)
    word = reached.word()
    assert not isinstance(word, Failure)
    assert [(module.symbol, module.parameters) for module in word.modules()] == [cell[:2] for cell in expected]
    mine, theirs, hand = best_of(ours, plain, bare, rounds=7)
    print(f"timed_rewriting: {name}, {len(expected)} modules in {mine * 1e3:.1f} ms, {theirs / mine:.1f} times the "
          f"plain rewriter (at least {LEAST_RATIO:g}), {hand / mine:.1f} times the bare one")  # fmt: skip
    return theirs / mine


def main() -> bool:
    """Print both ratios; tell whether they are within the limit."""
    return min(ratio("bush", BUSH, bush, 7.0), ratio("tree", TREE, tree, 14.0)) >= LEAST_RATIO


if __name__ == "__main__":
    raise SystemExit(not main())
