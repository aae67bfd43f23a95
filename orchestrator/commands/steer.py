"""``atoll steer``."""

from __future__ import annotations

import getpass
import platform
import time
from datetime import UTC, datetime
from typing import TYPE_CHECKING

import click

from genome.errors import InputError
from orchestrator.commands._options import emit, example, json_option

if TYPE_CHECKING:
    from orchestrator.folder import RunFolder
    from orchestrator.steering.command import Request

SOON = 2**31
"""In place of the epoch in which a command will take effect, which the run decides: later than all before it."""

HELP = """Intervene in the running RUN: it takes effect at the start of an epoch, in the log and for good.

\b
pause, resume, stop, checkpoint
weight CRITERION=VALUE...    target CRITERION=VALUE...    rate NAME=VALUE...
strength NAME=VALUE...
promote ID, promote none     lock ID, unlock ID           remove ID
insert GENOTYPE
add-island NAME              remove-island NAME
connect CHANNEL              disconnect CHANNEL-NAME

Exits with 2 when the command cannot be meant or the run refuses it, and with 1 when the run does not answer.
"""
"""What it takes, for ``--help``; the backspace keeps click from filling the lines after it."""


@click.command(
    "steer",
    help=HELP,
    # An id that is negative by mistake is a word to be refused by name, not an option that nobody knows.
    context_settings={"ignore_unknown_options": True},
    epilog=example(
        "atoll steer runs/drape pause",
        "atoll steer runs/drape weight size=3 undulation=0.5 --island drape-0",
        "atoll steer runs/drape promote 1099511627776",
        "atoll steer runs/drape add-island south --like drape --set population=16",
        "atoll steer runs/drape connect '{kind: migrants, from: drape, to: south}'",
    ),
)
@click.argument("run")
@click.argument("words", nargs=-1, metavar="VERB [WORDS]...")
@click.option("--island", "islands", multiple=True, metavar="NAME",
              help="The island or group that it is for; may be given again. By default all.")  # fmt: skip
@click.option("--like", default="", metavar="GROUP", help="Of add-island: the group whose settings it takes.")
@click.option("--set", "settings", multiple=True, metavar="KEY.PATH=VALUE",
              help="Of add-island: a setting of its own, such as population=16.")  # fmt: skip
@click.option("--wait", default=30.0, show_default=True, type=click.FloatRange(min=0.0), metavar="SECONDS",
              help="How long to wait for the run's answer.")  # fmt: skip
@json_option
def command(
    run: str,
    words: tuple[str, ...],
    islands: tuple[str, ...],
    like: str,
    settings: tuple[str, ...],
    wait: float,
    as_json: bool,
) -> None:
    """Steer a run; see ``HELP``."""
    from orchestrator.cli import Complaint
    from orchestrator.folder import open_run
    from orchestrator.steering.language import Words, read, split
    from orchestrator.steering.mailbox import await_answer, post

    verb, rest = split(words)
    request = read(verb, Words(rest, islands, like, settings))
    folder = open_run(run)
    _refuse_ended(folder)
    request = _checked(folder, request)
    token = post(folder.store, request, datetime.now(UTC).isoformat(timespec="milliseconds"), _who())
    try:
        answer = await_answer(folder.store, token, wait, time.monotonic, time.sleep, lambda: _is_going(folder))
    except KeyboardInterrupt:
        answer = await_answer(folder.store, token, 0.0, time.monotonic, time.sleep)
        if answer is None:
            raise
    if answer is None:
        if not _is_going(folder):
            raise Complaint(f"{run}: the run ended before it answered; the command was not taken", 1)
        remedy = "wait longer with --wait, and see commands.jsonl for whether it was taken after all"
        raise Complaint(f"{run}: no answer from the run within {wait:g} s, the command was withdrawn; {remedy}", 1)
    if as_json:
        emit({"accepted": answer.accepted, "epoch": answer.epoch, "reason": answer.reason})
    elif answer.accepted:
        click.echo(f"{verb}: accepted, from epoch {answer.epoch} on")
    if not answer.accepted:
        raise Complaint(f"{run} refused '{verb}': {answer.reason}", 2)


def _is_going(folder: RunFolder) -> bool:
    """Tell whether a run goes on, as far as can be known from here."""
    from orchestrator.standing import GOING, alive

    manifest = folder.manifest()
    return manifest.get("status") in GOING and alive(manifest) is not False


def _refuse_ended(folder: RunFolder) -> None:
    from orchestrator.standing import GOING

    if not _is_going(folder):
        status = folder.manifest().get("status")
        got = f"one whose process is gone (status: {status})" if status in GOING else f"one that is {status}"
        raise InputError(str(folder.store), "a run that is running", got, "nobody is there to take commands")


def _checked(folder: RunFolder, request: Request) -> Request:
    """Check a request against the run as it is now; nothing has been written by then."""
    from orchestrator.loading import load_experiment
    from orchestrator.steering.checks import checked
    from orchestrator.steering.command import RUN
    from orchestrator.steering.journal import read_commands
    from orchestrator.steering.restructuring import replayed
    from orchestrator.steering.structure import structure_of

    if request.verb in RUN:
        return request
    structure = replayed(structure_of(load_experiment(folder.experiment)), read_commands(folder.store))
    return checked(request, structure, SOON, trial=True)


def _who() -> str:
    """Give who asks, for the run's history."""
    try:
        return f"{getpass.getuser()}@{platform.node()}"
    except (KeyError, OSError, ImportError):  # an account without a name, as in a container
        return platform.node()
