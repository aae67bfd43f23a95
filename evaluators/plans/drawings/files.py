"""Plans as files of several formats."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

from evaluators.plans.drawings.draw import drawing
from evaluators.plans.drawings.dxf import plan_dxf
from evaluators.plans.drawings.glb import cube_parts, parts_glb, plan_parts
from evaluators.plans.drawings.ifc import plan_ifc
from evaluators.plans.drawings.pictures import cubes_png
from evaluators.plans.drawings.png import plan_png
from evaluators.plans.drawings.svg import plan_svg
from evaluators.plans.layout import Layout
from genome.errors import InputError
from genome.files import write_whole

Extras = Mapping[str, str | float | bool]


def _glb(layout: Layout, title: str, extras: Extras) -> bytes:
    parts = cube_parts(layout) if layout.plan.tiling.solid else plan_parts(drawing(layout, title))
    return parts_glb(parts, {"title": title, **extras})


def _png(layout: Layout, title: str, extras: Extras) -> bytes:
    del extras
    return cubes_png(layout) if layout.plan.tiling.solid else plan_png(drawing(layout, title))


def _svg(layout: Layout, title: str, extras: Extras) -> bytes:
    del extras
    return plan_svg(drawing(layout, title))


def _dxf(layout: Layout, title: str, extras: Extras) -> bytes:
    del extras
    return plan_dxf(drawing(layout, title))


def _ifc(layout: Layout, title: str, extras: Extras) -> bytes:
    del extras
    return plan_ifc(drawing(layout, title))


WRITERS: Final[Mapping[str, Callable[[Layout, str, Extras], bytes]]] = {
    "svg": _svg,
    "dxf": _dxf,
    "ifc": _ifc,
    "glb": _glb,
    "png": _png,
}
"""How each format is written."""

OF_CUBES: Final = ("glb", "png")
"""Formats that plans of cubes can be written in, which have no single floor."""


def write_plan(layout: Layout, path: Path, title: str, extras: Extras | None = None) -> None:
    """Write a plan to a file, whole or not at all.

    Parameters
    ----------
    layout
        The plan and its brief.
    path
        The file; its suffix chooses the format: one of :data:`WRITERS`.
    title, extras
        What it is; drawings have the title, GLB both in its scene's extras.

    Raises
    ------
    InputError
        When the suffix is unknown, or the plan is one of cubes and the format has one floor.
    """
    suffix = path.suffix.lower().removeprefix(".")
    if suffix not in WRITERS:
        raise InputError(
            str(path), f"a plan's suffix (.{', .'.join(WRITERS)})", f"'{path.suffix}'", "choose one of these"
        )
    write_whole(path, WRITERS[suffix](layout, title, extras or {}))


__all__ = ["OF_CUBES", "WRITERS", "write_plan"]
