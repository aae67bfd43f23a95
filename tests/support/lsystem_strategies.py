"""Hypothesis strategies for words and L-systems."""

from __future__ import annotations

from hypothesis import strategies as st

from genome.lsystem import Branch, LSystem, Rule, Word
from genome.lsystem.symbols import SYMBOLS

SYMBOL = st.sampled_from(SYMBOLS)
LETTER = st.sampled_from("FGHX")


def words(most: int = 6, depth: int = 3) -> st.SearchStrategy[Word]:
    """Any word of one item or more."""
    item: st.SearchStrategy = SYMBOL
    word = st.lists(item, min_size=1, max_size=most).map(lambda items: Word(tuple(items)))
    for _ in range(depth):
        branch = st.lists(word, min_size=1, max_size=3).map(lambda siblings: Branch(tuple(siblings)))
        word = st.lists(st.one_of(SYMBOL, SYMBOL, branch), min_size=1, max_size=most).map(
            lambda items: Word(tuple(items))
        )
    return word


@st.composite
def systems(draw: st.DrawFn, most: int = 4) -> LSystem:
    """Any L-system of up to so many rules, whether or not it draws."""
    context = st.one_of(st.none(), LETTER)
    heads = draw(st.lists(st.tuples(LETTER, context, context), max_size=most))
    chances = [draw(st.floats(0.01, 1.0)) / heads.count(head) for head in heads]
    rules = tuple(Rule(*head, chance, draw(words(4, 2))) for head, chance in zip(heads, chances, strict=True))
    return LSystem(draw(words(4, 2)), rules, draw(st.integers(0, 1000)), draw(st.integers(0, 2**63 - 1)))
