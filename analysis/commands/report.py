"""``atoll report``."""

from __future__ import annotations

from pathlib import Path

import click

from orchestrator.commands._options import emit, example, json_option


@click.command("report", epilog=example("atoll report runs/archipelago", "atoll report runs/drape -o drape.html"))
@click.argument("run")
@click.option("-o", "output", type=click.Path(path_type=Path, dir_okay=False),
              help="The file; report.html in RUN's folder without.")  # fmt: skip
@json_option
def command(run: str, output: Path | None, as_json: bool) -> None:
    """Write one HTML file that shows RUN: forms, fitness, channels, failures, ancestors, settings, and the queries."""
    from analysis.report import write_report
    from orchestrator.folder import open_remains

    click.echo("gathering the figures and growing the pictures anew ...", err=True)
    place = write_report(open_remains(run), output)
    if as_json:
        emit({"report": place})
    else:
        click.echo(place)
