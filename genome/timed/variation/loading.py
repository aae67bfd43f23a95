"""Finds the systems and grammars that the settings of an island name."""

from __future__ import annotations

from collections.abc import Callable
from importlib import resources
from pathlib import Path
from typing import Final

from genome.bnf import parse_bnf
from genome.errors import InputError
from genome.grammar import Grammar
from genome.settings import near
from genome.timed.system import TimedSystem
from genome.timed.text import parse_tl

SUFFIX: Final = ".tl"

Where = Callable[..., str]
"""Gives the place of a key of the island, for messages."""


def named_path(name: str, base: Path) -> Path | None:
    """Give the path of a ``.tl`` or ``.bnf`` file that settings name; ``None`` for the name of a shipped system."""
    return base / name if "/" in name or name.endswith((SUFFIX, ".bnf")) else None


def system_text(name: str, base: Path, where: Where) -> tuple[str, str]:
    """Give the name of a system's file, and its text.

    Parameters
    ----------
    name
        A shipped system's name, or a path, told by its ending ``.tl`` or a slash in it.
    base
        The folder that a relative path starts from.
    where
        See :data:`Where`.

    Raises
    ------
    InputError
        Where there is no such system, or it cannot be read.
    """
    path = named_path(name, base)
    if path is not None:
        return path.name, _text(path, name, where("genome", "system"), "a timed system's file")
    shipped = shipped_systems()
    if name not in shipped:
        remedy = f"{near(name, list(shipped))}; a file's name ends in {SUFFIX}"
        raise InputError(where("genome", "system"), "a timed system's name or file", f"'{name}'", remedy)
    return shipped[name].name, shipped[name].read_text(encoding="utf-8")


def load_system(name: str, base: Path, where: Where) -> TimedSystem:
    """Read a system. Parameters as of :func:`system_text`.

    Raises
    ------
    InputError
        As of :func:`system_text`, and for text that is no timed system, with line and column.
    """
    file, text = system_text(name, base, where)
    try:
        return parse_tl(text, file)
    except InputError as error:
        raise InputError(
            f"{where('genome', 'system')}: {error.where}", error.expected, error.got, error.remedy
        ) from None


def load_grammar(name: str, base: Path, where: Where) -> Grammar:
    """Read a ``.bnf`` file.

    Raises
    ------
    InputError
        Where it cannot be read or is no grammar.
    """
    place = where("genome", "grammar")
    text = _text(base / name, name, place, "a grammar's file")
    try:
        return parse_bnf(text, Path(name).name)
    except InputError as error:
        raise InputError(f"{place}: {error.where}", error.expected, error.got, error.remedy) from None


def shipped_systems() -> dict[str, Path]:
    """Give the shipped systems' files by their names, sorted."""
    # A wheel has them in the package; in the project they stand beside the experiments.
    genome = Path(str(resources.files("genome")))
    for folder in (genome / "systems", genome.parent / "experiments" / "systems"):
        if folder.is_dir():
            return {path.stem: path for path in sorted(folder.glob(f"*{SUFFIX}"))}
    return {}


def _text(path: Path, name: str, where: str, what: str) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError, ValueError) as error:
        reason = (getattr(error, "strerror", None) or "bytes that are not UTF-8").lower()
        raise InputError(where, what, f"'{name}': {reason}", "paths start from the experiment's folder") from None
