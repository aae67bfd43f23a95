"""The arrays that the kernels of timed growth read and write, and the codes in them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

PUSH: Final = 0
LOAD: Final = 1
STORE: Final = 2
JUMP: Final = 3
JUMP_IF_NOT: Final = 4
NEG: Final = 5
NOT: Final = 6
TRUTH: Final = 7
SIN: Final = 8
COS: Final = 9
TAN: Final = 10
ASIN: Final = 11
ACOS: Final = 12
ATAN: Final = 13
SQRT: Final = 14
EXP: Final = 15
LOG: Final = 16
ABS: Final = 17
SIGN: Final = 18
FLOOR: Final = 19
CEIL: Final = 20
ADD: Final = 21
SUB: Final = 22
MUL: Final = 23
DIV: Final = 24
MOD: Final = 25
POW: Final = 26
EQ: Final = 27
NE: Final = 28
LT: Final = 29
GT: Final = 30
LE: Final = 31
GE: Final = 32
MIN: Final = 33
MAX: Final = 34
ROOT: Final = 35
BESSELJ: Final = 36
RANDOM: Final = 37
NORMAL: Final = 38
"""Instructions of the stack machine: those from NEG on take one value, those from ADD on two."""

UNARY_CODES: Final[Mapping[str, int]] = {"-": NEG, "!": NOT}
BINARY_CODES: Final[Mapping[str, int]] = {
    "+": ADD, "-": SUB, "*": MUL, "/": DIV, "%": MOD, "^": POW,
    "==": EQ, "!=": NE, "<": LT, ">": GT, "<=": LE, ">=": GE,
}  # fmt: skip
FUNCTION_CODES: Final[Mapping[str, int]] = {
    "sin": SIN, "cos": COS, "tan": TAN, "asin": ASIN, "acos": ACOS, "atan": ATAN, "sqrt": SQRT, "exp": EXP, "log": LOG,
    "abs": ABS, "sign": SIGN, "floor": FLOOR, "ceil": CEIL, "min": MIN, "max": MAX, "root": ROOT, "besselj": BESSELJ,
    "random": RANDOM, "normal": NORMAL,
}  # fmt: skip

NONE: Final = -1
"""No expression, no context, no production."""

OPEN_CODE: Final = 0
CLOSE_CODE: Final = 1
START_CODE: Final = 2
"""Codes of the brackets, and of what the axiom comes from."""

DIVISION: Final = 1
ROOT_DOMAIN: Final = 2
LOG_DOMAIN: Final = 3
ARC_DOMAIN: Final = 4
POWER_DOMAIN: Final = 5
NOT_FINITE: Final = 6
BESSEL_DOMAIN: Final = 7
SPREAD: Final = 8
NEGATIVE_AGE: Final = 9
NO_CHANCE: Final = 10
EVENTS: Final = 11
MODULES: Final = 12
FULL: Final = 13
CHILD: Final = 14
TROUBLES: Final[Mapping[int, str]] = {
    DIVISION: "division by zero",
    ROOT_DOMAIN: "domain error: a root of a negative number",
    LOG_DOMAIN: "domain error: a logarithm of a number that is not positive",
    ARC_DOMAIN: "domain error: asin or acos of a number outside of -1 to 1",
    POWER_DOMAIN: "domain error: a power of a negative number to an exponent that is not whole",
    NOT_FINITE: "overflow: a value that is not finite",
    BESSEL_DOMAIN: "domain error: besselj of an order that is not whole, or of a number over 100000",
    SPREAD: "domain error: normal() with a negative spread",
    NEGATIVE_AGE: "a negative age",
    NO_CHANCE: "a chance outside of 0 to 1",
}
"""What can go wrong in an expression, or with its value."""

IN_CONDITION: Final = 0
IN_CHANCE: Final = 1
IN_PARAMETER: Final = 2
IN_BIRTH_AGE: Final = 3
IN_END: Final = 4
IN_DEVELOPMENT: Final = 5
ROLES: Final = (
    "a condition",
    "a chance",
    "a parameter",
    "the birth age",
    "the terminal age",
    "the development function",
)
"""What the expression was for."""


CODE: Final = 0
ASKS: Final = 1
KEY: Final = 2
START: Final = 3
STOP: Final = 4
COLUMNS: Final = 5
"""Columns of modules: the code, how often productions were asked in vain, the lineage, where the parameters stand."""

FIRST_CHILD: Final = 5
NEXT_CHILD: Final = 6
LAST_CHILD: Final = 7
PILE_COLUMNS: Final = 8
"""Further columns of modules that are being rewritten: where their births begin, go on and end."""

ORIGIN: Final = 0
DIES: Final = 1
"""Columns of the times of modules."""

FIRST_RULE: Final = 0
LAST_RULE: Final = 1
END: Final = 2
GROWTH: Final = 3
CALLS: Final = 4
AGAIN: Final = 5
IGNORED: Final = 6
PLAIN: Final = 7
"""Columns of symbols."""

CONDITION: Final = 0
CHANCE: Final = 1
LEFT: Final = 2
RIGHT: Final = 3
FIRST_BIRTH: Final = 4
LAST_BIRTH: Final = 5
"""Columns of productions."""

BORN: Final = 0
FIRST_ARGUMENT: Final = 1
LAST_ARGUMENT: Final = 2
BIRTH_AGE: Final = 3
SETTLED: Final = 4
"""Columns of births."""


AT: Final = 0
HEIGHT: Final = 1
COUNT: Final = 2
HELD: Final = 3
TALLY: Final = 4
ROLE: Final = 5
MARKS: Final = 6
"""How far a rewriting is: modules of the word, on the pile, put, their parameters, events; of what trouble is."""


class Tables(NamedTuple):
    """A timed system as arrays; s codes, p productions, b births, e expressions.

    Attributes
    ----------
    ops, args
        (n,) int64 and float64, the instructions of all expressions and their constants, slots and targets.
    spans
        (e, 2) int64, where each expression begins and ends.
    known
        (e,) float64, the values of those that are constant; NaN of the others.
    loads
        (e,) int64, the slots of those that are a parameter and nothing else; NONE of the others.
    symbols
        (s, 8) int64. Of each code where its productions begin and end; its terminal age, an expression of its
        parameters, NONE where it never dies; its development function or NONE, with the slots age, terminal age,
        parameters; whether it stands for a system, and so dies at the instant at which its age was 0; whether it may
        match later though nothing matched before, since contexts or chance decide; whether it is no context; whether
        it has one production that asks for nothing.
    rules
        (p, 6) int64. Of each production condition and chance, expressions or NONE, with the slots parameters of the
        predecessor, the left and the right; the codes of left and right, or NONE; where its births begin and end.
    births
        (b, 5) int64. Of each birth its code, where the expressions of its parameters begin and end, its birth age, and
        whether it can be put without computing: parameters that are constants or parameters, constant ages.
    room
        Slots and stack places that an evaluation needs at most.
    most_values
        The most parameters of a successor.
    """

    ops: Ints
    args: Floats
    spans: Ints
    known: Floats
    loads: Ints
    symbols: Ints
    rules: Ints
    births: Ints
    room: int
    most_values: int


class Modules(NamedTuple):
    """Modules in a row; m of them with v parameters in all.

    Attributes
    ----------
    whole
        (m, 5) int64: codes; how often their productions have been asked in vain; their lineage, of which what they draw
        at random is a function; where their parameters begin and end.
    reals
        (m, 2) float64: the instants at which their ages were 0, before time 0 where a birth age has it so; and those at
        which their productions are asked next, infinite where never.
    values
        (v,) float64, the parameters, not developed.
    """

    whole: Ints
    reals: Floats
    values: Floats
