"""Finding what an experiment names: in a registry, by import path, or among Python's entry points."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib.metadata import EntryPoint, entry_points

from genome.errors import InputError
from genome.mishaps import let_pass, one_line, told
from genome.settings import describe, near

IMPORT_PATH = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*:[^\W\d]\w*(\.[^\W\d]\w*)*")


@contextmanager
def guarded(where: str, expected: str, what: str) -> Iterator[None]:
    """Tell whatever a plug-in raises before a run as bad input, in a line; ``sys.exit`` included.

    Parameters
    ----------
    where
        The place in the experiment, for messages.
    expected, what
        What is asked for, and what was found in its stead: "an adapter that can be built", "'shorten'".

    Raises
    ------
    InputError
        For whatever is raised within; one that names no place gets this one.
    KeyboardInterrupt
        On a Ctrl-C.
    """
    try:
        yield
    except InputError as error:
        parts = (one_line(part) for part in (error.expected, error.got, error.remedy))
        raise InputError(error.where or where, *parts) from None
    except BaseException as error:
        let_pass(error)
        raise InputError(where, expected, f"{what}, which raised {told(error)}") from error


def find(name: str, where: str, what: str, registry: Mapping[str, object], group: str) -> object:
    """Find an object by the name that an experiment gives it.

    Parameters
    ----------
    name
        A name of ``registry``, an import path ``package.module:object``, or an entry point's name. The registry's
        names cannot be taken by a plug-in.
    where
        The place in the experiment, for messages.
    what
        What is looked for, for messages: "island kind".
    registry
        The project's own: the objects, or import paths of those that are imported when first used.
    group
        The entry points' group.

    Raises
    ------
    InputError
        When there is nothing by that name, or it cannot be imported.
    """
    if name in registry:
        own = registry[name]
        return _imported(EntryPoint(name, own, group), where, what) if isinstance(own, str) else own
    if IMPORT_PATH.fullmatch(name):
        return _imported(EntryPoint(name, name, group), where, what)
    installed = entry_points(group=group)
    if name in installed.names:
        return _imported(installed[name], where, what)
    if ":" in name:
        raise InputError(where, f"{_article(what)}'s name or an import path 'package.module:object'", describe(name))
    known = sorted({*registry, *installed.names})
    raise InputError(where, _article(what), describe(name), near(name, known))


def find_function(
    name: str, where: str, what: str, registry: Mapping[str, object], group: str
) -> Callable[..., object]:
    """Find something that can be called; as :func:`find` otherwise."""
    found = find(name, where, what, registry, group)
    if not callable(found):
        got = f"{describe(name)}, {_article(type(found).__name__)}"
        raise InputError(where, f"{_article(what)} that can be called", got)
    return found


def _imported(point: EntryPoint, where: str, what: str) -> object:
    shown = describe(point.value if point.name == point.value else f"{point.name} = {point.value}")
    try:
        return point.load()
    except BaseException as error:
        let_pass(error)
        got = f"{shown}, which does not import ({told(error)})"
        remedy = "install it, or put its folder on PYTHONPATH" if isinstance(error, ImportError) else ""
        raise InputError(where, f"{_article(what)} that can be imported", got, remedy) from error


def _article(noun: str) -> str:
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"
