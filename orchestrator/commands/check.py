"""``atoll check``."""

from __future__ import annotations

from pathlib import Path

import click

from orchestrator.commands._options import emit, example, json_option


@click.command("check", epilog=example("atoll check experiments/drape.yaml", "atoll check site.env.yaml --json"))
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--set", "overrides", multiple=True, metavar="KEY.PATH=VALUE", help="As for 'atoll run'.")
@json_option
def command(file: Path, overrides: tuple[str, ...], as_json: bool) -> None:
    """Validate FILE (an experiment, a system of any kind, an environment, a grammar, a plan) without running it."""
    from orchestrator.checking import check

    kind, notes = check(file, overrides)
    for note in notes:
        click.echo(f"note: {note}", err=True)
    if as_json:
        emit({"ok": True, "kind": kind})
    else:
        click.echo(f"ok: {file} ({kind})")
