"""Finding what an experiment names: in a registry, by import path, or among Python's entry points."""

from __future__ import annotations

import importlib
import re
from collections.abc import Mapping, Sequence
from importlib.metadata import entry_points

from genome.errors import InputError
from genome.settings import near

IMPORT_PATH = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*:[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")


def find(
    name: str, where: str, what: str, registry: Mapping[str, str], group: str, later: Sequence[str] = ()
) -> object:
    """Find an object by the name that an experiment gives it.

    Parameters
    ----------
    name
        A name of ``registry``, an import path ``package.module:object``, or an entry point's name.
    where
        The place in the experiment, for messages.
    what
        What is looked for, for messages: "island kind".
    registry
        Names and import paths of the project's own.
    group
        The entry points' group.
    later
        Names that are known but not built yet.

    Raises
    ------
    InputError
        When there is nothing by that name, or it cannot be imported.
    """
    if name in registry:
        return import_object(registry[name], where, what)
    if ":" in name:
        return import_object(name, where, what)
    for point in entry_points(group=group, name=name):
        return import_object(point.value, where, what)
    known = sorted([*registry, *(point.name for point in entry_points(group=group))])
    if name in later:
        got, remedy = f"'{name}', which comes with a later version", f"known now: {', '.join(known)}"
        raise InputError(where, f"{article(what)} that is built", got, remedy)
    raise InputError(where, article(what), f"'{name}'", near(name, [*known, *later]))


def import_object(reference: str, where: str, what: str) -> object:
    """Import ``package.module:object``; see :func:`find`."""
    if not IMPORT_PATH.fullmatch(reference):
        expected = f"{article(what)}'s name or an import path 'package.module:object'"
        raise InputError(where, expected, f"'{reference}'")
    module_name, _, attribute = reference.partition(":")
    try:
        found: object = importlib.import_module(module_name)
    except Exception as error:  # noqa: BLE001 - a plug-in's module may raise anything while it is imported
        got = f"'{reference}', whose module does not import ({type(error).__name__}: {error})"
        remedy = "install it, or put its folder on PYTHONPATH"
        raise InputError(where, f"{article(what)} that can be imported", got, remedy) from None
    for part in attribute.split("."):
        if not hasattr(found, part):
            raise InputError(where, f"{article(what)} in the module {module_name}", f"no '{attribute}' there")
        found = getattr(found, part)
    return found


def article(noun: str) -> str:
    """Give a noun with its article, for a message."""
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"
