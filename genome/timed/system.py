"""Timed, parametric L-systems as values (McCormack, section 3.1).

A system has an axiom and productions whose modules carry parameters and an age. A production applies when a module
reaches its terminal age; the modules of its successor are born then, at their birth ages. Atoll adds what the paper
names as extensions: contexts, and systems inside systems.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple, final

from genome.timed.expression import NOWHERE, ONE, ZERO, Expression, Place

OPEN: Final = "["
CLOSE: Final = "]"
BRACKETS: Final = (OPEN, CLOSE)

MARKS: Final = "+-^&/\\[]!|${}~'"
"""Symbols that are no names. Those of the turtle are told in docs/formats/tl.md."""

AGE: Final = "age"
TERMINAL: Final = "end"
RESERVED: Final = (AGE, TERMINAL)
"""What development functions call the age and the terminal age of their module."""


class Module(NamedTuple):
    """A module of a word: a symbol, its parameters and its age."""

    symbol: str
    parameters: tuple[float, ...]
    age: float


@final
@dataclass(frozen=True, slots=True)
class Formal:
    """A module as productions look for it: a symbol and the names of its parameters."""

    symbol: str
    parameters: tuple[str, ...] = ()
    at: Place = field(default=NOWHERE, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class Birth:
    """A module that is born: a symbol, expressions for its parameters, and one for its birth age."""

    symbol: str
    arguments: tuple[Expression, ...] = ()
    age: Expression = ZERO
    at: Place = field(default=NOWHERE, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class Production:
    """What becomes of a module at its terminal age.

    Attributes
    ----------
    predecessor
        The module that it rewrites.
    end
        The terminal age, of the predecessor's parameters; equal in all productions of a symbol.
    successor
        What stands in its place from then on; may be empty.
    left, right
        The modules before and behind that it needs, or ``None``; see docs/formats/tl.md for what they are.
    condition
        Needs to be other than 0; ``None`` where nothing is asked.
    chance
        From 0 to 1; ``None`` takes what the productions before it have left.
    at
        Line and column in the file.
    """

    predecessor: Formal
    end: Expression = ONE
    successor: tuple[Birth, ...] = ()
    left: Formal | None = None
    right: Formal | None = None
    condition: Expression | None = None
    chance: Expression | None = None
    at: Place = field(default=NOWHERE, compare=False, repr=False)

    @property
    def formals(self) -> tuple[str, ...]:
        """The names that condition, chance and successor may use: of the predecessor, the left, and the right."""
        contexts = [context.parameters for context in (self.left, self.right) if context is not None]
        return self.predecessor.parameters + sum(contexts, ())


@final
@dataclass(frozen=True, slots=True)
class Development:
    """A development function: what the parameters of a symbol's modules are scaled by, at each age (section 3.3).

    Attributes
    ----------
    symbol
        Whose modules it scales.
    names
        Parameters of the symbol, and ``age`` and ``end`` where it depends on them; the order is that of calls.
    body
        Its expression. It may call other development functions, never in a circle.
    at
        Line and column in the file.
    """

    symbol: str
    names: tuple[str, ...]
    body: Expression
    at: Place = field(default=NOWHERE, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class Define:
    """A constant with a name; its expression may use those defined before it."""

    name: str
    value: Expression
    at: Place = field(default=NOWHERE, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class Equiv:
    """A symbol that the turtle takes for another: ``equiv f mov`` makes mov move as f does."""

    command: str
    symbol: str
    at: Place = field(default=NOWHERE, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class Section:
    """A cross-section of generalised cylinders (section 4.1).

    Attributes
    ----------
    symbol
        The module that chooses it.
    names
        One: the angle, from 0 to 2 pi, from the turtle's left to its up.
    radius
        The polar radius at each angle, as a multiple of the turtle's radius; over 0.
    at
        Line and column in the file.
    """

    symbol: str
    names: tuple[str, ...]
    radius: Expression
    at: Place = field(default=NOWHERE, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class Sheet:
    """A surface that the turtle can draw, and mix with others.

    Attributes
    ----------
    symbol
        The module that gives it weight.
    names
        Two, each from 0 to 1.
    place
        Three: where it is along the turtle's heading, left and up.
    at
        Line and column in the file.
    """

    symbol: str
    names: tuple[str, ...]
    place: tuple[Expression, ...]
    at: Place = field(default=NOWHERE, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class TimedSystem:
    """A timed, parametric L-system, or one inside another.

    Attributes
    ----------
    axiom
        The word at time 0; never empty.
    productions
        In the order written, in which they are asked.
    developments, defines, equivs, sections, surfaces
        In the order written.
    ignored
        Symbols that contexts look past; brackets are never contexts.
    systems
        Those inside it. A module with the name of one is, from its birth on, that system's word at the module's age.
    radians
        Whether turns are in radians, and not in degrees; of the outermost system alone.
    name, parameters
        Of a system inside another: the symbol that stands for it, and the names that its axiom may use.
    source
        The file's name, for messages.
    at
        Line and column of a system inside another.
    """

    axiom: tuple[Birth, ...]
    productions: tuple[Production, ...] = ()
    developments: tuple[Development, ...] = ()
    defines: tuple[Define, ...] = ()
    equivs: tuple[Equiv, ...] = ()
    ignored: tuple[str, ...] = ()
    systems: tuple[TimedSystem, ...] = ()
    radians: bool = False
    name: str = ""
    parameters: tuple[str, ...] = ()
    sections: tuple[Section, ...] = ()
    surfaces: tuple[Sheet, ...] = ()
    source: str = field(default="system", compare=False, repr=False)
    at: Place = field(default=NOWHERE, compare=False, repr=False)

    @property
    def figures(self) -> tuple[Section | Sheet, ...]:
        """The sections, then the surfaces."""
        return (*self.sections, *self.surfaces)

    def complaint_place(self, at: Place) -> str:
        """Give a place as messages have it; the file alone for what was not read from one."""
        return self.source if at == NOWHERE else f"{self.source}:{at[0]}:{at[1]}"
