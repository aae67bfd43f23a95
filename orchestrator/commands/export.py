"""``atoll export``."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import click

from genome.errors import InputError
from orchestrator.commands._options import emit, example, json_option


@click.command("export", epilog=example("atoll export runs/drape --best 3 --format glb,png -o forms"))
@click.argument("run")
@click.option(
    "--best",
    type=click.IntRange(min=1),
    help="So many of the whole run's best, of different forms (equal scores: one form); 1 without --id.",
)
@click.option(
    "--island", "islands", multiple=True, help="The best of this island, or group of islands; may be repeated."
)
@click.option("--id", "ids", type=int, multiple=True, help="An individual's id in the log; may be repeated.")
@click.option("--format", "formats", default="glb", show_default=True,
              help="Such as glb, obj, stl, png; by kind ply, npz, hemls, blocks, tl, gif, svg, dxf, ifc.")  # fmt: skip
@click.option("-o", "output", type=click.Path(path_type=Path, file_okay=False), required=True, help="A folder.")
@json_option
def command(
    run: str,
    best: int | None,
    islands: tuple[str, ...],
    ids: tuple[int, ...],
    formats: str,
    output: Path,
    as_json: bool,
) -> None:
    """Regrow individuals of RUN from its log and write their forms, named ISLAND-ID, into a folder."""
    from orchestrator import regrow
    from orchestrator.folder import open_remains

    folder = open_remains(run)
    suffixes = list(dict.fromkeys(part.strip().lower().lstrip(".") for part in formats.split(",") if part.strip()))
    if not suffixes:
        raise InputError("--format", "suffixes such as glb,png", f"'{formats}'")
    wanted = regrow.by_id(folder, ids)
    if best is not None or islands or not ids:
        found = regrow.best(folder, best or 1, regrow.islands_named(folder, islands))
        if not found:
            raise InputError(run, "a run with valid individuals", "none in its log so far")
        wanted += [row for row in found if row.id not in ids]
    nursery = regrow.Nursery(folder)
    files: list[str] = []
    with _folder(output):
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


@contextmanager
def _folder(path: Path) -> Iterator[None]:
    """Make a folder that files can be written to; take it away again, and those above it, if nothing was."""
    missing: list[Path] = []
    try:
        try:
            missing = [folder for folder in (path, *path.parents) if not folder.exists()]
            path.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=path):
                pass
        except OSError as error:
            raise InputError("-o", "a folder that can be written to", f"{path} ({error.strerror or error})") from None
        yield
    except BaseException:
        for folder in missing:
            with suppress(OSError):
                folder.rmdir()
        raise
