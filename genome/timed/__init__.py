"""The genotype of timed forms: McCormack's timed, parametric L-systems, their files and their encoding.

A system is a value: an axiom and productions over modules with parameters and ages, development functions, defines, and
systems inside systems. Expressions are trees, parsed with the precedence of C and never evaluated by Python.
"""

from genome.timed.checks import check_system
from genome.timed.encoding import decode, encode
from genome.timed.expression import (
    Binary,
    Call,
    Expression,
    Name,
    Number,
    Unary,
    format_expression,
)
from genome.timed.reading import parse_expression
from genome.timed.scope import Scope
from genome.timed.system import (
    Birth,
    Define,
    Development,
    Equiv,
    Formal,
    Module,
    Production,
    Section,
    Sheet,
    TimedSystem,
)
from genome.timed.text import format_tl, parse_tl

__all__ = [
    "Binary",
    "Birth",
    "Call",
    "Define",
    "Development",
    "Equiv",
    "Expression",
    "Formal",
    "Module",
    "Name",
    "Number",
    "Production",
    "Scope",
    "Section",
    "Sheet",
    "TimedSystem",
    "Unary",
    "check_system",
    "decode",
    "encode",
    "format_expression",
    "format_tl",
    "parse_expression",
    "parse_tl",
]
