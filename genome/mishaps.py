"""What plug-ins raise, told in a line that every file format and terminal can hold."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any, Final

MOST_CHARACTERS: Final = 400
"""The longest line that is told of a mishap; a longer one ends in an ellipsis."""


def one_line(text: str, most: int = MOST_CHARACTERS) -> str:
    """Fold a text into one line of printable characters, valid in UTF-8, at most ``most`` of them.

    Whitespace of any length becomes one space; what cannot be printed (lone surrogates, control characters) is
    written as Python escapes it.
    """
    # Bounded before the folding too: the text may be a plug-in's whole mesh.
    folded = " ".join(text[: 16 * most].split())
    shown = "".join(char if char.isprintable() else char.encode("unicode_escape").decode("ascii") for char in folded)
    return shown if len(shown) <= most and len(text) <= 16 * most else shown[: most - 1] + "…"


def told(error: BaseException) -> str:
    """Tell an exception in one line: its type, and what it says."""
    try:
        said = str(error)
    except Exception:  # noqa: BLE001 - an exception's own text may be what is broken
        said = ""
    return one_line(f"{type(error).__name__}: {said}" if said else type(error).__name__)


def let_pass(error: BaseException) -> None:
    """Raise again what must not be taken for a plug-in's mishap: a Ctrl-C, and the end of this process.

    Raises
    ------
    KeyboardInterrupt
        When there is one among the causes; one that strikes a compiled kernel comes wrapped in a SystemError.
    SystemExit
        When Ray raised it because the worker was told to end; Ray marks it, and a plug-in's has no such mark.
    """
    cause: BaseException | None = error
    looked_at: list[int] = []  # a plug-in can make causes that run in a circle
    while cause is not None and id(cause) not in looked_at:
        if isinstance(cause, KeyboardInterrupt):
            raise KeyboardInterrupt from error
        looked_at.append(id(cause))
        cause = cause.__cause__ or cause.__context__
    if isinstance(error, SystemExit) and hasattr(error, "ray_terminate_msg"):
        raise error


def plain(value: object) -> Any:  # noqa: ANN401 - plain JSON values
    """Give a detail as plain JSON values, its texts each one line; what JSON does not know is told as text."""
    if value is None or isinstance(value, (bool, int)):
        return value
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Real):
        return float(value) if math.isfinite(value) else str(value)
    if isinstance(value, str):
        return one_line(value)
    if isinstance(value, Mapping):
        return {one_line(str(key)): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return one_line(str(value))
