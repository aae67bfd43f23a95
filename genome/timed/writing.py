"""Writing timed systems, a statement a line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from genome.timed.expression import ONE, ZERO, Call, Expression, Name, Number, format_expression
from genome.timed.system import (
    BRACKETS,
    Birth,
    Define,
    Development,
    Equiv,
    Formal,
    Production,
    Section,
    Sheet,
    TimedSystem,
)


def written(system: TimedSystem) -> Iterator[str]:
    """Give the lines of a system."""
    if system.radians:
        yield "angles radians"
    yield from map(written_define, system.defines)
    yield from map(written_equiv, system.equivs)
    yield from map(written_section, system.sections)
    yield from map(written_surface, system.surfaces)
    if system.ignored:
        yield f"ignore {' '.join(system.ignored)}"
    yield f"axiom {written_word(system.axiom)}"
    yield from map(written_production, system.productions)
    yield from map(written_development, system.developments)
    for inner in system.systems:
        yield f"system {inner.name}{written_formals(inner.parameters)}"
        for line in written(inner):
            yield f"  {line}"
        yield "end"


def written_define(define: Define) -> str:
    """Write a define."""
    return f"#define {define.name} {format_expression(define.value)}"


def written_equiv(equiv: Equiv) -> str:
    """Write an equiv."""
    return f"equiv {equiv.command} {equiv.symbol}"


def written_development(development: Development) -> str:
    """Write a development function."""
    head = f"{development.symbol}{written_formals(development.names)}"
    return f"g {head} = {format_expression(development.body)}"


def written_section(section: Section) -> str:
    """Write a cross-section."""
    return f"section {section.symbol}{written_formals(section.names)} = {format_expression(section.radius)}"


def written_surface(sheet: Sheet) -> str:
    """Write a surface."""
    place = ", ".join(map(format_expression, sheet.place))
    return f"surface {sheet.symbol}{written_formals(sheet.names)} = {place}"


def written_production(production: Production) -> str:
    """Write a production."""
    head = _written_formal(production.predecessor)
    if production.left is not None:
        head = f"{_written_formal(production.left)} < {head}"
    if production.right is not None:
        head = f"{head} > {_written_formal(production.right)}"
    if production.end != ONE:
        head = f"{head} @ {format_expression(production.end)}"
    if production.condition is not None:
        head = f"{head} : {format_expression(production.condition)}"
    chance = "" if production.chance is None else f" : {format_expression(production.chance)}"
    return f"{head} -> {written_word(production.successor)}{chance}"


def written_word(word: Sequence[Birth]) -> str:
    """Write a word of modules that are born."""
    return " ".join(map(_written_birth, word))


def written_formals(names: Sequence[str]) -> str:
    """Write names in parentheses, or nothing where there are none."""
    return f"({', '.join(names)})" if names else ""


def _written_birth(birth: Birth) -> str:
    if birth.symbol in BRACKETS:
        return birth.symbol
    arguments = f"({', '.join(map(format_expression, birth.arguments))})" if birth.arguments else ""
    age = "" if birth.age == ZERO else f" @ {_written_age(birth.age)}"
    return f"{birth.symbol}{arguments}{age}"


def _written_age(age: Expression) -> str:
    """Write a birth age; whatever has an operator in parentheses, since symbols may follow."""
    text = format_expression(age)
    return text if isinstance(age, (Number, Name, Call)) else f"({text})"


def _written_formal(formal: Formal) -> str:
    return f"{formal.symbol}{written_formals(formal.parameters)}"
