"""``atoll replay``."""

from __future__ import annotations

import click

from orchestrator.commands._options import emit, example, json_option


@click.command("replay", epilog=example("atoll replay runs/drape --id 1099511627776"))
@click.argument("run")
@click.option("--id", "identity", type=int, required=True, help="The individual's id in the log.")
@json_option
def command(run: str, identity: int, as_json: bool) -> None:
    """Regrow an individual of RUN from its genotype and score it again as its island did.

    Exits with 1 when fitness or scores are not the log's to the last bit.
    """
    from orchestrator.folder import open_run
    from orchestrator.regrow import Nursery, by_id, same

    folder = open_run(run)
    (logged,) = by_id(folder, [identity])
    scored = Nursery(folder).score(logged)
    equal = same(logged, scored)
    if as_json:
        scores = dict(scored.scores)
        emit(
            {"id": identity, "fitness": scored.fitness, "same": equal, "island": logged.island, "scores": scores,
             "error": scored.error, "logged": {"fitness": logged.fitness, "error": logged.error}}
        )  # fmt: skip
    else:
        fitness = "invalid" if scored.fitness is None else repr(scored.fitness)
        click.echo(f"{identity} of island {logged.island}: {fitness} ({'the same' if equal else 'not the same'})")
        for name, value in scored.scores:
            click.echo(f"  {name} {value!r}")
        if scored.error:
            click.echo(f"  {scored.error}")
    if not equal:
        click.echo(f"atoll: the log has fitness {logged.fitness!r} ({logged.error or 'valid'})", err=True)
        raise click.exceptions.Exit(1)
