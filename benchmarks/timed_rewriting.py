"""Rewriting a timed system to 200,000 modules, against a plain Python rewriter of tuples.

The peer holds modules as tuples (symbol, parameters, birth, death), its productions as Python functions written by hand:
it reads no file, checks nothing and draws nothing. Both rewrite by events. Limit: at least 5 times as fast.
"""

from __future__ import annotations

from collections.abc import Callable

from benchmarks.timing import best_of
from genome.timed import parse_tl
from growth.protocol import Failure
from growth.timed import Derivation, begin

Cell = tuple[str, tuple[float, ...], float, float]
Rule = Callable[[tuple[float, ...], float], tuple[Cell, ...]]

NEVER = float("inf")
RATIO = 1.456
LEAST_RATIO = 5.0

BUSH = "axiom F(1)\nF(l) -> F(l)[+(25.7)F(l)]F(l)[-(25.7)F(l)]F(l)\n"
TREE = f"#define R {RATIO}\naxiom A(1)\nA(s) -> F(s)[+(85)A(s/R)][-(85)A(s/R)]\n"


def bush(given: tuple[float, ...], now: float) -> tuple[Cell, ...]:
    """Do as the production of BUSH."""
    ends, segment = now + 1.0, (given[0],)
    return (
        ("F", segment, now, ends), ("[", (), now, NEVER), ("+", (25.7,), now, NEVER), ("F", segment, now, ends),
        ("]", (), now, NEVER), ("F", segment, now, ends), ("[", (), now, NEVER), ("-", (25.7,), now, NEVER),
        ("F", segment, now, ends), ("]", (), now, NEVER), ("F", segment, now, ends),
    )  # fmt: skip


def tree(given: tuple[float, ...], now: float) -> tuple[Cell, ...]:
    """Do as the production of TREE."""
    ends, smaller = now + 1.0, given[0] / RATIO
    return (
        ("F", (given[0],), now, NEVER), ("[", (), now, NEVER), ("+", (85.0,), now, NEVER),
        ("A", (smaller,), now, ends), ("]", (), now, NEVER), ("[", (), now, NEVER), ("-", (85.0,), now, NEVER),
        ("A", (smaller,), now, ends), ("]", (), now, NEVER),
    )  # fmt: skip


def rewritten(word: list[Cell], rule: Rule, until: float) -> list[Cell]:
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


def ratio(name: str, text: str, rule: Rule, until: float) -> float:
    """Print and give how many times as fast the engine is."""
    start = begin(parse_tl(text, name))
    assert not isinstance(start, Failure)
    symbol = start.program.names[int(start.state.whole[0, 0])]
    axiom: list[Cell] = [(symbol, (1.0,), 0.0, 1.0)]

    def ours() -> Derivation | Failure:
        return start.at(until)

    reached, plain = ours(), rewritten(axiom, rule, until)
    assert not isinstance(reached, Failure)
    word = reached.word()
    assert not isinstance(word, Failure)
    assert [(module.symbol, module.parameters) for module in word.modules()] == [cell[:2] for cell in plain]
    mine, theirs = best_of(ours, lambda: rewritten(axiom, rule, until), rounds=7)
    found = theirs / mine
    print(f"timed_rewriting: {name}, {len(plain)} modules in {mine * 1e3:.1f} ms, {found:.1f} times the plain rewriter"
          f" (at least {LEAST_RATIO:g})")  # fmt: skip
    return found


def main() -> bool:
    """Print both ratios; tell whether they are within the limit."""
    return min(ratio("bush", BUSH, bush, 7.0), ratio("tree", TREE, tree, 14.0)) >= LEAST_RATIO


if __name__ == "__main__":
    raise SystemExit(not main())
