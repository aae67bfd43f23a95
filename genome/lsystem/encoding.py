"""The encoding of L-systems in logs, checkpoints and migrants: JSON, words as texts."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Final

from genome.errors import InputError
from genome.lsystem.system import LSystem, Rule
from genome.lsystem.word import Word, parse_word
from genome.settings import describe, near

FORMAT: Final = 1
"""The version of this encoding."""

_KEYS: Final = ("format", "axiom", "iterations", "rules", "seed")
_RULE_KEYS: Final = ("operand", "left", "right", "chance", "successor")


def encode(system: LSystem) -> str:
    """Write an L-system as a JSON object without blanks; equal systems give equal texts.

    A rule's ``left``, ``right`` and ``chance`` stand there where it has contexts and a chance under 1.
    """
    rules = []
    for rule in system.rules:
        keys: dict[str, Any] = {"operand": rule.operand}
        if rule.left is not None:
            keys["left"] = rule.left
        if rule.right is not None:
            keys["right"] = rule.right
        if rule.chance != 1.0:
            keys["chance"] = rule.chance
        keys["successor"] = str(rule.successor)
        rules.append(keys)
    data = {"format": FORMAT, "axiom": str(system.axiom), "iterations": system.iterations, "rules": rules,
            "seed": system.seed}  # fmt: skip
    return json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False)


def decode(text: str, where: str = "genotype") -> LSystem:
    """Read an L-system from its encoding.

    Parameters
    ----------
    text
        As :func:`encode` writes it.
    where
        The place that an error names.

    Raises
    ------
    InputError
        For anything else.
    """
    try:
        data: Any = json.loads(text)
    except (ValueError, RecursionError):
        data = None
    if not isinstance(data, dict):
        raise InputError(where, "an L-system as a JSON object", describe(text))
    _known(data, _KEYS, where)
    if data.get("format") != FORMAT or type(data["format"]) is not int:
        raise InputError(f"{where}: format", f"{FORMAT}, the version of this encoding", describe(data.get("format")))
    rules = data.get("rules")
    iterations: Any = data.get("iterations")  # LSystem checks it, and the seed
    seed: Any = data.get("seed")
    if not isinstance(rules, list):
        raise InputError(f"{where}: rules", "a list of rules", describe(rules))
    try:
        return LSystem(
            _word(data.get("axiom"), f"{where}: axiom"),
            tuple(_rule(rule, f"{where}: rules.{place}") for place, rule in enumerate(rules)),
            iterations,
            seed,
        )
    except InputError as error:
        if error.where.startswith(where):
            raise
        raise InputError(f"{where}: {error.where}", error.expected, error.got, error.remedy) from None


def _rule(data: object, where: str) -> Rule:
    if not isinstance(data, dict):
        raise InputError(where, "a rule as a JSON object", describe(data))
    _known(data, _RULE_KEYS, where)
    chance = data.get("chance", 1.0)
    successor = _word(data.get("successor"), f"{where}.successor")
    try:
        operand: Any = data.get("operand")  # which Rule checks, as the others
        return Rule(operand, data.get("left"), data.get("right"), chance, successor)
    except InputError as error:
        part = error.where.removeprefix("rule: ")
        raise InputError(f"{where}.{part}", error.expected, error.got, error.remedy) from None


def _word(text: object, where: str) -> Word:
    if not isinstance(text, str):
        raise InputError(where, "a word", describe(text))
    return parse_word(text, where)


def _known(data: Mapping[str, Any], keys: tuple[str, ...], where: str) -> None:
    for key in data:
        if key not in keys:
            raise InputError(f"{where}: {key}", "a known key", describe(key), near(key, list(keys)))
