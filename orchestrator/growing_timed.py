"""Growing one timed system to a time: its word, and what is told of it."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
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
    from growth.timed.drawing import Drawing
    from growth.timed.turtle import TurtleSettings

MOST: Final = 5000
"""Times of an animation."""

EXAMPLES: Final = "for example --time 1.5, --time 0:4:0.04"


def grow_timed(request: Request) -> dict[str, Any] | str:
    """Derive a timed system's word at a time, or at several, draw it, and write the form if asked.

    Raises
    ------
    InputError
        When the rules, a time or a setting is not right, or nothing is drawn that could be written.
    """
    from genome.timed import parse_tl
    from growth.protocol import Failure
    from growth.timed import begin, compile_system
    from growth.timed.animation import write_drawings
    from growth.timed.turtle import draw, unknown_symbols

    times = _times(request)
    system = parse_tl(read_text(request.file, "a rule file"), str(request.file))
    system, growth, turtle = _settings(request, system)
    compile_system(system)  # what is wrong in the file is bad input, and not a growth that failed
    derivation = begin(system, request.seed or 0, growth)
    words: list[Word] = []
    drawings: list[Drawing] = []
    for until in times:
        derivation = derivation if isinstance(derivation, Failure) else derivation.at(until, time.thread_time)
        word = derivation if isinstance(derivation, Failure) else derivation.word()
        drawing = word if isinstance(word, Failure) else draw(word, turtle)
        if isinstance(word, Failure) or isinstance(drawing, Failure):
            return f"{request.file} did not grow: {drawing}"
        words.append(word)
        drawings.append(drawing)
    word = words[-1]
    told = _told(word, drawings)
    if ignored := unknown_symbols(system):
        told["ignored"] = list(ignored)
    if request.word:
        told["word"] = [[module.symbol, list(module.parameters), module.age] for module in word.modules()]
    if request.output is not None:
        files = write_drawings(drawings, request.output, request.file.name)
        told |= {"file": files[0]} if len(files) == 1 else {"files": files}
    return told


def _told(word: Word, drawings: Sequence[Drawing]) -> dict[str, Any]:
    """Tell of the last word, and of the room that all drawings take."""
    from growth.timed.pictures import bounds

    room = bounds(*drawings)
    return {
        "modules": len(word),
        "time": word.time,
        "frames": len(drawings),
        "parts": len(drawings[-1]),
        "bounds": None if room is None else room.tolist(),
    }


def _times(request: Request) -> list[float]:
    """Read the times, and refuse options that are not for timed systems."""
    from growth.timed.animation import FORMS

    for flag, given, remedy in (
        ("--steps", request.steps is not None, "use --time"),
        ("--environment", request.environment is not None, ""),
        ("--forces", request.forces, ""),
    ):
        if given:
            raise InputError(flag, "a form that takes it", f"{request.file}, a timed system", remedy)
    check_output(request.output, FORMS)
    if request.until is None:
        raise InputError("--time", "the time to grow to", "none", EXAMPLES)
    times = parse_times(request.until)
    if request.word and len(times) > 1:
        raise InputError("--word", "one time", f"--time {request.until}", "ask for the word at one of them")
    return times


def parse_times(text: str) -> list[float]:
    """Read ``T``, or ``FROM:TO:STEP``: from the first on in equal steps up to the last, both ends included.

    Raises
    ------
    InputError
        For anything else, times below 0, and more than :data:`MOST` of them.
    """
    expected = "a time of 0 or more, or FROM:TO:STEP"
    try:
        numbers = [float(part) for part in text.split(":")]
    except ValueError:
        raise InputError("--time", expected, f"'{text}'", EXAMPLES) from None
    if len(numbers) not in (1, 3) or not all(map(math.isfinite, numbers)) or numbers[0] < 0.0:
        raise InputError("--time", expected, f"'{text}'", EXAMPLES)
    if len(numbers) == 1:
        return numbers
    first, last, step = numbers
    if step <= 0.0 or last < first:
        raise InputError("--time", "FROM:TO:STEP that goes on, with a step above 0", f"'{text}'", EXAMPLES)
    steps = (last - first) / step + 1e-9
    if steps >= MOST:
        raise InputError("--time", f"at most {MOST} times", f"{steps:.6g}", "take a larger step")
    return [first + place * step for place in range(math.floor(steps) + 1)]


def _settings(request: Request, system: TimedSystem) -> tuple[TimedSystem, TimedGrowth, TurtleSettings]:
    """Read ``--set``: keys of the budget, of the turtle under ``turtle.``, of the file's defines under ``define.``."""
    from growth.timed import TimedGrowth
    from growth.timed.turtle import TurtleSettings

    budget: dict[str, Any] = {}
    turtle: dict[str, Any] = {}
    for text in request.overrides:
        path, value = parse_override(text)
        if len(path) == 2 and path[0] == "define":
            system = _defined(system, path[1], value, f"--set {text}")
        elif len(path) == 2 and path[0] == "turtle":
            turtle[path[1]] = value
        elif len(path) == 1:
            budget[path[0]] = value
        else:
            remedy = "for example --set max_modules=5000, --set define.KL=180, --set turtle.sides=24"
            raise InputError(f"--set {text}", "key=value, define.NAME=value, turtle.KEY=value", describe(text), remedy)
    growth = validated(TimedGrowth, budget, "--set")
    return system, growth, validated(TurtleSettings, turtle, "--set", ("turtle",))


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
