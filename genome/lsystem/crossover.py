"""Crossover of production rules, on DEAP's trees (Senatore 2009, 'crossover and mutation'; Poli and Langdon 1998).

As a tree a word is what follows each of its places: a symbol has one child, the rest of its branch; a branch point
has a child for each sibling and then the rest; at each branch's end stands a leaf. Any subtree is then a word, and may
stand where any other stood, so that what comes out is well formed whatever is exchanged.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any, Final

import numpy as np
from deap import gp

from genome.fence import fenced
from genome.lsystem.settings import LSystemGenome
from genome.lsystem.symbols import SYMBOLS
from genome.lsystem.system import LSystem
from genome.lsystem.word import Branch, Item, Word

TRIES: Final = 8
"""Places that are drawn until both children are within bounds and one differs from its parent."""

Tree = list[Any]
"""Nodes in depth-first order; DEAP's ``PrimitiveTree`` is one."""


def crossover(
    first: LSystem, second: LSystem, rng: np.random.Generator, settings: LSystemGenome
) -> tuple[LSystem, LSystem]:
    """Cross one rule of each of two L-systems; all else is inherited unchanged, from one parent each.

    Parameters
    ----------
    first, second
        The parents.
    rng
        Where all is drawn from.
    settings
        The kind of crossover, and the bounds.

    Returns
    -------
    tuple of two systems
        A child that would be out of bounds, or never draw, is its parent, and so are those of parents without rules.
    """
    if not first.rules or not second.rules:
        return first, second
    one: LSystem | None = None
    other: LSystem | None = None
    for _ in range(TRIES):
        i, j = _pair(first, second, rng)
        words = _crossed(first.rules[i].successor, second.rules[j].successor, rng, settings)
        one, other = _child(first, i, words[0], settings), _child(second, j, words[1], settings)
        if one is not None and other is not None and (one != first or other != second):
            break
    return one or first, other or second


def _pair(first: LSystem, second: LSystem, rng: np.random.Generator) -> tuple[int, int]:
    """Draw a rule of the first, and one of the second, of the same operand where there is one."""
    i = int(rng.integers(len(first.rules)))
    alike = [j for j, rule in enumerate(second.rules) if rule.operand == first.rules[i].operand]
    among = alike or list(range(len(second.rules)))
    return i, among[int(rng.integers(len(among)))]


def _child(parent: LSystem, at: int, word: Word, settings: LSystemGenome) -> LSystem | None:
    if not settings.fits(word):
        return None
    rules = (*parent.rules[:at], replace(parent.rules[at], successor=word), *parent.rules[at + 1 :])
    child = replace(parent, rules=rules)
    return child if child.draws else None


def _crossed(a: Word, b: Word, rng: np.random.Generator, settings: LSystemGenome) -> tuple[Word, Word]:
    first, second = gp.PrimitiveTree(as_tree(a)), gp.PrimitiveTree(as_tree(b))
    if settings.crossover == "one_point":
        with fenced(rng):
            gp.cxOnePoint(first, second)
    else:
        i, j = _draw(common_region(first, second), rng)
        one, other = first.searchSubtree(i), second.searchSubtree(j)
        first[one], second[other] = second[other], first[one]
    return as_word(first), as_word(second)


def _draw(places: list[tuple[int, int]], rng: np.random.Generator) -> tuple[int, int]:
    return places[int(rng.integers(len(places)))]


def as_tree(word: Word) -> Tree:
    """Give a word's nodes, depth first."""
    nodes: Tree = []
    for item in word.items:
        if isinstance(item, str):
            nodes.append(_symbol(item))
        else:
            nodes.append(_point(len(item.siblings)))
            for sibling in item.siblings:
                nodes.extend(as_tree(sibling))
    nodes.append(_END)
    return nodes


def as_word(tree: Tree) -> Word:
    """Give the word of a tree; siblings without a symbol are left out, and so are points without siblings."""
    word, end = _read(tree, 0)
    assert end == len(tree)
    return word


def common_region(first: Tree, second: Tree) -> list[tuple[int, int]]:
    """Give the pairs of places, beside the roots, to which both trees lead over nodes of equal numbers of children.

    The roots are a pair where there is no other. Depth first.
    """
    ends = _ends(first), _ends(second)
    found: list[tuple[int, int]] = []
    waiting = [(0, 0)]
    while waiting:
        i, j = waiting.pop()
        found.append((i, j))
        if first[i].arity == second[j].arity:
            children = []
            a, b = i + 1, j + 1
            for _ in range(first[i].arity):
                children.append((a, b))
                a, b = ends[0][a], ends[1][b]
            waiting.extend(reversed(children))
    return found[1:] or found


def _ends(tree: Tree) -> list[int]:
    """Give behind which place each node's subtree ends."""
    ends = [0] * len(tree)
    for i in range(len(tree) - 1, -1, -1):
        end = i + 1
        for _ in range(tree[i].arity):
            end = ends[end]
        ends[i] = end
    return ends


def _read(tree: Tree, at: int) -> tuple[Word, int]:
    """Read one branch from a place on; give the place behind its end."""
    items: list[Item] = []
    while (node := tree[at]).arity:
        at += 1
        if node.name in SYMBOLS:
            items.append(node.name)
            continue
        siblings = []
        for _ in range(node.arity - 1):
            sibling, at = _read(tree, at)
            if sibling.items:
                siblings.append(sibling)
        if siblings:
            items.append(Branch(tuple(siblings)))
    return Word(tuple(items)), at + 1


_END: Final = gp.Terminal("end", False, gp.__type__)  # noqa: FBT003 - DEAP's own order


@cache
def _symbol(symbol: str) -> gp.Primitive:
    return gp.Primitive(symbol, [gp.__type__], gp.__type__)


@cache
def _point(siblings: int) -> gp.Primitive:
    return gp.Primitive("point", [gp.__type__] * (siblings + 1), gp.__type__)
