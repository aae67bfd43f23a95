"""The arrays that the kernels of timed growth read and write, and the codes in them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]
Keys = NDArray[np.uint64]
Flags = NDArray[np.bool_]

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
ROLES: Final = ("a condition", "a chance", "a parameter", "the birth age", "the terminal age", "the development function")
"""What the expression was for."""


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
    room
        Slots and stack places that an evaluation needs at most.
    productions
        (s + 1,) int64, where the productions of each code begin.
    conditions, chances
        (p,) int64, expressions or NONE. Slots: parameters of predecessor, left and right, in this order.
    lefts, rights
        (p,) int64, codes of contexts or NONE.
    births
        (p, 2) int64, where each production's births begin and end.
    codes, arguments, ages
        (b,), (b, 2) and (b,) int64, code, range of expressions and birth age of each birth.
    ends
        (s,) int64, the terminal age of each code, an expression of its parameters; NONE of those that never die.
    growths
        (s,) int64, the development function or NONE. Slots: age, terminal age, parameters.
    calls
        (s,) bool, the codes that stand for a system: they die at the instant at which their age was 0.
    again
        (s,) bool, the codes that may match later though nothing matched before: contexts or chance decide.
    ignored
        (s,) bool, the codes that are no contexts.
    """

    ops: Ints
    args: Floats
    spans: Ints
    known: Floats
    room: int
    productions: Ints
    conditions: Ints
    chances: Ints
    lefts: Ints
    rights: Ints
    births: Ints
    codes: Ints
    arguments: Ints
    ages: Ints
    ends: Ints
    growths: Ints
    calls: Flags
    again: Flags
    ignored: Flags


class Modules(NamedTuple):
    """Modules in a row; m of them with v parameters in all. The arrays may be longer than that while they fill.

    Attributes
    ----------
    codes
        (m,) int64.
    starts
        (m + 1,) int64, where the parameters of each begin.
    values
        (v,) float64, the parameters, not developed.
    origins
        (m,) float64, the instants at which their ages were 0; before time 0 where a birth age has it so.
    dies
        (m,) float64, the instants at which their productions are asked next; infinite where never.
    keys
        (m,) uint64, their lineage: what they draw at random is a function of it.
    asks
        (m,) int64, how often their productions have been asked in vain.
    """

    codes: Ints
    starts: Ints
    values: Floats
    origins: Floats
    dies: Floats
    keys: Keys
    asks: Ints
