"""``atoll chart``."""

from __future__ import annotations

from pathlib import Path

import click

from orchestrator.commands._options import emit, example, json_option


@click.command("chart", epilog=example("atoll chart runs/enclosure_space --score symbiotic -o symbiotic.png"))
@click.argument("run")
@click.option("--score", default="fitness", show_default=True, help="A criterion, or the fitness.")
@click.option("-o", "output", type=click.Path(path_type=Path, dir_okay=False), help="PNG or SVG; RUN's name without.")
@json_option
def command(run: str, score: str, output: Path | None, as_json: bool) -> None:
    """Draw a score of RUN over its generations: of each group of islands the best and the mean of who was scored."""
    from analysis.chart import write_chart
    from orchestrator.folder import open_remains

    folder = open_remains(run)
    path = output or Path(f"{folder.name}-{score}.png")
    write_chart(folder, score, path)
    if as_json:
        emit({"file": str(path)})
    else:
        click.echo(str(path))
