"""The settings under ``genome:`` of an island of block bodies."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from genome.errors import InputError
from genome.lsystem.symbols import FORWARD, LETTERS, SPELLINGS, SYMBOLS
from genome.lsystem.word import MOST_NESTED, Word, parse_word
from genome.settings import Settings, describe

Crossover = Literal["one_point", "common_region"]

Rate = Annotated[float, Field(ge=0, le=1)]
Count = Annotated[int, Field(ge=1, le=1000)]


def _as_range(value: object) -> object:
    """Take a list as a range, and a single number as the range that holds it alone."""
    if type(value) is int:
        return value, value
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise InputError("", "a whole number, or the least and the most: [2, 4]", describe(value))
    if all(type(one) is int for one in value) and value[0] > value[1]:
        raise InputError("", "the least and the most: [2, 4]", describe(list(value)), "write the smaller first")
    return tuple(value)


def _as_symbols(value: object) -> object:
    """Write symbols in one way; each may stand there once, and one of them draws."""
    if not isinstance(value, str):
        return value
    text = "".join(SPELLINGS.get(one, one) for one in value if not one.isspace())
    for one in text:
        if one not in SYMBOLS:
            raise InputError("", "symbols: capital letters, + - & ^ £ $ %", f"'{one}'", "brackets are not listed")
    if len(dict.fromkeys(text)) < len(text) or FORWARD not in text:
        raise InputError("", f"symbols, each once and {FORWARD} among them", describe(value))
    return text


def _as_axiom(value: object) -> object:
    """Write an axiom in one way; rules must find a letter in it."""
    if not isinstance(value, str):
        return value
    word = parse_word(value, "axiom")
    if not any(symbol in LETTERS for symbol in word.symbols):
        raise InputError("", "a word with a letter that rules can rewrite", describe(value), "such as F")
    return str(word)


Range = Annotated[tuple[Count, Count], BeforeValidator(_as_range)]
"""The least and the most of something that is drawn evenly between them, both included."""


class MutationRates(Settings):
    """The chance of each event when a genotype is mutated (Senatore 2009, 'mutation').

    One event at least takes place: where none was drawn, one is, in proportion to these.

    Attributes
    ----------
    add
        A new random branch.
    delete
        A branch goes; one that it bears may take its place.
    duplicate
        A branch is copied to another place.
    invert
        A branch is read from its end.
    change
        One symbol becomes another.
    reseed
        The seed is drawn anew; only where a rule has a chance under 1.
    """

    add: Rate = 0.15
    delete: Rate = 0.15
    duplicate: Rate = 0.1
    invert: Rate = 0.1
    change: Rate = 0.5
    reseed: Rate = 0.05


class LSystemGenome(Settings):
    """How L-systems are drawn at random, varied, and kept from growing without end.

    Attributes
    ----------
    symbols
        What random words are made of; the letters among them are what rules rewrite and match.
    forward
        The chance that a random symbol is F; the others are equally likely.
    axiom
        The axiom of all; drawn for each where not given.
    axiom_length
        How many symbols and branch points the trunk of a random axiom has.
    rules
        How many there are.
    length
        How many symbols and branch points a random successor's trunk has, and each of its branches at most.
    depth
        How many branches a random successor has inside each other at most; drawn evenly from 0 for each.
    branching
        The chance that a random word has a branch point where else a symbol would be.
    siblings
        How many branches may grow from one random branch point at most.
    chances
        Whether several rules may share one operand and context by chance. The shares are drawn evenly.
    contexts
        The chance that a random rule has a left context, and again that it has a right one.
    iterations
        How often the word is rewritten; drawn evenly for each genotype, inherited.
    max_symbols, max_depth
        What a successor may hold: symbols, and branches inside each other. Offspring beyond are never made.
    mutations
        See :class:`MutationRates`.
    crossover
        ``one_point`` exchanges what follows any place of one successor and any of the other, ``common_region`` what
        follows one place that both have alike.
    """

    symbols: Annotated[str, BeforeValidator(_as_symbols)] = "F+-&^£$%"
    forward: Annotated[float, Field(gt=0, le=1)] = 0.4
    axiom: Annotated[str, BeforeValidator(_as_axiom)] | None = None
    axiom_length: Range = (1, 4)
    rules: Annotated[int, Field(ge=1, le=100)] = 2
    length: Range = (3, 8)
    depth: Annotated[int, Field(ge=0, le=MOST_NESTED)] = 2
    branching: Annotated[float, Field(ge=0, lt=1)] = 0.2
    siblings: Annotated[int, Field(ge=1, le=20)] = 3
    chances: bool = True
    contexts: Rate = 0.0
    iterations: Range = (2, 4)
    max_symbols: Annotated[int, Field(ge=1, le=10_000)] = 60
    max_depth: Annotated[int, Field(ge=0, le=MOST_NESTED)] = 4
    mutations: MutationRates = MutationRates()
    crossover: Crossover = "one_point"

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.length[1] > self.max_symbols:
            raise InputError("", f"a length of {self.max_symbols} at most, as max_symbols says", describe(self.length))
        if self.depth > self.max_depth:
            raise InputError("", f"a depth of {self.max_depth} at most, as max_depth says", describe(self.depth))
        letters = sum(one in LETTERS for one in self.symbols)
        heads = letters if self.contexts == 0.0 else letters * (letters + 1) ** 2
        if not self.chances and self.rules > heads:
            remedy = "list more letters in symbols, or set chances: true"
            raise InputError("", f"{heads} rules at most where no two may share an operand", f"{self.rules}", remedy)
        return self

    @property
    def letters(self) -> str:
        """The letters among the symbols: what rules rewrite and match."""
        return "".join(one for one in self.symbols if one in LETTERS)

    def fits(self, word: Word) -> bool:
        """Say whether a successor is within the bounds, and not empty."""
        return bool(word.items) and word.count <= self.max_symbols and word.depth <= self.max_depth
