"""``atoll schema``."""

from __future__ import annotations

import click

from orchestrator.commands._options import example


@click.command("schema", epilog=example("atoll schema > experiment.schema.json"))
@click.option("--json", "as_json", is_flag=True, help="On one line.")
def command(as_json: bool) -> None:
    """Print the JSON Schema of the experiment file."""
    import json

    from orchestrator.json_schema import experiment_schema

    click.echo(json.dumps(experiment_schema(), indent=None if as_json else 2))
