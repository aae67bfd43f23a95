"""``atoll digest``."""

from __future__ import annotations

import click

from orchestrator.commands._options import emit, example, json_option


@click.command("digest", epilog=example("atoll digest runs/drape"))
@click.argument("run")
@json_option
def command(run: str, as_json: bool) -> None:
    """Give one hash of what happened in RUN: equal for runs that did the same."""
    from orchestrator.digest import digest
    from orchestrator.folder import open_remains

    value, rows = digest(open_remains(run).log)
    if as_json:
        emit({"digest": value, "rows": rows})
    else:
        click.echo(f"{value}  {rows} rows")
