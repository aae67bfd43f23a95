"""The genotype of block bodies: an axiom, production rules, and how often they are applied."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, final

from genome.errors import InputError
from genome.lsystem.symbols import FORWARD, LETTERS
from genome.lsystem.word import Word
from genome.settings import describe

MOST_ITERATIONS: Final = 1000
SEEDS: Final = 2**63
"""Seeds are integers from 0 up to, and without, this."""

ROUNDING: Final = 1e-9
"""Chances of one operand and context may add up to this much over 1."""

Head = tuple[str, str | None, str | None]
"""An operand with its left and right context: rules that have it in common share by chance."""


@final
@dataclass(frozen=True, slots=True)
class Rule:
    """A production rule: where the operand stands between its contexts, the successor may take its place.

    Attributes
    ----------
    operand
        A capital letter.
    left
        The nearest letter before it on the way to the root must be this one; ``None`` where any may, or none.
    right
        The next letter on its own branch must be this one; ``None`` where any may, or none.
    chance
        Over 0 and up to 1. What the rules of one head leave of 1 is the chance that the operand stays as it is.
    successor
        Never empty.

    Raises
    ------
    InputError
        For anything else.
    """

    operand: str
    left: str | None
    right: str | None
    chance: float
    successor: Word

    def __post_init__(self) -> None:
        for name in ("operand", "left", "right"):
            letter = getattr(self, name)
            missing = letter is None and name != "operand"
            if not missing and (not isinstance(letter, str) or len(letter) != 1 or letter not in LETTERS):
                raise InputError(f"rule: {name}", "a capital letter", describe(letter))
        if type(self.chance) is not float or not 0.0 < self.chance <= 1.0:
            raise InputError("rule: chance", "a number over 0 and up to 1", describe(self.chance))
        if type(self.successor) is not Word or not self.successor.items:
            raise InputError("rule: successor", "a word of one symbol or more", describe(self.successor))

    @property
    def head(self) -> Head:
        """What rules that share by chance have in common."""
        return self.operand, self.left, self.right


@final
@dataclass(frozen=True, slots=True)
class LSystem:
    """A bracketed, stochastic, context-sensitive L-system.

    Attributes
    ----------
    axiom
        The word that rewriting starts from; never empty.
    rules
        In the order written; the chances of one head add up to 1 at most.
    iterations
        How many times the whole word is rewritten.
    seed
        Decides what rules with chances do, so that growth is a function of the genotype; inherited.

    Raises
    ------
    InputError
        For anything else.
    """

    axiom: Word
    rules: tuple[Rule, ...]
    iterations: int
    seed: int

    def __post_init__(self) -> None:
        if type(self.axiom) is not Word or not self.axiom.items:
            raise InputError("axiom", "a word of one symbol or more", describe(self.axiom))
        if type(self.iterations) is not int or not 0 <= self.iterations <= MOST_ITERATIONS:
            raise InputError("iterations", f"a whole number from 0 to {MOST_ITERATIONS}", describe(self.iterations))
        if type(self.seed) is not int or not 0 <= self.seed < SEEDS:
            raise InputError("seed", "a whole number from 0 to 2**63 - 1", describe(self.seed))
        for (operand, left, right), chance in chances(self.rules).items():
            if chance > 1.0 + ROUNDING:
                head = written_head((operand, left, right))
                raise InputError(f"rules of {head}", "chances that add up to 1 at most", f"{chance:.6g}")

    @property
    def stochastic(self) -> bool:
        """Whether the seed decides anything."""
        return any(rule.chance < 1.0 for rule in self.rules)

    @property
    def draws(self) -> bool:
        """Whether a word of this system can hold an F after its last rewriting.

        Contexts are taken to match wherever they are wanted: a system that does not draw in this sense never draws.
        """
        shares = chances(self.rules)
        partial = {head[0] for head, chance in shares.items() if chance < 1.0 - ROUNDING}
        goes = {letter for letter in LETTERS if letter not in partial and (letter, None, None) in shares}
        after = {letter: "" if letter in goes else letter for letter in LETTERS}
        for rule in self.rules:
            after[rule.operand] += "".join(rule.successor.symbols)
        present = _letters("".join(self.axiom.symbols))
        for _ in range(self.iterations):
            following = _letters("".join(after[letter] for letter in present))
            if following == present:
                break
            present = following
        return FORWARD in present


def chances(rules: tuple[Rule, ...]) -> dict[Head, float]:
    """Add up the chances of each head, heads in the order of their first rule."""
    parts: dict[Head, list[float]] = {}
    for rule in rules:
        parts.setdefault(rule.head, []).append(rule.chance)
    return {head: math.fsum(values) for head, values in parts.items()}


def written_head(head: Head) -> str:
    """Write an operand with its contexts as files have it."""
    operand, left, right = head
    return f"{f'{left} < ' if left else ''}{operand}{f' > {right}' if right else ''}"


def _letters(text: str) -> str:
    """Give the letters of a text, each once and in alphabetical order."""
    return "".join(letter for letter in LETTERS if letter in text)
