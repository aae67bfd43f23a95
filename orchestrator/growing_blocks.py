"""Growing and measuring one block body: from a ``.blocks`` file, or given outright by a ``.body.json``."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from genome.errors import InputError
from genome.settings import describe, validated
from orchestrator.checking import read_text
from orchestrator.growing import Request, check_output
from orchestrator.overrides import parse_override

if TYPE_CHECKING:
    from evaluators.blocks import Structure
    from evaluators.blocks.load import Load, LoadSettings
    from growth.blocks import BlockGrowth, Body

FORMS: Final = (".glb", ".obj", ".stl", ".npz", ".png")
OF_THE_FILE: Final = ("lattice", "supports")
"""Settings that a body's file has, and the command line has not."""


def grow_blocks(request: Request) -> dict[str, Any] | str:
    """Grow a body from an L-system, load it, measure it by the criteria of block bodies, and write it if asked.

    Raises
    ------
    InputError
        When the rules or a setting is not right.
    """
    from dataclasses import replace

    from genome.lsystem import parse_blocks
    from growth.blocks import grow
    from growth.protocol import Failure

    growth, load = _settings(request)
    system = parse_blocks(read_text(request.file, "a rule file"), str(request.file))
    if request.steps is not None:
        system = replace(system, iterations=_iterations(request.steps))
    body = grow(system, growth, time.thread_time, request.seed)
    if isinstance(body, Failure):
        return f"{request.file} did not grow: {body}"
    return _measured(request, body, growth, load)


def measure_body(request: Request) -> dict[str, Any] | str:
    """Load and measure a body that a file gives cell by cell, and write it if asked.

    Raises
    ------
    InputError
        When the file or a setting is not right, or an option makes no sense without growth.
    """
    from growth.blocks import read_given

    if request.steps is not None:
        raise InputError("--steps", "rules to grow from", f"{request.file}, a body as it is")
    growth, load = _settings(request)
    for key in OF_THE_FILE:
        if key in growth.model_fields_set:
            raise InputError(f"--set {key}", "a setting that the body's file leaves open", f"'{key}'", "write it there")
    return _measured(request, *read_given(request.file, growth), load)


def _settings(request: Request) -> tuple[BlockGrowth, LoadSettings]:
    """Read ``--set``: keys of growth, and of the load under ``load.``."""
    from evaluators.blocks.load import LoadSettings
    from growth.blocks import BlockGrowth

    if request.until is not None:
        raise InputError("--time", "a timed system (.tl)", str(request.file), "use --steps")
    if request.environment is not None:
        remedy = "block bodies have a ground: --set ground=fixed, or supports"
        raise InputError("--environment", "a form that grows in one (.hemls)", str(request.file), remedy)
    if request.word:
        raise InputError("--word", "a timed system (.tl)", str(request.file))
    check_output(request.output, FORMS)
    sections: tuple[dict[str, Any], dict[str, Any]] = {}, {}
    for text in request.overrides:
        path, value = parse_override(text)
        of_load = len(path) == 2 and path[0] == "load"
        if len(path) != 1 and not of_load:
            remedy = "for example --set envelope=true, --set load.axial_strength=20"
            raise InputError(f"--set {text}", "key=value or load.key=value", describe(text), remedy)
        sections[of_load][path[-1]] = value
    return validated(BlockGrowth, sections[0], "--set"), validated(LoadSettings, sections[1], "--set", ("load",))


def _iterations(steps: int) -> int:
    from genome.lsystem.system import MOST_ITERATIONS

    if not 0 <= steps <= MOST_ITERATIONS:
        raise InputError("--steps", f"a number of iterations from 0 to {MOST_ITERATIONS}", str(steps))
    return steps


def _measured(request: Request, body: Body, growth: BlockGrowth, settings: LoadSettings) -> dict[str, Any] | str:
    from evaluators.blocks import BLOCK_CRITERIA, Structure, score
    from evaluators.blocks.load import grown_under_load, loaded_throughout
    from growth.protocol import Failure

    load = grown_under_load(body, growth, settings)
    failure = ""
    if isinstance(load, Failure):
        failure, load = str(load), loaded_throughout(body, growth, settings)
    structure = Structure(body, load)
    scores = score(structure, BLOCK_CRITERIA)
    if isinstance(scores, Failure):
        return f"{request.file} could not be measured: {scores}"
    told = {**_counts(structure), **_told(load, failure), **scores, "span": max(scores["span_x"], scores["span_y"])}
    if request.forces:
        told["forces"] = _forces(structure)
    if request.output is not None:
        _write(body, load if request.forces else None, request.output)
        told["file"] = str(request.output)
    return told


def _counts(structure: Structure) -> dict[str, Any]:
    body = structure.body
    low, high = body.cells.min(axis=0).tolist(), body.cells.max(axis=0).tolist()
    return {
        "internal": len(body.internal),
        "envelope": len(body.envelope),
        "boundary": len(body.boundary),
        "lattice": body.lattice.name,
        "bounds": [low, high],
    }


def _told(load: Load, failure: str) -> dict[str, Any]:
    """Tell what the load analysis found; ``failure`` says why a body does not stand at some stage of its growth."""
    told: dict[str, Any] = {
        "stable": load.stable and not failure,
        "max_translational": float(load.translational.max(initial=0.0)),
        "max_torsional": float(load.torsional.max(initial=0.0)),
        "joints": len(load.joints),
        "failed": len(load.failed),
        "floating": len(load.floating),
        "residual": load.residual,
    }
    if load.factor is not None:
        told["factor"] = load.factor if math.isfinite(load.factor) else None  # nothing bounds it
    if failure:
        told["failure"] = failure
    return told


def _forces(structure: Structure) -> list[dict[str, Any]]:
    """List the joints: the two cells, the lower layer first, and what the joint carries."""
    load, cells = structure.load, structure.body.cells
    return [
        {
            "cells": cells[load.joints[at]].tolist(),
            "force": load.forces[at].tolist(),
            "moment": load.moments[at].tolist(),
            "translational": float(load.translational[at]),
            "torsional": float(load.torsional[at]),
        }
        for at in range(len(load.joints))
    ]


def _write(body: Body, load: Load | None, output: Path) -> None:
    """Write a body, coloured by its forces where a load is given."""
    forces = None if load is None else load.by_cell(body)
    if output.suffix.lower() == ".png":
        from growth.blocks.pictures import body_picture
        from growth.pictures import write_png

        write_png(body_picture(body, forces), output)
    else:
        from growth.blocks.forms import write_form

        write_form(body, output, output.stem, {}, forces)
