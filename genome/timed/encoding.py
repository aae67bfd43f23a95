"""The encoding of timed systems in logs, checkpoints and migrants: JSON, statements as texts."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any, Final, TypeVar

from genome.errors import InputError
from genome.settings import describe, near
from genome.timed.checks import check_system
from genome.timed.reading import Reader
from genome.timed.statements import (
    read_birth_word,
    read_define,
    read_development,
    read_equiv,
    read_formals,
    read_ignored,
    read_production,
    read_section,
    read_surface,
)
from genome.timed.system import TimedSystem
from genome.timed.text import MOST_INSIDE
from genome.timed.tokens import lines
from genome.timed.writing import (
    written_define,
    written_development,
    written_equiv,
    written_formals,
    written_production,
    written_section,
    written_surface,
    written_word,
)

FORMAT: Final = 1
"""The version of this encoding."""

_KEYS: Final = ("name", "parameters", "radians", "defines", "equivs", "ignored", "axiom", "productions", "developments",
                "systems", "sections", "surfaces")  # fmt: skip

T = TypeVar("T")


def encode(system: TimedSystem) -> str:
    """Write a system as a JSON object without blanks; equal systems give equal texts.

    Statements stand there as a file has them, without their first word; keys whose value is the default are left out.
    """
    return json.dumps({"format": FORMAT, **_plain(system)}, separators=(",", ":"), ensure_ascii=False)


def decode(text: str) -> TimedSystem:
    """Read what :func:`encode` wrote.

    Raises
    ------
    InputError
        For anything else, and for a system that does not fit together.
    """
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        raise InputError("genotype", "a timed system as JSON", describe(text)) from None
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise InputError("genotype", f"a JSON object of format {FORMAT}", describe(data))
    system = _system({key: value for key, value in data.items() if key != "format"}, "genotype", 0)
    check_system(system)
    return system


def _plain(system: TimedSystem) -> dict[str, Any]:
    data: dict[str, Any] = {}
    if system.name:
        data["name"] = system.name
    if system.parameters:
        data["parameters"] = written_formals(system.parameters)
    if system.radians:
        data["radians"] = True
    groups: dict[str, list[Any]] = {
        "defines": [written_define(one).removeprefix("#define ") for one in system.defines],
        "equivs": [written_equiv(one).removeprefix("equiv ") for one in system.equivs],
        "productions": [written_production(one) for one in system.productions],
        "developments": [written_development(one).removeprefix("g ") for one in system.developments],
        "systems": [_plain(one) for one in system.systems],
        "sections": [written_section(one).removeprefix("section ") for one in system.sections],
        "surfaces": [written_surface(one).removeprefix("surface ") for one in system.surfaces],
    }
    if system.ignored:
        data["ignored"] = " ".join(system.ignored)
    data["axiom"] = written_word(system.axiom)
    return {**data, **{key: value for key, value in groups.items() if value}}


def _system(data: object, where: str, depth: int) -> TimedSystem:
    if not isinstance(data, dict):
        raise InputError(where, "a JSON object", describe(data))
    for key in data:
        if key not in _KEYS:
            raise InputError(f"{where}: {key}", "a known key", describe(key), near(str(key), list(_KEYS)))
    if depth > MOST_INSIDE:
        raise InputError(where, f"systems at most {MOST_INSIDE} deep inside each other", "more")
    name, radians = data.get("name", ""), data.get("radians", False)
    if not isinstance(name, str) or (depth > 0) != name.isidentifier() or not isinstance(radians, bool):
        raise InputError(where, "a name of every system inside another, and radians as true or false", describe(name))
    inner = data.get("systems", [])
    if not isinstance(inner, list):
        raise InputError(f"{where}: systems", "a list", describe(inner))
    return TimedSystem(
        axiom=_line(data.get("axiom"), f"{where}: axiom", read_birth_word),
        productions=_lines(data, "productions", where, read_production),
        developments=_lines(data, "developments", where, read_development),
        defines=_lines(data, "defines", where, read_define),
        equivs=_lines(data, "equivs", where, read_equiv),
        ignored=_line(data["ignored"], f"{where}: ignored", read_ignored) if "ignored" in data else (),
        systems=tuple(_system(one, f"{where}: systems", depth + 1) for one in inner),
        sections=_lines(data, "sections", where, read_section),
        surfaces=_lines(data, "surfaces", where, read_surface),
        radians=radians,
        name=name,
        parameters=_line(data["parameters"], f"{where}: parameters", read_formals) if "parameters" in data else (),
        source=where,
    )


def _lines(data: dict[str, Any], key: str, where: str, reads: Callable[[Reader], T]) -> tuple[T, ...]:
    texts = data.get(key, [])
    if not isinstance(texts, list):
        raise InputError(f"{where}: {key}", "a list of texts", describe(texts))
    return tuple(_line(text, f"{where}: {key}.{place}", reads) for place, text in enumerate(texts))


def _line(text: object, where: str, reads: Callable[[Reader], T]) -> T:
    rows = list(lines(text, where)) if isinstance(text, str) else []
    if len(rows) != 1:
        raise InputError(where, "one statement as text", describe(text))
    reader = Reader(rows[0], where)
    found = reads(reader)
    if reader.next.kind != "end":
        raise reader.error("the end of the text")
    return found
