"""``atoll run``."""

from __future__ import annotations

import contextlib
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from orchestrator.commands._options import check_place, emit, example, json_option, runs_at
from orchestrator.unbroken import Unbroken

if TYPE_CHECKING:
    from islands.store import Store
    from orchestrator.drive import Outcome
    from orchestrator.folder import Runs


@click.command(
    "run",
    epilog=example(
        "atoll run experiments/drape.yaml",
        "atoll run experiments/drape.yaml --set generations=4 --set backend=inline --json",
    ),
)
@click.argument("experiment", type=click.Path(path_type=Path))
@click.option("--runs-dir", type=click.Path(), default="runs", show_default=True,
              help="Where run folders stand: a folder, or a place such as s3://bucket/runs.")  # fmt: skip
@click.option("--name", help="The run's name; by default the experiment's, with a number if it is taken.")
@click.option("--seed", type=click.IntRange(min=0, max=2**63 - 1), help="In place of the experiment's seed.")
@click.option("--set", "overrides", multiple=True, metavar="KEY.PATH=VALUE", help="In place of any of its settings.")
@click.option("--address", help="A running Ray cluster, host:port or auto; a local Ray is started without.")
@json_option
def command(
    experiment: Path,
    runs_dir: str,
    name: str | None,
    seed: int | None,
    overrides: tuple[str, ...],
    address: str | None,
    as_json: bool,
) -> None:
    """Run EXPERIMENT, a YAML file, and write its forms and log under the runs folder."""
    check_place(runs_dir, name)
    if seed is not None:
        overrides = (*overrides, f"seed={seed}")
    # Progress that nobody reads, as after `atoll run ... | head -1` or in a terminal that was closed, stops no run.
    with contextlib.redirect_stdout(Unbroken(sys.stdout)), contextlib.redirect_stderr(Unbroken(sys.stderr)):
        _run(experiment, runs_at(runs_dir), name, overrides, address, as_json=as_json)


def _run(
    experiment: Path,
    runs_dir: Runs,
    name: str | None,
    overrides: tuple[str, ...],
    address: str | None,
    *,
    as_json: bool,
) -> None:
    from orchestrator.backends.protocol import RunFailedError
    from orchestrator.cli import Complaint
    from orchestrator.loading import load_experiment
    from orchestrator.progress import progress_on
    from orchestrator.run import make_backend, run_experiment

    loaded = load_experiment(experiment, overrides)
    backend = make_backend(loaded, address)
    progress = progress_on(sys.stderr if as_json else sys.stdout)
    for note in loaded.notes:
        progress.note(f"note: {note}")
    try:
        # What Ray and plug-ins print goes to stderr: stdout is for progress or the JSON object alone.
        with contextlib.redirect_stdout(sys.stderr):
            outcome = run_experiment(loaded, backend, runs_dir, name, progress)
    except RunFailedError as error:
        raise Complaint(str(error), 1) from None
    conclude(outcome, as_json=as_json)


def conclude(outcome: Outcome, *, as_json: bool) -> None:
    """Say what came of a run, and exit accordingly."""
    from orchestrator.cli import Complaint

    if as_json:
        emit(
            {
                "run": str(outcome.store),
                "name": outcome.store.name,
                "status": outcome.status,
                "islands": outcome.islands,
                "generations": outcome.generations,
                "evaluations": outcome.evaluations,
                "best": outcome.best,
                "wall_s": outcome.wall_s,
                "startup_s": outcome.startup_s,
                "stepped_s": outcome.stepped_s,
                "busy": outcome.busy,
            }
        )
    else:
        _tell(outcome.store, outcome.status, outcome.best)
        click.echo(f"{outcome.evaluations} evaluations in {outcome.wall_s:.1f} s")
    if outcome.status == "failed":
        raise Complaint(f"{outcome.reason}; go on with: {_called()} resume {_shown(outcome.store)}", 1)
    if outcome.status == "stopped":
        raise click.exceptions.Exit(130)


def _tell(folder: Store, status: str, best: dict[str, object] | None) -> None:
    """Say where the run's forms and log are, and what to do with them."""
    shown = _shown(folder)
    click.echo(f"\n{status}: {shown}")
    if best is not None:
        click.echo(f"best: {best['id']} of island {best['island']}, fitness {best['fitness']:.6g}")
    if folder.names("forms"):
        click.echo(f"forms: {shown}/forms")
    click.echo(f"log: {shown}/log (Parquet)")
    atoll = _called()
    click.echo(f"look: {atoll} report {shown}  (one HTML file; {atoll} sheet {shown} draws its forms)")
    click.echo(f"next: {atoll} show {shown}")
    sql = "select island, max(fitness) from individuals group by island"
    click.echo(f'      {atoll} query {shown} "{sql}"')
    click.echo(f"      {atoll} export {shown} --best 3 --format glb,png -o forms")


def _shown(folder: Store) -> str:
    """Give the run's folder as a shell takes it: from here, where it is below."""
    import shlex

    here, path = Path.cwd(), folder.local
    if path is None:
        return shlex.quote(str(folder))
    return str(path.relative_to(here) if path.is_relative_to(here) else path)


def _called() -> str:
    """Give the program as it can be called again from here: by its name only where the shell would find it."""
    program = Path(sys.argv[0])
    found = shutil.which("atoll")
    if program.name != "atoll" or (found is not None and Path(found).resolve() == program.resolve()):
        return "atoll"
    here = Path.cwd()
    return str(program.relative_to(here) if program.is_relative_to(here) else program)
