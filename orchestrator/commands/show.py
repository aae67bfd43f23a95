"""``atoll show``."""

from __future__ import annotations

from typing import Any

import click

from orchestrator.commands._options import emit, example, json_option


@click.command("show", epilog=example("atoll show runs/drape"))
@click.argument("run")
@json_option
def command(run: str, as_json: bool) -> None:
    """Show how RUN stands: its status, islands, best so far, and rates."""
    from orchestrator.folder import open_run
    from orchestrator.standing import standing

    found = standing(open_run(run))
    if as_json:
        emit(found)
        return
    gone = f" (its process is gone; go on with: atoll resume {run})" if found["alive"] is False else ""
    click.echo(f"{found['run']}: {found['status']}{gone}")
    if found["error"]:
        click.echo(f"reason: {found['error']}")
    rate = found["evaluations_per_s"]
    click.echo(
        f"{found['generations']} generations, {found['evaluations']} evaluations"
        + (f", {rate:.1f} a second" if rate is not None else "")
    )
    best = found["best"]
    if best is not None:
        click.echo(f"best: {best['id']} of island {best['island']}, fitness {best['fitness']:.6g}")
    _table(found["islands"])


def _table(islands: list[dict[str, Any]]) -> None:
    from orchestrator.query import Answer, as_table

    columns = ("island", "species", "generation", "evaluations", "best", "mean", "invalid", "migrants")
    rows = [tuple(_short(row[name]) for name in columns) for row in islands]
    if rows:
        click.echo("\n" + as_table(Answer(columns, rows)))


def _short(value: Any) -> Any:  # noqa: ANN401 - a cell
    return float(f"{value:.6g}") if isinstance(value, float) else value
