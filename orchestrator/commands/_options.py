"""What several commands share: options, and how results are printed."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from genome.errors import InputError

if TYPE_CHECKING:
    from orchestrator.folder import Runs

F = TypeVar("F", bound=Callable[..., Any])


def example(*lines: str) -> str:
    """Give an epilog that shows examples, each on a line of its own."""
    return "\b\nExample:\n" + "\n".join(f"  {line}" for line in lines)


def json_option(function: F) -> F:
    """Add ``--json``."""
    return click.option(
        "--json", "as_json", is_flag=True, help="End stdout with one JSON object; all else goes to stderr."
    )(function)


def emit(data: Mapping[str, Any]) -> None:
    """Print one JSON object on one line of stdout."""
    click.echo(json.dumps(data, allow_nan=False))


def check_place(runs_dir: str, name: str | None) -> None:
    """Refuse a runs folder or a run's name that is none.

    Raises
    ------
    InputError
        For an empty folder, and a name of other characters than a run's folder can have everywhere.
    """
    if not runs_dir.strip():  # as a path it would be the current folder
        raise InputError("--runs-dir", "a folder", f"'{runs_dir}'", "'.' is the current one")
    if name is not None and not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_.-]*", name):
        raise InputError("--name", "letters, digits, '-', '_' and '.'", f"'{name}'")


def runs_at(place: str) -> Runs:
    """Open the place where run folders stand: a path of this machine stays as it was written.

    Raises
    ------
    InputError
        For a URI that is none, or that cannot be opened.
    """
    from islands.store import Store
    from islands.stores.places import is_uri

    if not is_uri(place):
        return Path(place)
    store = Store.open(place)
    return store if store.local is None else store.local
