"""Random L-systems, by length and depth (Senatore 2009, 'the generative engine')."""

from __future__ import annotations

import numpy as np

from genome.lsystem.settings import LSystemGenome
from genome.lsystem.symbols import FORWARD, LETTERS
from genome.lsystem.system import SEEDS, Head, LSystem, Rule
from genome.lsystem.word import Branch, Item, Word, parse_word

HUNDREDTHS = 100
"""Chances are drawn in these."""


def random_system(settings: LSystemGenome, rng: np.random.Generator) -> LSystem:
    """Draw an L-system.

    Parameters
    ----------
    settings
        What it is made of.
    rng
        Where all is drawn from.

    Returns
    -------
    LSystem
        Within the bounds, and able to draw: every successor and every random axiom holds an F, and the first rule
        rewrites a letter of the axiom wherever it stands. Its seed is 0 where no rule has a chance under 1.
    """
    axiom = _axiom(settings, rng)
    rules = _rules(_heads(axiom, settings, rng), settings, rng)
    iterations = int(rng.integers(settings.iterations[0], settings.iterations[1] + 1))
    seed = random_seed(rng)
    return LSystem(axiom, rules, iterations, seed if any(rule.chance < 1.0 for rule in rules) else 0)


def random_seed(rng: np.random.Generator) -> int:
    """Draw a seed, each as likely."""
    return int(rng.integers(0, SEEDS, dtype=np.uint64))


def random_word(settings: LSystemGenome, rng: np.random.Generator, length: int, depth: int, room: int) -> Word:
    """Draw a word.

    Parameters
    ----------
    settings
        What it is made of: ``symbols``, ``forward``, ``branching``, ``siblings`` and, for its branches, ``length``.
    rng
        Where all is drawn from.
    length
        Symbols and branch points of its trunk.
    depth
        Branches inside each other, at most.
    room
        Symbols, at most; at least 1.
    """
    items: list[Item] = []
    for _ in range(length):
        if room == 0:
            break
        if depth and rng.random() < settings.branching:
            branch = _branch(settings, rng, depth, room)
            items.append(branch)
            room -= sum(one.count for one in branch.siblings)
        else:
            items.append(random_symbol(settings, rng))
            room -= 1
    return Word(tuple(items))


def random_symbol(settings: LSystemGenome, rng: np.random.Generator) -> str:
    """Draw a symbol: F with the chance ``forward``, else any of the others."""
    others = settings.symbols.replace(FORWARD, "")
    if not others or rng.random() < settings.forward:
        return FORWARD
    return others[int(rng.integers(len(others)))]


def _branch(settings: LSystemGenome, rng: np.random.Generator, depth: int, room: int) -> Branch:
    siblings: list[Word] = []
    for _ in range(int(rng.integers(1, settings.siblings + 1))):
        if room == 0:
            break
        length = int(rng.integers(1, settings.length[1] + 1))
        siblings.append(random_word(settings, rng, length, depth - 1, room))
        room -= siblings[-1].count
    return Branch(tuple(siblings))


def _axiom(settings: LSystemGenome, rng: np.random.Generator) -> Word:
    if settings.axiom is not None:
        return parse_word(settings.axiom, "axiom")
    length = int(rng.integers(settings.axiom_length[0], settings.axiom_length[1] + 1))
    return _drawing(random_word(settings, rng, length, 0, length), rng)


def _drawing(word: Word, rng: np.random.Generator) -> Word:
    """Give a word that holds an F: where it has none, one of its trunk's items becomes one."""
    if FORWARD in word.symbols:
        return word
    at = int(rng.integers(len(word.items)))
    return Word((*word.items[:at], FORWARD, *word.items[at + 1 :]))


def _heads(axiom: Word, settings: LSystemGenome, rng: np.random.Generator) -> list[Head]:
    """Draw operands and contexts; without ``chances`` no two are alike."""
    letters = settings.letters
    found = [symbol for symbol in dict.fromkeys(axiom.symbols) if symbol in LETTERS]
    heads: list[Head] = [(found[int(rng.integers(len(found)))], None, None)]
    while len(heads) < settings.rules:
        operand = letters[int(rng.integers(len(letters)))]
        left, right = (
            letters[int(rng.integers(len(letters)))] if rng.random() < settings.contexts else None for _ in range(2)
        )
        head = (operand, left, right)
        if settings.chances or head not in heads:
            heads.append(head)
    return heads


def _rules(heads: list[Head], settings: LSystemGenome, rng: np.random.Generator) -> tuple[Rule, ...]:
    shares = {head: iter(_shares(heads.count(head), rng)) for head in dict.fromkeys(heads)}
    rules = []
    for head in heads:
        length = int(rng.integers(settings.length[0], settings.length[1] + 1))
        depth = int(rng.integers(0, settings.depth + 1))
        word = _drawing(random_word(settings, rng, length, depth, settings.max_symbols), rng)
        rules.append(Rule(*head, next(shares[head]), word))
    return tuple(rules)


def _shares(count: int, rng: np.random.Generator) -> list[float]:
    """Divide 1 into so many chances of whole hundredths over 0, every division as likely."""
    cuts = np.sort(rng.choice(HUNDREDTHS - 1, size=count - 1, replace=False)) + 1
    return [int(part) / HUNDREDTHS for part in np.diff(np.concatenate([[0], cuts, [HUNDREDTHS]]))]
