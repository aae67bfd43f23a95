"""Refining a form's file: read, go through a recipe, measured, written."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from genome.settings import validated
from orchestrator.growing import check_output
from orchestrator.overrides import apply_overrides

if TYPE_CHECKING:
    from growth.refining import Mesh

FORMS: Final = (".glb", ".obj", ".ply", ".stl")


def refine_form(form: Path, recipe: str, overrides: Sequence[str], output: Path | None) -> dict[str, Any] | str:
    """Refine a form.

    Parameters
    ----------
    form
        A mesh's file, in any format that trimesh reads.
    recipe
        Steps, with commas or blanks between them.
    overrides
        Settings of the steps, ``key=value``.
    output
        Where to write; without, beside the form, with ``-refined`` after its name.

    Returns
    -------
    dict or str
        ``file``, ``recipe``, ``vertices``, ``faces``, ``watertight``, ``manifold``, ``oriented``, ``open_edges``,
        ``crossings``, ``parts``, ``volume`` (``None`` where it is not watertight) and ``bounds``; or the message of a
        step that failed.

    Raises
    ------
    InputError
        When the form, the recipe, a setting or the output is not right, or pymeshlab cannot be used on this machine.
    """
    from growth.forms import write_form
    from growth.protocol import Failure
    from growth.refining import RefineSettings, parse_recipe, read_form, refine
    from growth.surface import surface_of

    names = parse_recipe(recipe)
    settings = validated(RefineSettings, apply_overrides({}, overrides), "--set")
    written = output or form.with_name(f"{form.stem}-refined{form.suffix if form.suffix in FORMS else '.glb'}")
    check_output(written, FORMS)
    refined = refine(read_form(form), names, settings)
    if isinstance(refined, Failure):
        return f"{form} was not refined: {refined}"
    surface = surface_of(refined.vertices, refined.triangles)
    write_form(surface, written, title=written.stem, extras={"form": form.name, "recipe": ", ".join(names)})
    return {"file": str(written), "recipe": list(names), **_told(refined)}


def _told(mesh: Mesh) -> dict[str, Any]:
    from growth.refining import quality

    found = quality(mesh)
    return {
        "vertices": len(mesh.vertices),
        "faces": len(mesh.triangles),
        **found._asdict(),
        "volume": found.volume if found.watertight else None,
        "bounds": [mesh.vertices.min(axis=0).tolist(), mesh.vertices.max(axis=0).tolist()],
    }
