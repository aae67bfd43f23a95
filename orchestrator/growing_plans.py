"""Growing one room or plan from a ``.plan`` file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from genome.errors import InputError
from orchestrator.growing import Request, check_output

if TYPE_CHECKING:
    from evaluators.plans import Layout
    from genome.polyform import Assembly, Room
    from growth.polyforms import Plan
    from growth.protocol import Failure

FORMS: Final = (".svg", ".dxf", ".ifc", ".glb", ".png", ".json")


def grow_plan(request: Request) -> dict[str, Any] | str:
    """Grow a room or a plan, measure it, and write it if asked.

    Returns
    -------
    dict or str
        ``cells`` (their number), ``area`` (square metres), ``perimeter`` and ``corners`` of the whole, ``rooms`` (of
        each its name, cells, area, perimeter and corners), ``doors`` (pairs of rooms), and the criteria of rooms, or of
        plans.

    Raises
    ------
    InputError
        When the file is not right, or an option makes no sense for a plan.
    """
    from evaluators.plans import laid_out
    from growth.polyforms import form_of
    from growth.protocol import Failure
    from orchestrator.plan_file import genotype_of, read_plan

    _refuse(request)
    check_output(request.output, FORMS)
    given = read_plan(request.file)
    genotype = genotype_of(given, request.seed)
    grown: Plan | Failure = genotype if isinstance(genotype, Failure) else form_of(genotype, given.brief.cells)
    if isinstance(genotype, Failure) or isinstance(grown, Failure):
        return f"{request.file} did not grow: {grown}"
    layout = laid_out(grown, given.brief)
    told = _measured(layout)
    if request.output is not None:
        _write(layout, genotype, request.output, request.file)
        told["file"] = str(request.output)
    return told


def _refuse(request: Request) -> None:
    """Refuse options of other engines."""
    file = str(request.file)
    if request.steps is not None:
        raise InputError("--steps", "rules to derive", file, "a plan has as many conjoinings as it needs")
    if request.until is not None:
        raise InputError("--time", "a timed system (.tl)", file)
    if request.environment is not None:
        raise InputError("--environment", "a form that grows in one (.hemls)", file, "a plan's site is in its brief")
    if request.overrides:
        raise InputError(f"--set {request.overrides[0]}", "a form with settings of growth", file, "set it in the file")
    if request.forces:
        raise InputError("--forces", "a block body (.blocks, .body.json)", file)
    if request.word:
        raise InputError("--word", "a timed system (.tl)", file)


def _measured(layout: Layout) -> dict[str, Any]:
    from evaluators.plans import PLAN_CRITERIA, score
    from evaluators.rooms import ROOM_CRITERIA
    from evaluators.rooms import score as score_room
    from growth.polyforms import Polyform

    plan, brief = layout.plan, layout.brief
    names = list(brief.rooms)
    rooms = [Polyform(plan.tiling, plan.cells[plan.rooms == room]) for room in range(plan.count)]
    scores = [_scores(score_room(one, ROOM_CRITERIA)) for one in rooms]
    whole = scores[0] if len(rooms) == 1 else _scores(score(layout, PLAN_CRITERIA))
    size = plan.tiling.area * brief.unit ** (3 if plan.tiling.solid else 2)
    return {
        "cells": len(plan.cells),
        "tiling": plan.tiling.name,
        "area": len(plan.cells) * size,
        **whole,
        "rooms": [
            {"name": name, "cells": len(one.cells), "area": len(one.cells) * size,
             "perimeter": found["perimeter"], "corners": found["corners"]}
            for name, one, found in zip(names, rooms, scores, strict=True)
        ],
        "doors": [[names[first], names[second]] for first, second in layout.doors],
    }  # fmt: skip


def _scores(found: dict[str, float] | Failure) -> dict[str, float]:
    """Give the scores: the project's own criteria measure whatever has grown."""
    assert isinstance(found, dict)
    return found


def _write(layout: Layout, genotype: Room | Assembly, output: Path, source: Path) -> None:
    from evaluators.plans.drawings.files import write_plan
    from genome.files import write_whole
    from genome.polyform import encode

    if output.suffix.lower() == ".json":
        write_whole(output, encode(genotype).encode())
    else:
        write_plan(layout, output, source.stem, {"file": source.name})
