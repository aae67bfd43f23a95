"""Gathering a report's sections, and writing the page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from analysis.report.ancestors import ancestors
from analysis.report.channels import channels
from analysis.report.curves import curves
from analysis.report.failures import failures
from analysis.report.forms import forms
from analysis.report.opening import opening
from analysis.report.parts import Section
from genome.errors import InputError
from genome.files import write_whole
from genome.mishaps import one_line
from islands.schemas import TABLES
from orchestrator.folder import RunFolder
from orchestrator.keeping import EXPERIMENT
from orchestrator.query import as_rows, ask
from orchestrator.standing import champion, progress, standing

NAME: Final = "report.html"

BRED: Final = """
select island, max(generation) as generation, count(*) as bred from individuals group by island order by min(id)
"""

NOTHING: Final[dict[str, Any]] = {
    "status": "unknown", "alive": None, "error": "", "started": None, "ended": None, "generations": 0, "evaluations": 0,
    "best": None, "islands": [],
}  # fmt: skip
"""How a run stands of which nothing can be read."""


def write_report(folder: RunFolder, output: Path | None = None) -> str:
    """Write a report of a run, whole or not at all.

    What cannot be shown, since the log or the experiment misses something, is said in its place.

    Parameters
    ----------
    folder
        The run: finished, going on, or killed.
    output
        The file; ``report.html`` in the run's folder without.

    Returns
    -------
    Where it was written.

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    if output is not None and not output.parent.is_dir():
        raise InputError("-o", "a file in a folder that exists", f"'{output}'")
    content = page(folder.name, sections(folder)).encode()
    if output is not None:
        write_whole(output, content)
        return str(output)
    folder.store.write(NAME, content)
    return str(folder.store.at(NAME)) if folder.store.local is None else str(folder.path / NAME)


def sections(folder: RunFolder) -> list[Section]:
    """Gather all sections; one that cannot be gathered says why."""
    found, troubles = _standing(folder)
    islands = [str(row["island"]) for row in found["islands"]]
    best = None if found["best"] is None else int(found["best"]["id"])
    makers: list[tuple[str, str, Callable[[], Section]]] = [
        ("run", "What ran", lambda: opening(folder, found)),
        ("forms", "Forms", lambda: forms(folder, islands)),
        ("curves", "Fitness and diversity", lambda: curves(folder, islands)),
        ("channels", "Channels", lambda: channels(folder)),
        ("failures", "Invalid individuals and events", lambda: failures(folder)),
        ("ancestors", "Ancestors of the champions", lambda: ancestors(folder, best)),
        ("settings", "Settings", lambda: settings(folder)),
    ]
    made = [_made(anchor, title, make) for anchor, title, make in makers]
    if troubles:
        made.insert(0, Section("trouble", "What is missing", troubles=tuple(troubles)))
    return made


def _standing(folder: RunFolder) -> tuple[dict[str, Any], list[str]]:
    """Say how a run stands, as far as its manifest and its log tell, and what is wrong with either."""
    troubles = []
    if not any(folder.log.names(table) for table in TABLES):
        troubles.append(f"There is no file of the log at {folder.log}.")
    found: dict[str, Any] = {"run": folder.name, **NOTHING}
    try:
        return standing(folder), troubles
    except InputError as error:
        troubles.append(one_line(str(error)))
    for tell in (progress, _bred):  # the second asks one table alone
        try:
            found |= tell(folder)
            break
        except InputError as error:
            troubles.append(one_line(str(error)))
    return found, list(dict.fromkeys(troubles))


def _bred(folder: RunFolder) -> dict[str, Any]:
    """Give what the individuals alone tell: the islands, how far they came, and the best."""
    rows = as_rows(ask(folder.log, BRED))
    return {
        "generations": max((int(row["generation"]) for row in rows), default=0),
        "evaluations": sum(int(row["bred"]) for row in rows),
        "best": champion(folder),
        "islands": rows,
    }


def settings(folder: RunFolder) -> Section:
    """Show the experiment as resolved, with every default written out."""
    text = "The experiment as it was resolved, with every default written out: atoll run takes it as it is."
    try:
        code = folder.store.read(EXPERIMENT).decode("utf-8", "replace")
    except FileNotFoundError:
        raise InputError(folder.source, "the experiment as it was resolved", "no such file") from None
    return Section("settings", "Settings", text, code=code)


def page(name: str, made: list[Section]) -> str:
    """Write the page."""
    import jinja2

    loader = jinja2.PackageLoader("analysis.report", "")
    environment = jinja2.Environment(loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True,
                                     lstrip_blocks=True)  # fmt: skip
    return environment.get_template("page.html").render(name=name, sections=made)


def _made(anchor: str, title: str, make: Callable[[], Section]) -> Section:
    try:
        return make()
    except (InputError, OSError) as error:
        return Section(anchor, title, troubles=(f"This cannot be shown: {one_line(str(error))}",))
