"""``atoll refine``."""

from __future__ import annotations

from pathlib import Path

import click

from orchestrator.commands._options import emit, example, json_option


@click.command(
    "refine",
    epilog=example(
        "atoll refine drape.glb --recipe clean,remesh,smooth",
        "atoll refine drape.glb --recipe solid --set thickness=0.1 -o drape.stl",
    ),
)
@click.argument("form", type=click.Path(path_type=Path))
@click.option("--recipe", default="clean", show_default=True, metavar="STEPS",
              help="Steps in their order: clean, remesh, smooth, solid.")  # fmt: skip
@click.option("--set", "overrides", multiple=True, metavar="KEY=VALUE",
              help="length (of remeshed edges), rounds (of smoothing), thickness (of a solid).")  # fmt: skip
@click.option("-o", "output", type=click.Path(path_type=Path, dir_okay=False),
              help="The refined form's file: .glb, .obj, .ply or .stl; FORM's name and -refined without.")  # fmt: skip
@json_option
def command(form: Path, recipe: str, overrides: tuple[str, ...], output: Path | None, as_json: bool) -> None:
    """Make FORM, a mesh, ready to be made: repaired, its triangles even, smoothed, or a watertight solid."""
    from orchestrator.cli import Complaint
    from orchestrator.refining import refine_form

    refined = refine_form(form, recipe, overrides, output)
    if isinstance(refined, str):
        raise Complaint(refined, 1)
    if as_json:
        emit(refined)
        return
    for key, value in refined.items():
        click.echo(f"{key}: {f'{value:.6g}' if isinstance(value, float) else value}")
