"""What symbols and names mean where systems stand inside each other.

A symbol belongs to the innermost system around it that has a production, a development function, an equiv, a section, a
surface or a system for it, and to the outermost where none has. Defines are seen from inside.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from genome.errors import InputError
from genome.timed.system import RESERVED, Development, Equiv, Production, TimedSystem


@final
@dataclass(frozen=True, slots=True, eq=False)
class Scope:
    """A system and the scope around it."""

    system: TimedSystem
    outer: Scope | None = None

    def owner(self, symbol: str) -> Scope:
        """Give the scope that a symbol belongs to, as seen from here."""
        scope = self
        while not scope.has(symbol) and scope.outer is not None:
            scope = scope.outer
        return scope

    def has(self, symbol: str) -> bool:
        """Whether this system says something of a symbol."""
        system = self.system
        return (
            any(production.predecessor.symbol == symbol for production in system.productions)
            or any(development.symbol == symbol for development in system.developments)
            or any(equiv.symbol == symbol for equiv in system.equivs)
            or any(inner.name == symbol for inner in system.systems)
            or any(figure.symbol == symbol for figure in system.figures)
        )

    def productions(self, symbol: str) -> tuple[Production, ...]:
        """Give this system's productions of a symbol, in the order in which they are asked."""
        return tuple(one for one in self.system.productions if one.predecessor.symbol == symbol)

    def development(self, symbol: str) -> Development | None:
        """Give this system's development function of a symbol."""
        return next((one for one in self.system.developments if one.symbol == symbol), None)

    def inside(self, symbol: str) -> TimedSystem | None:
        """Give the system inside this one that a symbol stands for."""
        return next((one for one in self.system.systems if one.name == symbol), None)

    def arity(self, symbol: str) -> int | None:
        """Give how many parameters a symbol of this system has; ``None`` where it may have any number."""
        productions, inner = self.productions(symbol), self.inside(symbol)
        if productions:
            return len(productions[0].predecessor.parameters)
        if inner is not None:
            return len(inner.parameters)
        development = self.development(symbol)
        named = 0 if development is None else sum(name not in RESERVED for name in development.names)
        return named or None

    def equiv(self, symbol: str) -> Equiv | None:
        """Give this system's equiv of a symbol."""
        return next((one for one in self.system.equivs if one.symbol == symbol), None)

    def command(self, symbol: str) -> str:
        """Give the symbol that the turtle takes one of this system for.

        Raises
        ------
        InputError
            When equivs go round in a circle.
        """
        seen = [symbol]
        scope = self
        while True:
            equiv = scope.equiv(seen[-1])
            if equiv is None:
                return seen[-1]
            if equiv.command in seen:
                raise InputError(scope.system.complaint_place(equiv.at), "equivs that lead to a symbol",
                                 f"a circle: {' '.join([*seen, equiv.command])}")  # fmt: skip
            seen.append(equiv.command)
            scope = scope.owner(equiv.command)

    def slots(self, development: Development) -> dict[str, int]:
        """Give the place of each parameter that a development function of this system names.

        Names that are all those of the parameters in the symbol's first production mean them; any others mean the
        parameters in order, and then all must be there.

        Raises
        ------
        InputError
            When they are neither.
        """
        named = [name for name in development.names if name not in RESERVED]
        productions = self.productions(development.symbol)
        if not productions:
            return {name: place for place, name in enumerate(named)}
        formals = productions[0].predecessor.parameters
        if all(name in formals for name in named):
            return {name: formals.index(name) for name in named}
        moved = any(name in formals and formals.index(name) != place for place, name in enumerate(named))
        if moved or len(named) != len(formals):
            expected = f"the parameters of {development.symbol}: {', '.join(formals) or 'none'}, age or end"
            place = self.system.complaint_place(development.at)
            raise InputError(place, expected, ", ".join(named), "name them as its production does")
        return {name: place for place, name in enumerate(named)}
