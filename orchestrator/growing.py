"""Growing one form from a rule file: an engine for each suffix. A new engine is one function and one line."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from genome.errors import InputError
from genome.settings import describe, validated
from growth.surface import Surface
from orchestrator.checking import read_text
from orchestrator.overrides import parse_override

FORMS: Final = (".glb", ".obj", ".ply", ".stl", ".png")


@dataclass(frozen=True, slots=True)
class Request:
    """What ``atoll grow`` was asked for."""

    file: Path
    steps: int | None
    until: str | None
    environment: Path | None
    overrides: Sequence[str]
    seed: int | None
    output: Path | None
    forces: bool = False
    word: bool = False


Engine = Callable[[Request], "dict[str, Any] | str"]
"""Gives the keys of the JSON, or the message of a growth that failed."""


def engine_for(path: Path) -> Engine:
    """Give the engine that grows a file.

    Raises
    ------
    InputError
        When its suffix belongs to none that is built.
    """
    for suffix, engine in ENGINES.items():
        if path.name.endswith(suffix):
            return engine
    raise InputError(str(path), f"a rule file ({', '.join(ENGINES)})", f"'{path.suffix or path.name}'")


def grow_surface(request: Request) -> dict[str, Any] | str:
    """Grow a HEMLS surface, measure it by Genr8's criteria, and write it if asked.

    Raises
    ------
    InputError
        When the rules, the environment or a setting is not right.
    """
    from evaluators.registry import CRITERIA
    from evaluators.score import score
    from growth.environment import Environment, load_environment
    from growth.hemls import SurfaceGrowth, grow, parse_system
    from growth.protocol import Failure

    if request.until is not None:
        raise InputError("--time", "a timed system (.tl)", str(request.file), "use --steps")
    if request.forces:
        raise InputError("--forces", "a block body (.blocks, .body.json)", str(request.file))
    if request.word:
        raise InputError("--word", "a timed system (.tl)", str(request.file))
    settings = validated(SurfaceGrowth, _settings(request), "--set")
    check_output(request.output, FORMS)
    system = parse_system(read_text(request.file, "a rule file"), str(request.file))
    environment = Environment.empty() if request.environment is None else load_environment(request.environment)
    surface = grow(system, settings, environment, time.thread_time)
    if isinstance(surface, Failure):
        return f"{request.file} did not grow: {surface}"
    scores = score(surface, environment, CRITERIA)
    if isinstance(scores, Failure):
        return f"{request.file} could not be measured: {scores}"
    vertices, edges, faces = surface.counts
    bounds = [surface.vertices.min(axis=0).tolist(), surface.vertices.max(axis=0).tolist()]
    if request.output is not None:
        _write(surface, environment, request.output)
    grown = {"vertices": vertices, "edges": edges, "faces": faces, **scores, "bounds": bounds}
    return grown if request.output is None else {**grown, "file": str(request.output)}


def _settings(request: Request) -> dict[str, Any]:
    given: dict[str, Any] = {}
    for text in request.overrides:
        path, value = parse_override(text)
        if len(path) != 1:
            raise InputError(f"--set {text}", "key=value", describe(text), "for example --set scale=1.5")
        given[path[0]] = value
    if request.steps is not None:
        if request.steps < 0:
            raise InputError("--steps", "a number of derivation steps, 0 or more", str(request.steps))
        given["steps"] = request.steps
    return given


def check_output(output: Path | None, forms: Sequence[str]) -> None:
    """Refuse a file that cannot be written, before anything is grown.

    Raises
    ------
    InputError
        When its suffix is none of ``forms``, or its folder is not there.
    """
    if output is None:
        return
    if output.suffix.lower() not in forms:
        raise InputError("-o", f"a file that ends in {', '.join(forms)}", f"'{output}'")
    if not output.parent.is_dir():
        raise InputError("-o", "a file in a folder that exists", f"'{output}'")


def _write(surface: Surface, environment: Any, output: Path) -> None:  # noqa: ANN401 - imported where it is used
    if output.suffix.lower() == ".png":
        from growth.pictures import render, write_png

        write_png(render(surface, environment), output)
    else:
        from growth.forms import write_form

        write_form(surface, output)


def _blocks(request: Request) -> dict[str, Any] | str:
    from orchestrator.growing_blocks import grow_blocks

    return grow_blocks(request)


def _timed(request: Request) -> dict[str, Any] | str:
    from orchestrator.growing_timed import grow_timed

    return grow_timed(request)


def _body(request: Request) -> dict[str, Any] | str:
    from orchestrator.growing_blocks import measure_body

    return measure_body(request)


def _plan(request: Request) -> dict[str, Any] | str:
    from orchestrator.growing_plans import grow_plan

    return grow_plan(request)


ENGINES: Final[dict[str, Engine]] = {
    ".hemls": grow_surface,
    ".blocks": _blocks,
    ".tl": _timed,
    ".body.json": _body,
    ".plan": _plan,
}
"""The engines by the suffix of the files that they grow."""
