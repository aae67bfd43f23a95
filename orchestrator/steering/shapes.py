"""The arguments that each verb takes, as plain JSON values: a letter may come from anybody."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from genome.errors import InputError
from genome.settings import describe
from orchestrator.steering.command import ISLANDS, Request

HIGHEST_ID: Final = 2**63 - 1
LARGEST: Final = 1e300


def shaped(request: Request) -> Request:
    """Give a request back whose arguments are such as its verb takes.

    Raises
    ------
    InputError
        For any other.
    """
    arguments = dict(request.arguments)
    if request.verb in ISLANDS and "islands" in arguments and not _texts(arguments.pop("islands")):
        raise InputError(f"steer {request.verb}", "islands by name", describe(request.arguments["islands"]))
    if not _SHAPES.get(request.verb, _nothing)(arguments):
        raise InputError(f"steer {request.verb}", "arguments that it takes", describe(request.arguments))
    return request


def _nothing(arguments: Mapping[str, Any]) -> bool:
    return not arguments


def _values(arguments: Mapping[str, Any]) -> bool:
    match arguments:
        case {"values": dict(values), **more} if values and not more:
            return all(type(one) in (int, float) and abs(one) <= LARGEST for one in values.values())
    return False


def _id(arguments: Mapping[str, Any]) -> bool:
    return arguments.keys() == {"id"} and type(arguments["id"]) is int and 0 <= arguments["id"] <= HIGHEST_ID


def _promoted(arguments: Mapping[str, Any]) -> bool:
    return not arguments or _id(arguments)


def _genotype(arguments: Mapping[str, Any]) -> bool:
    return arguments.keys() == {"genotype"} and isinstance(arguments["genotype"], str)


def _new_island(arguments: Mapping[str, Any]) -> bool:
    match arguments:
        case {"name": str(), "settings": dict(), **more}:
            return not more
        case {"name": str(), "like": str(), "set": words, **more}:
            return not more and _texts(words, least=0)
    return False


def _old_islands(arguments: Mapping[str, Any]) -> bool:
    return arguments.keys() == {"islands"} and _texts(arguments["islands"])


def _channel(arguments: Mapping[str, Any]) -> bool:
    return arguments.keys() == {"channel"} and isinstance(arguments["channel"], dict)


def _channel_name(arguments: Mapping[str, Any]) -> bool:
    return arguments.keys() == {"channel"} and isinstance(arguments["channel"], str)


def _texts(given: object, least: int = 1) -> bool:
    return isinstance(given, list) and len(given) >= least and all(isinstance(one, str) for one in given)


_SHAPES: Final[Mapping[str, Callable[[Mapping[str, Any]], bool]]] = {
    **dict.fromkeys(("weight", "target", "rate", "strength"), _values),
    **dict.fromkeys(("remove", "lock", "unlock"), _id),
    "promote": _promoted,
    "insert": _genotype,
    "add-island": _new_island,
    "remove-island": _old_islands,
    "connect": _channel,
    "disconnect": _channel_name,
}
