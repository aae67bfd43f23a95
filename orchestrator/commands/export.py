"""``atoll export``."""

from __future__ import annotations

from pathlib import Path

import click

from genome.errors import InputError
from orchestrator.commands._options import emit, example, json_option


@click.command("export", epilog=example("atoll export runs/drape --best 3 --format glb,png -o forms"))
@click.argument("run")
@click.option("--best", type=click.IntRange(min=1), help="The best so many of the whole run; 1 without --id.")
@click.option("--id", "ids", type=int, multiple=True, help="An individual's id in the log; may be repeated.")
@click.option("--format", "formats", default="glb", show_default=True,
              help="Suffixes separated by commas: glb, obj, ply, stl, png, hemls.")  # fmt: skip
@click.option("-o", "output", type=click.Path(path_type=Path, file_okay=False), required=True, help="A folder.")
@json_option
def command(run: str, best: int | None, ids: tuple[int, ...], formats: str, output: Path, as_json: bool) -> None:
    """Regrow individuals of RUN from its log and write their forms, named ISLAND-ID, into a folder."""
    from orchestrator import regrow
    from orchestrator.folder import open_run

    folder = open_run(run)
    suffixes = list(dict.fromkeys(part.strip().lower().lstrip(".") for part in formats.split(",") if part.strip()))
    if not suffixes:
        raise InputError("--format", "suffixes such as glb,png", f"'{formats}'")
    wanted = regrow.by_id(folder, ids)
    if best is not None or not ids:
        found = regrow.best(folder, best or 1)
        if not found:
            raise InputError(run, "a run with valid individuals", "none in its log so far")
        wanted += [row for row in found if row.id not in ids]
    nursery = regrow.Nursery(folder)
    output.mkdir(parents=True, exist_ok=True)
    files: list[str] = []
    for logged in wanted:
        written = nursery.write_forms(logged, output, suffixes)
        if not written:
            raise InputError(f"--id {logged.id}", "an individual that has a form", logged.error or "one without")
        files.extend(str(path) for path in written)
        if not as_json:
            for path in written:
                click.echo(str(path))
    if as_json:
        emit({"files": files})
