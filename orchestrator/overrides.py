"""``--set key.path=value``: changes to an experiment's data before it is validated."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any

from genome.errors import InputError
from genome.settings import near
from genome.yaml import parse_yaml

Data = dict[str, Any]
RIVALS = {"generations": "epochs", "epochs": "generations"}
"""Keys of which a file gives one: setting either from the command line takes the place of the other."""


def parse_override(text: str) -> tuple[tuple[str, ...], Any]:
    """Split ``key.path=value``; the value is read as YAML.

    Raises
    ------
    InputError
        Without a key or an equals sign, or when the value is no YAML.
    """
    key, equals, value = text.partition("=")
    path = tuple(part.strip() for part in key.split("."))
    if not equals or not all(path):
        raise InputError(f"--set {text}", "key.path=value", f"'{text}'", "for example --set generations=4")
    if value.strip() in ("", "null", "~"):
        return path, None
    parsed = parse_yaml(f"value: {value}\n", f"--set {key}")
    if not isinstance(parsed.data, dict) or set(parsed.data) != {"value"}:
        raise InputError(f"--set {key}", "one value", f"'{value}'")
    return path, parsed.data["value"]


def apply_overrides(data: Mapping[str, Any], overrides: Sequence[str]) -> Data:
    """Give a copy of an experiment's data with every override applied, in order.

    Raises
    ------
    InputError
        When a path leads through something that is not there.
    """
    changed: Data = copy.deepcopy(dict(data))
    for text in overrides:
        path, value = parse_override(text)
        _set(changed, path, value)
        if len(path) == 1 and path[0] in RIVALS:
            changed.pop(RIVALS[path[0]], None)
    return changed


def _set(data: Data, path: tuple[str, ...], value: object) -> None:
    where = f"--set {'.'.join(path)}"
    here: Any = data
    for depth, part in enumerate(path[:-1]):
        if isinstance(here, list):
            here = here[_index(here, part, where)]
        elif isinstance(here, dict):
            if path[:depth] == ("islands",) and part not in here:
                raise InputError(where, "an island of the experiment", f"'{part}'", near(part, list(here)))
            here = here.setdefault(part, {})
        else:
            raise InputError(where, "a key with keys below it", f"'{'.'.join(path[:depth])}', which has none")
    if isinstance(here, list):
        here[_index(here, path[-1], where)] = value
    elif isinstance(here, dict):
        here[path[-1]] = value
    else:
        raise InputError(where, "a key with keys below it", f"'{'.'.join(path[:-1])}', which has none")


def _index(items: Sequence[Any], part: str, where: str) -> int:
    if part.isdecimal() and int(part) < len(items):
        return int(part)
    raise InputError(where, f"a number from 0 to {len(items) - 1}", f"'{part}'")
