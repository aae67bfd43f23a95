"""Hypothesis strategies for grammars, and the writing of a grammar as BNF text."""

from __future__ import annotations

from functools import cache

from hypothesis import strategies as st

from genome.grammar import Alternatives, Grammar, Item, NonTerminal, Option, Repeat, Sequence, Terminal

TERMINALS = (
    "a",
    "+",
    "-",
    "->",
    "<",
    ">",
    "::",
    "Edge",
    "EdgeX",
    "EdgeY",
    "[",
    "]",
    "{",
    "}",
    "|",
    "#",
    "x y",
    "<q>",
    ";",
)
_TERMINAL = st.sampled_from(TERMINALS).map(Terminal)


@cache
def _items(names: tuple[str, ...], groups: int = 2) -> st.SearchStrategy[Item]:
    """Symbols, and groups of them at most so deep inside one another; the simple ones come more often."""
    leaf: st.SearchStrategy[Item] = _TERMINAL
    if names:
        leaf = st.sampled_from([*map(Terminal, TERMINALS), *map(NonTerminal, names * 4)])
    if groups == 0:
        return leaf
    inner = _alternatives(_items(names, groups - 1), 1)
    return st.one_of(leaf, leaf, leaf, inner.map(Repeat), inner.map(Option))


def _alternatives(items: st.SearchStrategy[Item], least: int) -> st.SearchStrategy[Alternatives]:
    sequence = st.lists(items, min_size=least, max_size=3).map(tuple)
    return st.lists(sequence, min_size=1, max_size=3).map(tuple)


@st.composite
def grammars(draw: st.DrawFn, most: int = 5) -> Grammar:
    """Draw a grammar in which every non-terminal has a finite derivation."""
    names = tuple(f"N{i}" for i in range(draw(st.integers(1, most))))
    rules: dict[str, Alternatives] = {}
    for i, name in enumerate(names):
        free = draw(_alternatives(_items(names), 0))
        ends = draw(st.lists(_items(names[i + 1 :]), max_size=3).map(tuple))  # leads to later names only, so it ends
        at = draw(st.integers(0, len(free)))
        rules[name] = (*free[:at], ends, *free[at:])
    return Grammar("drawn", names[0], rules)


genomes = st.lists(st.integers(0, 1000), min_size=1, max_size=60)


def written(grammar: Grammar) -> str:
    """Write a grammar as BNF text, every terminal quoted."""
    return "\n".join(f"<{name}> ::= {_text(found)}" for name, found in grammar.rules.items())


def _text(alternatives: Alternatives) -> str:
    return " | ".join(_sequence(sequence) for sequence in alternatives)


def _sequence(sequence: Sequence) -> str:
    return " ".join(map(_item, sequence)) if sequence else "''"


def _item(item: Item) -> str:
    if isinstance(item, Terminal):
        return f"'{item.text}'"
    if isinstance(item, NonTerminal):
        return f"<{item.name}>"
    opening, closing = "{}" if isinstance(item, Repeat) else "[]"
    return f"{opening} {_text(item.alternatives)} {closing}"
