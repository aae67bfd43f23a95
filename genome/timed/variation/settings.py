"""The settings under ``genome:`` of an island of timed forms."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from genome.errors import InputError
from genome.settings import Settings, describe

Rate = Annotated[float, Field(ge=0, le=1)]


def _as_bounds(value: object) -> object:
    """Take a list as the least and the most."""
    if isinstance(value, (list, tuple)):
        return {"bounds": list(value)}
    if isinstance(value, (dict, NumberBounds)):
        return value
    raise InputError("", "the least and the most, such as [0.5, 2], or {bounds: [3, 9], whole: true}", describe(value))


def _as_pair(value: object) -> object:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise InputError("", "the least and the most: [0.5, 2]", describe(value))
    if not all(type(one) in (int, float) and math.isfinite(one) for one in value):
        raise InputError("", "two finite numbers: [0.5, 2]", describe(value))
    low, high = value
    if low > high:
        raise InputError("", "the least and the most: [0.5, 2]", describe(list(value)), "write the smaller first")
    return float(low), float(high)


class NumberBounds(Settings):
    """Between which values a define varies.

    Attributes
    ----------
    bounds
        The least and the most.
    whole
        Whether it takes whole numbers alone.
    """

    bounds: Annotated[tuple[float, float], BeforeValidator(_as_pair)]
    whole: bool = False

    @model_validator(mode="after")
    def _holds_one(self) -> Self:
        low, high = self.bounds
        if self.whole and math.ceil(low) > math.floor(high):
            remedy = "leave out whole, or set them further apart"
            raise InputError("", "bounds with a whole number between them", describe([low, high]), remedy)
        return self


class ProductionRates(Settings):
    """How likely each event is when a production is mutated; only their proportions count.

    Attributes
    ----------
    rewrite
        The whole successor is written anew.
    graft
        A branch, or modules side by side, are replaced by what is written anew.
    insert
        A module that is written anew is put somewhere.
    remove
        A branch, or modules side by side, go.
    duplicate
        A branch, or modules side by side, are copied to another place.
    condition
        The condition is written anew, or added.
    split
        A production of the same symbol is added before this one, with a condition of its own.
    drop
        The production goes; the last one of a symbol stays.
    """

    rewrite: Rate = 0.1
    graft: Rate = 0.3
    insert: Rate = 0.2
    remove: Rate = 0.15
    duplicate: Rate = 0.1
    condition: Rate = 0.05
    split: Rate = 0.05
    drop: Rate = 0.05


class TimedGenome(Settings):
    """How timed systems are drawn at random, varied, and kept from growing without end.

    Attributes
    ----------
    system
        What all begin with: the name of a shipped system (such as ``flower``), or the path of a ``.tl`` file, told by
        its ending or a slash in it.
    numbers
        Which defines vary, and between which values; the others stay as the file has them.
    literals
        Numbers that stand in the axiom, and in productions that vary, lie within this factor of those that the file
        has for the same (see :func:`genome.timed.variation.bounds.bounds_of`); with 1 none varies.
    grammar
        What productions are written in: the path of a ``.bnf`` file; without, the system's own alphabet (see
        :func:`genome.timed.variation.alphabet.own_grammar`).
    productions
        The symbols whose productions vary; all without.
    protected
        Symbols whose productions do not vary.
    rewritten
        The chance of each production that varies to have another successor in the first population.
    production_mutation
        The chance of a mutated genotype to have a production changed.
    number_mutation
        The chance of each number of a mutated genotype to change.
    number_step
        The standard deviation of a change, as a share of the distance between the number's bounds.
    reseed
        The chance of a mutated genotype to have another seed; only where its system draws at random.
    mutations
        See :class:`ProductionRates`.
    crossover
        ``symbols`` exchanges all productions of a symbol, and defines, each with even chances; ``words`` exchanges a
        branch, or modules side by side, between productions of one symbol.
    genes
        How many are drawn to write something by the grammar.
    grammar_depth
        The depth of the derivation tree that only short productions of the grammar may reach.
    max_modules, max_depth
        What a successor may hold: modules and brackets, and branches inside each other; the file's own may hold more.
    max_productions
        How many there may be; the file may have more.
    """

    system: Annotated[str, Field(min_length=1)]
    numbers: dict[str, Annotated[NumberBounds, BeforeValidator(_as_bounds)]] = Field(default_factory=dict)
    literals: Annotated[float, Field(ge=1, le=1000)] = 2.0
    grammar: Annotated[str, Field(min_length=1)] | None = None
    productions: list[str] | None = None
    protected: list[str] = Field(default_factory=list)
    rewritten: Rate = 0.3
    production_mutation: Rate = 0.5
    number_mutation: Rate = 0.15
    number_step: Annotated[float, Field(gt=0, le=1)] = 0.1
    reseed: Rate = 0.1
    mutations: ProductionRates = ProductionRates()
    crossover: Literal["symbols", "words"] = "symbols"
    genes: Annotated[int, Field(ge=4, le=100_000)] = 60
    grammar_depth: Annotated[int, Field(ge=1, le=1000)] = 8
    max_modules: Annotated[int, Field(ge=1, le=10_000)] = 40
    max_depth: Annotated[int, Field(ge=0, le=100)] = 4
    max_productions: Annotated[int, Field(ge=1, le=1000)] = 40
