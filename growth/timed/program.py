"""Compiling timed systems: every symbol becomes a code, every expression instructions of the stack machine."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple, final

import numpy as np

from genome.errors import InputError
from genome.timed import Birth, Formal, Production, Scope, TimedSystem
from genome.timed.expression import ZERO, draws
from genome.timed.system import AGE, BRACKETS, TERMINAL
from growth.timed.assembler import Assembler, Meanings, Place
from growth.timed.figures import Figures
from growth.timed.tables import NONE, OPEN_CODE, START_CODE, TROUBLES, Ints, Tables
from growth.timed.tabulating import Tabulator

START: Final = "axiom"
"""What messages call that which the axiom comes from."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Program:
    """A timed system, compiled.

    Attributes
    ----------
    tables
        For the kernels.
    names
        The symbol of each code, as files and words have it.
    commands
        The symbol that the turtle takes each code for.
    contextual
        Whether a production asks for contexts: then instants are rewritten one after the other.
    radians
        Whether turns are in radians.
    figures
        Cross-sections and surfaces.
    """

    tables: Tables
    names: tuple[str, ...]
    commands: tuple[str, ...]
    contextual: bool
    radians: bool
    figures: Figures


class _Rule(NamedTuple):
    """A production with its codes and numbers of expressions."""

    condition: int
    chance: int
    left: int
    right: int
    births: tuple[int, int]

    @property
    def plain(self) -> bool:
        """Whether it asks for nothing."""
        return (self.condition, self.chance, self.left, self.right) == (NONE, NONE, NONE, NONE)


class _Symbol(NamedTuple):
    """What becomes of a code."""

    rules: list[_Rule]
    end: int
    growth: int
    calls: bool
    again: bool


class _Born(NamedTuple):
    """A birth with its code and numbers of expressions."""

    code: int
    arguments: tuple[int, int]
    age: int


def compile_system(system: TimedSystem) -> Program:
    """Compile a system that is checked.

    Raises
    ------
    InputError
        When a define has no value, a section a radius of 0 or less, a surface no place, or the system is too large.
    """
    return _Compiler(system).program()


class _Compiler:
    """Compiles one system and those inside it."""

    def __init__(self, system: TimedSystem) -> None:
        self.system = system
        self.assembler = Assembler(2 + _widest(system))
        self.zero = self.assembler.constant(0.0)
        self.codes: dict[tuple[int, str], int] = {}
        self.names: list[str] = []
        self.commands: list[str] = []
        self.waiting: list[tuple[Place, str]] = []
        self.births: list[_Born] = []
        self.symbols: list[_Symbol] = []
        self.ignored: dict[int, bool] = {}
        self.figures = Tabulator()

    def program(self) -> Program:
        outermost = self._inside(Scope(self.system), None)
        for bracket in BRACKETS:
            self._code(outermost, bracket)
        self.names.append(START)
        self.commands.append(START)
        self.figures.choose(None, START)
        self.waiting.append((outermost, START))
        assert self.names.index("[") == OPEN_CODE
        assert len(self.names) == START_CODE + 1
        self._ignore(outermost)
        # Codes are given where a symbol is first met; what they become is compiled in the same order.
        while len(self.symbols) < len(self.waiting):
            code = len(self.symbols)
            self.symbols.append(self._symbol(*self.waiting[code], started=code != START_CODE))
        rules = [rule for symbol in self.symbols for rule in symbol.rules]
        contextual = any(rule.left != NONE or rule.right != NONE for rule in rules)
        names, commands, figures = tuple(self.names), tuple(self.commands), self.figures.figures()
        return Program(self._tables(rules), names, commands, contextual, self.system.radians, figures)

    def _inside(self, scope: Scope, outer: Place | None) -> Place:
        """Give the place of a system, its defines evaluated."""
        defines: dict[str, float] = {} if outer is None else dict(outer.defines)
        place = Place(scope, defines, outer)
        for define in scope.system.defines:
            value, trouble = self.assembler.value(self.assembler.add(define.value, place.meanings({}), place))
            if trouble or not math.isfinite(value):
                got = TROUBLES.get(trouble, "a value that is not finite")
                raise InputError(scope.system.complaint_place(define.at), f"a value of {define.name}", got)
            defines[define.name] = value
        self.figures.add(place)
        return place

    def _ignore(self, place: Place) -> None:
        for symbol in place.scope.system.ignored:
            self.ignored[self._code(place, symbol)] = True

    def _code(self, place: Place, symbol: str) -> int:
        """Give the code of a symbol as seen from a place."""
        owner = place.owner(symbol)
        key = id(owner.scope.system), symbol
        if key not in self.codes:
            self.codes[key] = len(self.names)
            self.names.append(symbol)
            holder, command = owner.command(symbol)
            self.commands.append(command)
            self.figures.choose(holder, command)
            self.waiting.append((owner, symbol))
        return self.codes[key]

    def _symbol(self, place: Place, symbol: str, *, started: bool) -> _Symbol:
        inner = place.scope.inside(symbol) if started else None
        if inner is not None or not started:
            inside = place if inner is None else self._inside(Scope(inner, place.scope), place)
            if inner is not None:
                self._ignore(inside)
            meanings = inside.meanings(_numbered(inside.scope.system.parameters))
            rule = _Rule(NONE, NONE, NONE, NONE, self._word(inside.scope.system.axiom, inside, meanings))
            return _Symbol([rule], self.zero, NONE, calls=True, again=False)
        productions = place.scope.productions(symbol)
        end = NONE
        if productions:
            first = productions[0]
            end = self.assembler.add(first.end, place.meanings(_numbered(first.predecessor.parameters)), place)
        rules = [self._rule(production, place) for production in productions]
        return _Symbol(rules, end, self._growth(place, symbol), calls=False, again=any(map(_changes, productions)))

    def _rule(self, production: Production, place: Place) -> _Rule:
        meanings = place.meanings(_numbered(production.formals))
        condition, chance = (
            NONE if expression is None else self.assembler.add(expression, meanings, place)
            for expression in (production.condition, production.chance)
        )
        left, right = (self._context(formal, place) for formal in (production.left, production.right))
        return _Rule(condition, chance, left, right, self._word(production.successor, place, meanings))

    def _context(self, formal: Formal | None, place: Place) -> int:
        return NONE if formal is None else self._code(place, formal.symbol)

    def _word(self, word: tuple[Birth, ...], place: Place, meanings: Meanings) -> tuple[int, int]:
        begin = len(self.births)
        for birth in word:
            arguments = self.assembler.row(birth.arguments, meanings, place)
            age = self.zero if birth.age == ZERO else self.assembler.add(birth.age, meanings, place)
            self.births.append(_Born(self._code(place, birth.symbol), arguments, age))
        return begin, len(self.births)

    def _growth(self, place: Place, symbol: str) -> int:
        development = place.scope.development(symbol)
        if development is None:
            return NONE
        slots = {name: 2 + slot for name, slot in place.scope.slots(development).items()}
        return self.assembler.add(development.body, place.meanings({**slots, AGE: 0, TERMINAL: 1}), place)

    def _tables(self, rules: list[_Rule]) -> Tables:
        made, births = self.assembler, self.births
        symbols: list[tuple[int, ...]] = []
        begin = 0
        for code, symbol in enumerate(self.symbols):
            end = begin + len(symbol.rules)
            ignored, plain = self.ignored.get(code, False), len(symbol.rules) == 1 and symbol.rules[0].plain
            symbols.append((begin, end, symbol.end, symbol.growth, symbol.calls, symbol.again, ignored, plain))
            begin = end
        words = [births[rule.births[0] : rule.births[1]] for rule in rules]
        return Tables(
            ops=_ints(made.ops, 1),
            args=np.array(made.args, dtype=np.float64),
            spans=_ints(made.spans, 2),
            known=np.array(made.known, dtype=np.float64),
            loads=_ints(made.loads, 1),
            symbols=_ints(symbols, 8),
            rules=_ints([(*rule[:4], *rule.births) for rule in rules], 6),
            births=_ints([(birth.code, *birth.arguments, birth.age, self._settled(birth)) for birth in births], 5),
            room=made.room,
            most_values=max(sum(last - first for _, (first, last), _ in word) for word in words),
        )

    def _settled(self, birth: _Born) -> bool:
        """Whether nothing of a birth has to be computed when it happens, and nothing of it can be wrong."""
        known, symbol = self.assembler.known, self.symbols[birth.code]
        given = all(math.isfinite(known[one]) or self.assembler.loads[one] != NONE for one in range(*birth.arguments))
        aged = 0.0 <= known[birth.age] < math.inf
        return given and aged and not symbol.calls and (symbol.end == NONE or known[symbol.end] >= 0.0)


def _ints(values: object, columns: int) -> Ints:
    found = np.array(values, dtype=np.int64)
    return found if columns == 1 else found.reshape(-1, columns)


def _numbered(names: tuple[str, ...]) -> Mapping[str, int]:
    return {name: slot for slot, name in enumerate(names)}


def _changes(production: Production) -> bool:
    """Whether a production that does not match now may match later."""
    if production.left is not None or production.right is not None or production.chance is not None:
        return True
    return production.condition is not None and draws(production.condition)


def _widest(system: TimedSystem) -> int:
    """Give the most parameters that anything has."""
    words = [system.axiom, *(production.successor for production in system.productions)]
    counts = [len(birth.arguments) for word in words for birth in word]
    counts += [len(production.formals) for production in system.productions]
    counts += [len(development.names) for development in system.developments]
    return max([len(system.parameters), *counts, *map(_widest, system.systems)])
