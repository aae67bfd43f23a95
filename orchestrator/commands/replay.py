"""``atoll replay``."""

from __future__ import annotations

import contextlib
import sys
from typing import TYPE_CHECKING

import click

from genome.errors import InputError
from orchestrator.commands._options import check_place, emit, example, json_option, runs_at
from orchestrator.unbroken import Unbroken

if TYPE_CHECKING:
    from orchestrator.folder import Runs

FREE = ("hosts", "backend", "deadlines", "log")
"""Settings that a replay may change, since nothing that happens in a run hangs on them."""


@click.command(
    "replay",
    epilog=example(
        "atoll replay runs/drape", "atoll replay runs/drape --id 1099511627776", "atoll replay runs/drape --set hosts=1"
    ),
)
@click.argument("run")
@click.option("--id", "identity", type=int, help="An individual's id in the log: that one alone is replayed.")
@click.option("--runs-dir", type=click.Path(), default="runs", show_default=True,
              help="Where the folder of the new run is to stand.")  # fmt: skip
@click.option("--name", help="The new run's name; by default the run's with -replay.")
@click.option("--set", "overrides", multiple=True, metavar="KEY.PATH=VALUE",
              help="In place of the run's own: hosts, backend, deadlines or log.")  # fmt: skip
@json_option
def command(
    run: str,
    identity: int | None,
    runs_dir: str,
    name: str | None,
    overrides: tuple[str, ...],
    as_json: bool,
) -> None:
    """Run RUN again, as it went, into a new folder, and compare what happened; or one individual with --id.

    A run of the schedule async takes in what came as its log says that it came. Exits with 1 when the two digests
    differ, or the individual's fitness or scores are not the log's to the last bit.
    """
    if identity is None:
        check_place(runs_dir, name)
        with contextlib.redirect_stdout(Unbroken(sys.stdout)), contextlib.redirect_stderr(Unbroken(sys.stderr)):
            _replay_run(run, runs_at(runs_dir), name, overrides, as_json=as_json)
    elif name is not None or overrides:
        raise InputError("--id", "no --name and no --set beside it", "both", "they are for the replay of a whole run")
    else:
        _replay_individual(run, identity, as_json=as_json)


def _replay_run(run: str, runs_dir: Runs, name: str | None, overrides: tuple[str, ...], *, as_json: bool) -> None:
    from orchestrator.backends.protocol import RunFailedError
    from orchestrator.cli import Complaint
    from orchestrator.digest import digest
    from orchestrator.folder import open_run
    from orchestrator.overrides import parse_override
    from orchestrator.progress import progress_on
    from orchestrator.replay import replay

    for override in overrides:
        key = parse_override(override)[0][0]
        if key not in FREE:
            raise InputError(f"--set {override}", f"a setting of {', '.join(FREE)}", f"'{key}'", "a replay keeps it")
    folder = open_run(run)
    progress = progress_on(sys.stderr if as_json else sys.stdout)
    try:
        with contextlib.redirect_stdout(sys.stderr):
            outcome = replay(folder, runs_dir, name, overrides, progress)
    except RunFailedError as error:
        raise Complaint(str(error), 1) from None
    if outcome.status == "stopped":
        click.echo("atoll: the replay was stopped; nothing is compared", err=True)
        raise click.exceptions.Exit(130)
    first, second = digest(folder.log)[0], digest(outcome.store.at("log"))[0]
    if as_json:
        emit({"run": str(outcome.store), "digest": second, "same": first == second})
    else:
        click.echo(f"{second} {outcome.store.name} ({'the same' if first == second else 'not the same'})")
    if outcome.status == "failed":
        raise Complaint(outcome.reason, 1)
    if first != second:
        raise Complaint(f"the log of {folder.name} has the digest {first}", 1)


def _replay_individual(run: str, identity: int, *, as_json: bool) -> None:
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
