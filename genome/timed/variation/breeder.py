"""Breeds timed genotypes: draws, mutates and crosses them, so that every one of them is a system of the language."""

from __future__ import annotations

from pathlib import Path
from typing import Final, final

import numpy as np

from genome.bnf import parse_bnf
from genome.errors import InputError
from genome.grammar import Grammar
from genome.settings import near
from genome.timed.checks import check_system
from genome.timed.genotype import SEEDS, TimedGenotype
from genome.timed.system import TimedSystem
from genome.timed.variation.alphabet import own_grammar
from genome.timed.variation.bounds import Bounds
from genome.timed.variation.constants import stillborn
from genome.timed.variation.crossover import by_symbol, by_words
from genome.timed.variation.events import EVENTS, Site
from genome.timed.variation.loading import Where, load_grammar, load_system
from genome.timed.variation.numbers import Numbers
from genome.timed.variation.probing import probe
from genome.timed.variation.settings import TimedGenome
from genome.timed.variation.structure import bare_productions, stochastic, with_productions
from genome.timed.variation.words import depth
from genome.timed.variation.writer import Writer

TRIES: Final = 12
"""Events and crossings that are drawn until one gives another system that may be."""

NOTHING: Final = "<Nothing> ::= nothing\n"
"""The grammar of an island on which no production varies."""


def bare_key(*keys: str) -> str:
    """Give a key of no island."""
    return ".".join(keys)


@final
class Breeder:
    """Breeds the variants of one file.

    Parameters
    ----------
    settings
        What varies, and how much.
    system
        What all begin with.
    where
        Gives the place of a key of the island, for messages.
    grammar
        What productions are written in; without, the system's own.

    Attributes
    ----------
    system
        As given.
    symbols
        Those whose productions vary, in the system's order.
    grammar
        The text of the system's own grammar; empty where one was given, or nothing varies.

    Raises
    ------
    InputError
        With the key of the island, for a define or a symbol that the system has not, and a grammar that writes what the
        language does not take.
    """

    def __init__(
        self, settings: TimedGenome, system: TimedSystem, where: Where = bare_key, grammar: Grammar | None = None
    ) -> None:
        self._settings: Final = settings
        self.system: Final = system
        _check_defines(settings, system, where)
        self.symbols: Final = _varying(settings, system, where)
        self.grammar: Final = own_grammar(system, self.symbols) if grammar is None else ""
        made = parse_bnf(self.grammar or NOTHING, "own.bnf") if grammar is None else grammar
        self._writer: Final = Writer(made, system, settings.genes, settings.grammar_depth)
        if grammar is not None:
            probe(self._writer, system, self.symbols, where("genome", "grammar"))
        bounds = {name: Bounds(*one.bounds, one.whole) for name, one in settings.numbers.items()}
        self._numbers: Final = Numbers(system, bounds, settings.literals, self.symbols.__contains__)
        self._stillborn: Final = stillborn(system)
        words = [one.successor for one in system.productions]
        self._longest: Final = max([settings.max_modules, *map(len, words)])
        self._deepest: Final = max([settings.max_depth, *map(depth, words)])
        self._most: Final = max(settings.max_productions, len(words))

    def random(self, rng: np.random.Generator) -> TimedGenotype:
        """Draw a genotype: the file's system, its numbers drawn within their bounds, some successors written anew."""
        system = self.system
        for _ in range(TRIES):
            drawn = self._numbers.drawn(self.system, rng)
            if self.may_be(drawn):
                system = drawn
                break
        for at, production in enumerate(system.productions):
            if production.predecessor.symbol in self.symbols and rng.random() < self._settings.rewritten:
                system = self._after("rewrite", system, at, rng) or system
        return TimedGenotype(system, _seed(rng) if stochastic(system) else 0)

    def mutate(self, genotype: TimedGenotype, rng: np.random.Generator) -> TimedGenotype:
        """Change a production, or numbers, or both; one of them at least where anything can be changed."""
        settings, system = self._settings, genotype.system
        structural = rng.random() < settings.production_mutation
        if structural:
            system = self._restructured(system, rng)
        numbered = self._numbers.mutated(system, rng, settings.number_mutation, settings.number_step)
        system = numbered if self.may_be(numbered) else system
        seed = genotype.seed
        if stochastic(system) and (rng.random() < settings.reseed or not stochastic(genotype.system)):
            seed = _seed(rng)
        for _ in range(TRIES):
            if system != genotype.system or seed != genotype.seed:
                break
            one = self._numbers.one_mutated(system, rng, settings.number_step)
            if one == system and settings.production_mutation > 0.0:
                one = self._restructured(system, rng)
            system = one if self.may_be(one) else system
        return TimedGenotype(system, seed)

    def crossover(
        self, first: TimedGenotype, second: TimedGenotype, rng: np.random.Generator
    ) -> tuple[TimedGenotype, TimedGenotype]:
        """Exchange productions and defines, or parts of words; a child that may not be is its parent."""
        cross = by_symbol if self._settings.crossover == "symbols" else by_words
        parents = first.system, second.system
        children = parents
        for _ in range(TRIES):
            made = cross(*parents, self.symbols, rng)
            one, other = (child if self.may_be(child) else old for child, old in zip(made, parents, strict=True))
            children = one, other
            if children[0] not in parents or children[1] not in parents:
                break
        return TimedGenotype(children[0], first.seed), TimedGenotype(children[1], second.seed)

    def may_be(self, system: TimedSystem) -> bool:
        """Tell whether a system is one of the language, within the limits, its modules born before they die."""
        words = [one.successor for one in system.productions]
        if len(words) > self._most or any(len(one) > self._longest or depth(one) > self._deepest for one in words):
            return False
        if any(symbol not in self._stillborn for symbol in stillborn(system)):
            return False
        try:
            check_system(system)
        except InputError:
            return False
        return True

    def _restructured(self, system: TimedSystem, rng: np.random.Generator) -> TimedSystem:
        """Change one production, so that it is another and not only its numbers are."""
        places = [at for at, one in enumerate(system.productions) if one.predecessor.symbol in self.symbols]
        rates = self._settings.mutations.model_dump()
        names = [name for name in EVENTS if rates[name] > 0.0]
        if not places or not names:
            return system
        weights = np.array([rates[name] for name in names])
        before = bare_productions(system)
        for _ in range(TRIES):
            name = names[int(rng.choice(len(names), p=weights / weights.sum()))]
            found = self._after(name, system, places[int(rng.integers(len(places)))], rng)
            if found is not None and bare_productions(found) != before:
                return found
        return system

    def _after(self, name: str, system: TimedSystem, at: int, rng: np.random.Generator) -> TimedSystem | None:
        """Give a system after an event; ``None`` where there is nothing to do, or it may not be."""
        production = system.productions[at]
        alike = sum(one.predecessor.symbol == production.predecessor.symbol for one in system.productions)
        new = EVENTS[name](Site(production, alike - 1, self._writer), rng)
        found = None if new is None else with_productions(system, at, new)
        return found if found is not None and self.may_be(found) else None


def load_breeder(settings: TimedGenome, base: Path, where: Where) -> Breeder:
    """Read the files that settings name, and make the breeder.

    Parameters
    ----------
    settings
        Of the island.
    base
        The folder from which paths start.
    where
        Gives the place of a key of the island, for messages.

    Raises
    ------
    InputError
        With the key of the island, for a file that is missing or malformed, and as of :class:`Breeder`.
    """
    system = load_system(settings.system, base, where)
    grammar = None if settings.grammar is None else load_grammar(settings.grammar, base, where)
    return Breeder(settings, system, where, grammar)


def _seed(rng: np.random.Generator) -> int:
    return int(rng.integers(0, SEEDS, dtype=np.uint64))


def _check_defines(settings: TimedGenome, system: TimedSystem, where: Where) -> None:
    known = [define.name for define in system.defines]
    for name in settings.numbers:
        if name not in known:
            raise InputError(where("genome", "numbers", name), f"a define of {settings.system}", f"'{name}'",
                             near(name, known) if known else "it has none")  # fmt: skip


def _varying(settings: TimedGenome, system: TimedSystem, where: Where) -> tuple[str, ...]:
    """Give the symbols whose productions vary."""
    known = list(dict.fromkeys(one.predecessor.symbol for one in system.productions))
    for key, names in (("productions", settings.productions or ()), ("protected", settings.protected)):
        for name in names:
            if name not in known:
                raise InputError(where("genome", key), f"symbols with a production in {settings.system}", f"'{name}'",
                                 near(name, known) if known else "it has none")  # fmt: skip
    chosen = known if settings.productions is None else settings.productions
    return tuple(one for one in known if one in chosen and one not in settings.protected)
