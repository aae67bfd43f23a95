"""``atoll validate``."""

from __future__ import annotations

import time
from dataclasses import asdict
from typing import TYPE_CHECKING

import click

from orchestrator.commands._options import emit, example, json_option

if TYPE_CHECKING:
    from orchestrator.validate.case import Verdict


@click.command("validate", epilog=example("atoll validate", "atoll validate --only takeover --json"))
@click.option("--only", metavar="NAME", help="One check: takeover, leading_ones or rare_migration.")
@click.option("--without-migration", is_flag=True, help="Switch migration off, to see the checks fail.")
@json_option
def command(only: str | None, without_migration: bool, as_json: bool) -> None:
    """Reproduce published behaviour of island models with the engine that runs experiments.

    Takes some minutes; exits with 1 when a figure does not agree. The intervals hold for all comparisons together at
    95%, and the seeds are fixed, so that the verdict is the same each time.
    """
    from genome.errors import InputError
    from genome.settings import near
    from orchestrator.backends.cluster import machine_cpus
    from orchestrator.validate.checking import CHECKS, validate

    names = [check.name for check in CHECKS]
    if only is not None and only not in names:
        raise InputError("--only", f"one of {', '.join(names)}", f"'{only}'", near(only, names))
    started = time.perf_counter()
    chosen = [check for check in CHECKS if only in (None, check.name)]
    verdicts = validate(
        chosen, machine_cpus(), migration=not without_migration, tell=lambda one: click.echo(line(one), err=as_json)
    )
    ok = all(verdict.ok for verdict in verdicts)
    seconds = round(time.perf_counter() - started, 1)
    if as_json:
        emit({"ok": ok, "checks": [asdict(verdict) for verdict in verdicts], "wall_s": seconds})
    else:
        failed = sum(not verdict.ok for verdict in verdicts)
        click.echo(f"{len(verdicts) - failed} of {len(verdicts)} comparisons agree ({seconds:g} s)")
    if not ok:
        raise click.exceptions.Exit(1)


def line(verdict: Verdict) -> str:
    """Write a verdict for a reader."""
    head = f"{'pass' if verdict.ok else 'FAIL'}  {verdict.check:<14}  {verdict.case:<29}"
    found = "no estimate"
    if verdict.estimate is not None and verdict.low is not None and verdict.high is not None:
        found = f"{verdict.estimate:8.2f}  ({verdict.low:.2f} to {verdict.high:.2f}, {verdict.runs} runs)"
    tail = f"; {verdict.detail}" if verdict.detail else ""
    return f"{head}  {found}  expected {verdict.expected}{tail}"
