"""``atoll sheet``."""

from __future__ import annotations

from pathlib import Path

import click

from orchestrator.commands._options import emit, example, json_option


@click.command(
    "sheet", epilog=example("atoll sheet runs/house", "atoll sheet runs/house --island living -o living.svg")
)
@click.argument("run")
@click.option("--best", "count", type=click.IntRange(1, 48), default=12, show_default=True, help="So many plans.")
@click.option("--island", "islands", multiple=True, metavar="NAME",
              help="An island, or a group; may be repeated. Without: houses, else zones, else rooms.")  # fmt: skip
@click.option("-o", "output", type=click.Path(path_type=Path, dir_okay=False), default=Path("sheet.png"),
              show_default=True, help="The sheet's file: .png or .svg.")  # fmt: skip
@json_option
def command(run: str, count: int, islands: tuple[str, ...], output: Path, as_json: bool) -> None:
    """Draw the best plans of RUN side by side at one scale."""
    from orchestrator.folder import open_run
    from orchestrator.sheets import write_sheet

    write_sheet(open_run(run), count, islands, output)
    if as_json:
        emit({"file": str(output)})
    else:
        click.echo(str(output))
