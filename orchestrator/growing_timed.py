"""Growing one timed system to a time: its word, and what is told of it."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from genome.errors import InputError
from genome.settings import describe, near, validated
from orchestrator.checking import read_text
from orchestrator.growing import Request, check_output
from orchestrator.overrides import parse_override

if TYPE_CHECKING:
    from genome.timed import TimedSystem
    from growth.timed import TimedGrowth, Word

FORMS: Final[tuple[str, ...]] = ()
"""What ``-o`` can write; none until the turtle draws words."""


def grow_timed(request: Request) -> dict[str, Any] | str:
    """Derive a timed system's word at a time.

    Raises
    ------
    InputError
        When the rules, the time or a setting is not right.
    """
    from genome.timed import parse_tl
    from growth.protocol import Failure
    from growth.timed import compile_system, derive
    from growth.timed.turtle import unknown_symbols

    until = _time(request)
    system, growth = _settings(request, parse_tl(read_text(request.file, "a rule file"), str(request.file)))
    compile_system(system)  # what is wrong in the file is bad input, and not a growth that failed
    word = derive(system, until, request.seed or 0, growth, time.thread_time)
    if isinstance(word, Failure):
        return f"{request.file} did not grow: {word}"
    told: dict[str, Any] = {"modules": len(word), "time": until, **_form(request, word)}
    if ignored := unknown_symbols(system):
        told["ignored"] = list(ignored)
    if request.word:
        told["word"] = [[module.symbol, list(module.parameters), module.age] for module in word.modules()]
    return told


def _time(request: Request) -> float:
    for flag, given, remedy in (
        ("--steps", request.steps is not None, "use --time"),
        ("--environment", request.environment is not None, ""),
        ("--forces", request.forces, ""),
    ):
        if given:
            raise InputError(flag, "a form that takes it", f"{request.file}, a timed system", remedy)
    if request.output is not None and not FORMS:
        remedy = "--word --json gives its modules"
        raise InputError("-o", "a form that can be written", f"{request.file}, a timed system", remedy)
    check_output(request.output, FORMS)
    if request.until is None:
        raise InputError("--time", "the time to grow to", "none", "for example --time 1.5")
    if not 0.0 <= request.until < float("inf"):
        raise InputError("--time", "a time of 0 or more", str(request.until))
    return request.until


def _settings(request: Request, system: TimedSystem) -> tuple[TimedSystem, TimedGrowth]:
    """Read ``--set``: keys of the budget, and of the file's defines under ``define.``."""
    from growth.timed import TimedGrowth

    budget: dict[str, Any] = {}
    for text in request.overrides:
        path, value = parse_override(text)
        if len(path) == 2 and path[0] == "define":
            system = _defined(system, path[1], value, f"--set {text}")
        elif len(path) == 1:
            budget[path[0]] = value
        else:
            remedy = "for example --set max_modules=5000, --set define.KL=180"
            raise InputError(f"--set {text}", "key=value or define.NAME=value", describe(text), remedy)
    return system, validated(TimedGrowth, budget, "--set")


def _defined(system: TimedSystem, name: str, value: object, where: str) -> TimedSystem:
    """Give a define another value."""
    from genome.timed import parse_expression

    names = [define.name for define in system.defines]
    if name not in names:
        raise InputError(where, "the name of a define in the file", describe(name), near(name, names) if names else "")
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(where, "a number", describe(value))
    defines = list(system.defines)
    place = names.index(name)
    defines[place] = replace(defines[place], value=parse_expression(repr(float(value)), where))
    return replace(system, defines=tuple(defines))


def _form(request: Request, word: Word) -> dict[str, Any]:
    """Tell of the form that a word is, and write it where that is asked for: bounds, and the file's name."""
    del request, word  # the turtle's part
    return {}
