"""``atoll sheet``."""

from __future__ import annotations

from pathlib import Path

import click

from orchestrator.commands._options import emit, example, json_option


@click.command(
    "sheet",
    epilog=example(
        "atoll sheet runs/drape -o drape.png",
        "atoll sheet runs/house --best 6",
        "atoll sheet runs/archipelago --island living -o living.svg",
    ),
)
@click.argument("run")
@click.option("--island", "islands", multiple=True, metavar="NAME",
              help="An island, or a group; may be repeated. Without: all, but of a run of plans alone the uppermost "
              "level: houses, else zones, else rooms.")  # fmt: skip
@click.option("--best", "count", type=click.IntRange(1, 48), default=12, show_default=True, help="So many plans.")
@click.option("-o", "output", type=click.Path(path_type=Path, dir_okay=False), default=Path("sheet.png"),
              show_default=True, help="The sheet's file: .png; of plans alone also .svg.")  # fmt: skip
@json_option
def command(run: str, islands: tuple[str, ...], count: int, output: Path, as_json: bool) -> None:
    """Draw RUN's forms side by side: of each island the best over time, or, of plans alone, the best at one scale."""
    from analysis.sheets import write_sheet
    from orchestrator.folder import open_remains

    missing = write_sheet(open_remains(run), count, islands, output)
    for line in missing:
        click.echo(f"atoll: {line}", err=True)
    if as_json:
        emit({"file": str(output), "missing": missing})
    else:
        click.echo(str(output))
