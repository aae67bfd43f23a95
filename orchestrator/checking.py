"""Checking a file as the command that uses it would."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final

from genome.errors import InputError
from genome.yaml import load_yaml

ENVIRONMENT_KEYS: Final = frozenset({"gravity", "attractors", "repellers", "boundaries"})


def read_text(path: Path, what: str) -> str:
    """Read a text file.

    Raises
    ------
    InputError
        When it is not there, cannot be read, or is not UTF-8.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise InputError(str(path), what, "no such file", "check the path") from None
    except UnicodeDecodeError:
        raise InputError(str(path), what, "bytes that are not UTF-8") from None
    except OSError as error:
        raise InputError(str(path), what, error.strerror or str(error)) from None


def check(path: Path, overrides: Sequence[str] = ()) -> tuple[str, tuple[str, ...]]:
    """Check a file.

    Parameters
    ----------
    path
        An experiment or environment (``.yaml``, ``.yml``), a rule file (``.hemls``, ``.blocks``, ``.tl``), a
        block body (``.body.json``), a room or plan (``.plan``), or a grammar (``.bnf``).
    overrides
        For an experiment, as ``--set`` takes them.

    Returns
    -------
    What the file is, and notes to its writer.

    Raises
    ------
    InputError
        For the first thing that is wrong.
    """
    checks: Mapping[str, Callable[[Path], str]] = {
        ".hemls": _rules,
        ".blocks": _blocks,
        ".tl": _timed,
        ".body.json": _body,
        ".bnf": _grammar,
        ".plan": _plan,
    }
    for suffix, reads in checks.items():
        if path.name.endswith(suffix):
            if overrides:
                raise InputError("--set", "an experiment to set something in", str(path))
            return reads(path), _ignored(path) if suffix == ".tl" else ()
    if path.suffix in (".yaml", ".yml"):
        if _is_environment(path):
            from growth.environment import load_environment

            load_environment(path)
            return "environment", ()
        return "experiment", _experiment(path, overrides)
    if not path.exists():
        raise InputError(str(path), "a file", "no such file", "check the path")
    expected = "a .yaml, .hemls, .blocks, .tl, .body.json, .plan or .bnf file"
    raise InputError(str(path), expected, f"'{path.suffix or path.name}'")


def _is_environment(path: Path) -> bool:
    data = load_yaml(path).data
    if not isinstance(data, Mapping):
        return path.name.endswith((".env.yaml", ".env.yml"))
    return "islands" not in data and (bool(ENVIRONMENT_KEYS & data.keys()) or ".env." in path.name)


def _rules(path: Path) -> str:
    from growth.hemls import parse_system

    parse_system(read_text(path, "a rule file"), str(path))
    return "rules"


def _blocks(path: Path) -> str:
    from genome.lsystem import parse_blocks

    parse_blocks(read_text(path, "a rule file"), str(path))
    return "rules"


def _timed(path: Path) -> str:
    from genome.timed import parse_tl
    from growth.timed import compile_system

    compile_system(parse_tl(read_text(path, "a rule file"), str(path)))
    return "rules"


def _ignored(path: Path) -> tuple[str, ...]:
    """Give a note where the turtle passes over symbols of a timed system."""
    from genome.timed import parse_tl
    from growth.timed.turtle import unknown_symbols

    symbols = unknown_symbols(parse_tl(read_text(path, "a rule file"), str(path)))
    names = ", ".join(symbols)
    remedy = "such a symbol needs a production, or an equiv with a command of the turtle"
    told = f"{path}: the turtle draws nothing for {names}; {remedy}"
    return (told,) if symbols else ()


def _body(path: Path) -> str:
    from growth.blocks import read_body

    read_body(path)
    return "body"


def _grammar(path: Path) -> str:
    from genome.bnf import parse_bnf

    parse_bnf(read_text(path, "a grammar"), str(path))
    return "grammar"


def _plan(path: Path) -> str:
    from orchestrator.plan_file import read_plan

    read_plan(path)
    return "plan"


def _experiment(path: Path, overrides: Sequence[str]) -> tuple[str, ...]:
    """Check all that a run checks before it starts."""
    from orchestrator.loading import load_experiment
    from orchestrator.run import make_backend, prepare

    loaded = load_experiment(path, overrides)
    prepare(loaded)
    make_backend(loaded, None)
    return loaded.notes
