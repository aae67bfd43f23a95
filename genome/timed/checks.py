"""What must fit together in a timed system, beyond its grammar."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from genome.errors import InputError
from genome.settings import near
from genome.timed.commands import TURTLE
from genome.timed.expression import (
    CONSTANTS,
    DEVELOPMENT,
    FUNCTIONS,
    Call,
    Expression,
    Name,
    Number,
    Place,
    draws,
    parts,
    substituted,
)
from genome.timed.reading import COMMANDS, counted
from genome.timed.scope import Scope
from genome.timed.system import BRACKETS, CLOSE, OPEN, RESERVED, Birth, Development, Production, Section, TimedSystem

MOST_NESTED: Final = 10
"""How deep development functions may call each other."""

ROUNDING: Final = 1e-9
"""Chances of productions that ask for the same may add up to this much over 1."""


def check_system(system: TimedSystem) -> None:
    """Refuse a system whose parts do not fit together.

    Raises
    ------
    InputError
        For the first thing that is wrong, with its place in the file where it came from one.
    """
    _Checks(Scope(system), ()).run()


class _Checks:
    """Checks one system, with the names of the defines around it, and those inside it."""

    def __init__(self, scope: Scope, around: Sequence[str]) -> None:
        self.scope = scope
        self.system = scope.system
        self.defines = list(around)
        self.sound: dict[tuple[int, str], bool] = {}

    def run(self) -> None:
        self._defines()
        self._symbols()
        self._figures()
        self._formals(self.system.parameters, self.system.at)
        self._word(self.system.axiom, self.system.parameters)
        for production in self.system.productions:
            self._production(production)
        self._chances()
        for development in self.system.developments:
            self._development(development)
            self._no_circle(development, self.scope, ())
        for inner in self.system.systems:
            _Checks(Scope(inner, self.scope), self.defines).run()

    def _defines(self) -> None:
        own: list[str] = []
        for define in self.system.defines:
            if define.name in CONSTANTS or define.name in RESERVED or define.name in FUNCTIONS:
                raise self._error(define.at, "a name that has no meaning yet", f"'{define.name}'")
            if define.name in own:
                raise self._error(define.at, f"'{define.name}' defined once", "a second define", "remove one")
            remedy = "draw where it is used: every module then draws its own"
            self._determined(define.value, define.at, "a constant expression", remedy)
            self._names(define.value, ())
            own.append(define.name)
            self.defines.append(define.name)

    def _determined(self, expression: Expression, at: Place, expected: str, remedy: str = "") -> None:
        """Refuse what draws at random or calls development functions."""
        for part in parts(expression):
            if isinstance(part, Call) and part.function.startswith(DEVELOPMENT):
                raise self._error(part.at, expected, f"'{part.function}'")
        if draws(expression):
            raise self._error(at, expected, "one that draws at random", remedy)

    def _figures(self) -> None:
        """Check sections and surfaces, whose names are modules."""
        seen: list[str] = []
        for figure in self.system.figures:
            inside, equiv = self.scope.inside(figure.symbol), self.scope.equiv(figure.symbol)
            if figure.symbol in TURTLE or figure.symbol in seen or inside is not None or equiv is not None:
                expected = "a name that means nothing else to the turtle"
                raise self._error(figure.at, expected, f"'{figure.symbol}'", "choose another")
            seen.append(figure.symbol)
            self._formals(figure.names, figure.at)
            for expression in (figure.radius,) if isinstance(figure, Section) else figure.place:
                self._determined(expression, figure.at, "an expression of these names and of defines")
                self._names(expression, figure.names)

    def _symbols(self) -> None:
        """Check that no symbol has two meanings."""
        for group, what in ((self.system.developments, "development function"), (self.system.equivs, "equiv")):
            seen: list[str] = []
            for one in group:
                if one.symbol in seen:
                    raise self._error(one.at, f"one {what} of '{one.symbol}'", "a second", "remove one")
                if one.symbol in BRACKETS:
                    raise self._error(one.at, "a symbol other than a bracket", f"'{one.symbol}'")
                seen.append(one.symbol)
        for equiv in self.system.equivs:
            if equiv.command in BRACKETS:
                raise self._error(equiv.at, "a symbol other than a bracket", f"'{equiv.command}'")
            self.scope.command(equiv.symbol)
        names: list[str] = []
        for inner in self.system.systems:
            if inner.name in names:
                raise self._error(inner.at, f"one system '{inner.name}'", "a second", "give it another name")
            names.append(inner.name)
            if self.scope.productions(inner.name) or self.scope.development(inner.name):
                remedy = "what a system stands for is inside it"
                raise self._error(inner.at, f"neither productions nor a development function of '{inner.name}'",
                                  "one", remedy)  # fmt: skip

    def _formals(self, names: Sequence[str], at: Place) -> None:
        for place, name in enumerate(names):
            if name in names[:place]:
                raise self._error(at, "each name of a parameter once", f"'{name}' twice")
            if name in CONSTANTS or name in RESERVED or name in self.defines:
                expected = "names of parameters that have no meaning yet"
                raise self._error(at, expected, f"'{name}'", "choose another")

    def _production(self, production: Production) -> None:
        formals = production.formals
        self._formals(formals, production.at)
        for formal in (production.predecessor, production.left, production.right):
            if formal is not None:
                self._count(formal.symbol, len(formal.parameters), formal.at)
        first = self.scope.productions(production.predecessor.symbol)[0]
        if _by_place(production) != _by_place(first):
            expected = f"the terminal age that '{production.predecessor.symbol}' has in its first production"
            raise self._error(production.at, expected, "another", "a symbol has one terminal age")
        self._names(production.end, production.predecessor.parameters)
        for expression in (production.condition, production.chance):
            if expression is not None:
                self._names(expression, formals)
        self._word(production.successor, formals)

    def _word(self, word: Sequence[Birth], formals: Sequence[str]) -> None:
        opened: list[Birth] = []
        for place, birth in enumerate(word):
            if birth.symbol == OPEN:
                opened.append(birth)
            elif birth.symbol == CLOSE:
                if not opened:
                    raise self._error(birth.at, "a '[' before this ']'", "none", "brackets must balance")
                opened.pop()
            command = word[place - 1] if place else None
            if birth.symbol in formals and not birth.arguments and command is not None:
                self._no_operand(birth, command)
            self._count(birth.symbol, len(birth.arguments), birth.at)
            for argument in (*birth.arguments, birth.age):
                self._names(argument, formals)
        if opened:
            raise self._error(opened[-1].at, "a ']' for this '['", "none", "brackets must balance")

    def _no_operand(self, birth: Birth, command: Birth) -> None:
        if command.symbol in COMMANDS and not command.arguments:
            remedy = "put a birth age with operators in parentheses: '@ (3 / t)'"
            raise self._error(birth.at, "a symbol", f"'{birth.symbol}', a parameter", remedy)

    def _count(self, symbol: str, count: int, at: Place) -> None:
        wanted = self.scope.owner(symbol).arity(symbol)
        if wanted is not None and count != wanted:
            expected = counted(wanted, "parameter", f"'{symbol}'")
            raise self._error(at, expected, str(count), "a symbol has the same number of them everywhere")

    def _names(self, expression: Expression, formals: Sequence[str]) -> None:
        for part in parts(expression):
            if isinstance(part, Name) and part.name not in formals and part.name not in self.defines:
                if part.name in CONSTANTS:
                    continue
                known = [*formals, *self.defines, *CONSTANTS]
                raise self._error(part.at, "a parameter or a define", f"'{part.name}'", near(part.name, known))
            if isinstance(part, Call):
                self._call(part)

    def _call(self, call: Call) -> None:
        if call.function in FUNCTIONS:
            if len(call.arguments) != FUNCTIONS[call.function]:
                expected = counted(FUNCTIONS[call.function], "argument", f"{call.function}()")
                raise self._error(call.at, expected, str(len(call.arguments)))
            return
        symbol = call.function.removeprefix(DEVELOPMENT)
        development = self.scope.owner(symbol).development(symbol)
        if symbol == call.function or development is None:
            raise self._error(call.at, "a function, or the development function of a symbol that has one",
                              f"'{call.function}'")  # fmt: skip
        if len(call.arguments) != len(development.names):
            head = f"{call.function}({', '.join(development.names)})"
            expected = counted(len(development.names), "argument", head)
            raise self._error(call.at, expected, str(len(call.arguments)))

    def _chances(self) -> None:
        """Check the chances that are plain numbers."""
        sums: dict[object, float] = {}
        for production in self.system.productions:
            chance = production.chance
            if isinstance(chance, Number):
                head = production.predecessor, production.left, production.right, production.condition
                sums[head] = sums.get(head, 0.0) + chance.value
                if sums[head] > 1.0 + ROUNDING:
                    expected = f"chances of '{production.predecessor.symbol}' that add up to 1 at most"
                    raise self._error(production.at, expected, f"{sums[head]:.6g} up to this line")

    def _development(self, development: Development) -> None:
        for place, name in enumerate(development.names):
            if name in development.names[:place]:
                raise self._error(development.at, "each name once", f"'{name}' twice")
            if name in CONSTANTS or name in self.defines:
                raise self._error(development.at, "names of parameters that have no meaning yet", f"'{name}'")
        self.scope.slots(development)
        self._names(development.body, development.names)

    def _no_circle(self, development: Development, scope: Scope, before: tuple[str, ...]) -> None:
        if (id(scope.system), development.symbol) in self.sound:
            return
        if len(before) > MOST_NESTED:
            raise self._error(development.at, f"development functions that call at most {MOST_NESTED} deep", "more")
        if development.symbol in before:
            circle = " ".join(DEVELOPMENT + symbol for symbol in (*before, development.symbol))
            raise self._error(development.at, "development functions that call no circle", circle)
        for part in parts(development.body):
            if isinstance(part, Call) and part.function.startswith(DEVELOPMENT):
                symbol = part.function.removeprefix(DEVELOPMENT)
                owner = scope.owner(symbol)
                called = owner.development(symbol)
                if called is not None:
                    self._no_circle(called, owner, (*before, development.symbol))
        self.sound[id(scope.system), development.symbol] = True

    def _error(self, at: Place, expected: str, got: str, remedy: str = "") -> InputError:
        return InputError(self.system.complaint_place(at), expected, got, remedy)


def _by_place(production: Production) -> Expression:
    """Give the terminal age with the predecessor's parameters named by their places."""
    names: Iterable[tuple[int, str]] = enumerate(production.predecessor.parameters)
    values: Mapping[str, Expression] = {name: Name(f"{place}") for place, name in names}
    return substituted(production.end, values)
