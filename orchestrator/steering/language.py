"""The command language: the words after ``atoll steer RUN``, read into a request, and checked against the run.

Reading is about words alone. Checking is about the run as it is then; the run's driver checks once more, since
commands of others may have come in between.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, NamedTuple

from genome.errors import InputError
from genome.settings import describe, near
from genome.yaml import parse_yaml
from orchestrator.steering.command import ISLANDS, RUN, VERBS, Request

NUMBER: Final = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?")
WHOLE: Final = re.compile(r"\d+")


class Words(NamedTuple):
    """What was written: the words after the verb, and the options.

    Attributes
    ----------
    words
        After the verb.
    islands
        Of ``--island``.
    like
        Of ``--like``; empty without.
    settings
        Of ``--set``.
    """

    words: tuple[str, ...] = ()
    islands: tuple[str, ...] = ()
    like: str = ""
    settings: tuple[str, ...] = ()


def read(verb: str, words: Words) -> Request:
    """Read a command.

    Raises
    ------
    InputError
        For a verb that there is not, or words that it does not take.
    """
    if verb not in VERBS:
        raise InputError("steer", "a verb", describe(verb), near(verb, list(VERBS)))
    if words.islands and verb not in ISLANDS:
        raise InputError(f"steer {verb}", "no --island", ", ".join(words.islands), f"'{verb}' takes none")
    if (words.like or words.settings) and verb != "add-island":
        got = f"--like {words.like}" if words.like else f"--set {words.settings[0]}"
        raise InputError(f"steer {verb}", "no --like and no --set", got, "they belong to 'add-island'")
    arguments = _READERS[verb](verb, words)
    if words.islands:
        arguments["islands"] = list(words.islands)
    return Request(verb, arguments)


def _nothing(verb: str, words: Words) -> dict[str, Any]:
    if words.words:
        raise InputError(f"steer {verb}", "nothing after it", describe(words.words[0]))
    return {}


def _values(verb: str, words: Words) -> dict[str, Any]:
    name = {"rate": "RATE", "strength": "STRENGTH"}.get(verb, "CRITERION")
    example = {"weight": "size=3", "target": "size=7", "rate": "mutation=0.4", "strength": "axial=12"}[verb]
    found: dict[str, float] = {}
    for word in words.words:
        key, equals, value = word.partition("=")
        if not key or not equals or not NUMBER.fullmatch(value):
            raise InputError(f"steer {verb}", f"{name}=NUMBER", describe(word), f"for example: {verb} {example}")
        if key in found:
            raise InputError(f"steer {verb}", "each name once", describe(word))
        found[key] = int(value) if WHOLE.fullmatch(value) else float(value)
        if not math.isfinite(found[key]):
            raise InputError(f"steer {verb}", "a number that is not too large to be one", describe(word))
    if not found:
        raise InputError(f"steer {verb}", f"{name}=NUMBER", "nothing", f"for example: {verb} {example}")
    return {"values": found}


def _one_id(verb: str, words: Words) -> dict[str, Any]:
    word = _one(verb, words, "the id of an individual")
    if verb == "promote" and word == "none":
        return {}
    # An id of more digits is none: it is below 2**63.
    if not WHOLE.fullmatch(word) or not word.isascii() or len(word) > 18:
        remedy = 'find one with: atoll query RUN "select id, fitness from individuals order by fitness desc limit 5"'
        expected = "the id of an individual, or 'none'" if verb == "promote" else "the id of an individual"
        raise InputError(f"steer {verb}", expected, describe(word), remedy)
    return {"id": int(word)}


def _genotype(verb: str, words: Words) -> dict[str, Any]:
    return {"genotype": _one(verb, words, "a genotype, as the log writes it")}


def _new_island(verb: str, words: Words) -> dict[str, Any]:
    return {"name": _one(verb, words, "the new island's name"), "like": words.like, "set": list(words.settings)}


def _old_island(verb: str, words: Words) -> dict[str, Any]:
    return {"islands": [_one(verb, words, "an island's name, or a group's")]}


def _channel(verb: str, words: Words) -> dict[str, Any]:
    text = _one(verb, words, "a channel, as an experiment has it")
    found = parse_yaml(text, f"steer {verb}").data
    if not isinstance(found, Mapping):
        remedy = "for example: connect '{kind: migrants, from: north-0, to: south}'"
        raise InputError(f"steer {verb}", "a channel: keys and values", describe(found), remedy)
    return {"channel": dict(found)}


def _channel_name(verb: str, words: Words) -> dict[str, Any]:
    return {"channel": _one(verb, words, "a channel's name")}


def _one(verb: str, words: Words, what: str) -> str:
    if len(words.words) != 1 or not words.words[0].strip():
        got = "nothing" if not words.words else describe(" ".join(words.words))
        raise InputError(f"steer {verb}", what, got, "quote what has spaces in it" if len(words.words) > 1 else "")
    return words.words[0]


_READERS: Final[Mapping[str, Callable[[str, Words], dict[str, Any]]]] = {
    **dict.fromkeys(RUN, _nothing),
    **dict.fromkeys(("weight", "target", "rate", "strength"), _values),
    **dict.fromkeys(("promote", "remove", "lock", "unlock"), _one_id),
    "insert": _genotype,
    "add-island": _new_island,
    "remove-island": _old_island,
    "connect": _channel,
    "disconnect": _channel_name,
}


def split(words: Sequence[str]) -> tuple[str, tuple[str, ...]]:
    """Give the verb and the words after it.

    Raises
    ------
    InputError
        Without a verb.
    """
    if not words:
        raise InputError("steer", "a verb", "nothing", f"known: {', '.join(VERBS)}")
    return words[0], tuple(words[1:])
