"""``atoll resume``."""

from __future__ import annotations

import contextlib
import sys

import click

from orchestrator.commands._options import example, json_option
from orchestrator.unbroken import Unbroken


@click.command(
    "resume", epilog=example("atoll resume runs/drape", "atoll resume runs/drape --set generations=200 --json")
)
@click.argument("run")
@click.option("--set", "overrides", multiple=True, metavar="KEY.PATH=VALUE",
              help="generations (more of them), hosts, backend, deadlines, log, checkpoint, forms.")  # fmt: skip
@click.option("--address", help="A running Ray cluster, host:port or auto; a local Ray is started without.")
@json_option
def command(run: str, overrides: tuple[str, ...], address: str | None, as_json: bool) -> None:
    """Go on with RUN from its last checkpoint, as if it had never been broken off.

    A run that was stopped, failed or killed goes on to its end; one that finished goes on when it is given more
    generations. Whatever the log holds beyond the checkpoint is cut off and bred again, to the same bits.
    """
    with contextlib.redirect_stdout(Unbroken(sys.stdout)), contextlib.redirect_stderr(Unbroken(sys.stderr)):
        _resume(run, overrides, address, as_json=as_json)


def _resume(run: str, overrides: tuple[str, ...], address: str | None, *, as_json: bool) -> None:
    from orchestrator.backends.protocol import RunFailedError
    from orchestrator.cli import Complaint
    from orchestrator.commands.run import conclude
    from orchestrator.folder import open_run
    from orchestrator.progress import progress_on
    from orchestrator.resume import resumable, resume
    from orchestrator.run import make_backend

    folder = open_run(run)
    loaded = resumable(folder, overrides)
    backend = make_backend(loaded, address)
    progress = progress_on(sys.stderr if as_json else sys.stdout)
    try:
        with contextlib.redirect_stdout(sys.stderr):
            outcome = resume(folder, loaded, backend, progress)
    except RunFailedError as error:
        raise Complaint(str(error), 1) from None
    conclude(outcome, as_json=as_json)
