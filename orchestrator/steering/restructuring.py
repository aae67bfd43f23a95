"""The four commands that change a run's structure: ``add-island``, ``remove-island``, ``connect``, ``disconnect``.

Each gives a new structure, looked at as an experiment is at its start: settings, names, species, what kinds give and
take, more migrants than members. Two checks are left out, since commands come one by one: a new island is on no channel
yet, and one that all channels have left may be meant to be alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, Final

from genome.errors import InputError
from genome.settings import describe, near, validated
from orchestrator.channels import ChannelSettings
from orchestrator.compatibility import Compatibility
from orchestrator.loading import resolved
from orchestrator.steering.command import Command
from orchestrator.steering.structure import Structure
from orchestrator.wiring import needy, refuse_emptied, unfed

Arguments = Mapping[str, Any]


def restructured(structure: Structure, verb: str, arguments: Arguments, epoch: int) -> Structure:
    """Give the structure after a command that takes effect at the start of an epoch.

    Parameters
    ----------
    structure
        As it is; none of its changes is of a later epoch.
    verb, arguments
        As :mod:`orchestrator.steering.language` gives them.
    epoch
        At least 1.

    Raises
    ------
    InputError
        When the command cannot be meant.
    """
    after = CHANGES[verb](structure, arguments, epoch)
    _refuse_bad(structure, after, epoch)
    return after


def replayed(structure: Structure, commands: Iterable[Command]) -> Structure:
    """Give the structure after all accepted commands of a journal; others are passed over.

    Raises
    ------
    InputError
        For one that cannot be meant, as in a journal of another run.
    """
    for one in commands:
        if one.is_accepted and one.verb in CHANGES and one.epoch is not None:
            structure = CHANGES[one.verb](structure, one.arguments, one.epoch)
    return structure


def add_island(structure: Structure, arguments: Arguments, epoch: int) -> Structure:
    """Add a group: ``{"name": name, "settings": settings}``, the settings as in an experiment."""
    name, loaded = arguments["name"], structure.loaded
    if name in loaded.experiment.islands or any(spec.name == name for spec in structure.islands()):
        raise InputError("add-island", "a name that no island has or had", describe(name), "choose another")
    data = loaded.data()
    data["islands"] = {**data["islands"], name: dict(arguments["settings"])}
    experiment = resolved(data, "add-island")
    after = replace(loaded, experiment=experiment)
    return replace(structure, loaded=after, groups={**structure.groups, name: epoch})


def remove_island(structure: Structure, arguments: Arguments, epoch: int) -> Structure:
    """Remove islands: ``{"islands": names}``."""
    removed = {**structure.removed, **dict.fromkeys(arguments["islands"], epoch)}
    after = replace(structure, removed=removed)
    if not after.living(epoch):
        raise InputError("remove-island", "an island that is left", "none", "stop the run instead")
    return after


def connect(structure: Structure, arguments: Arguments, epoch: int) -> Structure:
    """Add a channel: ``{"channel": settings}``, as in an experiment, among islands that are there."""
    number = len(structure.loaded.experiment.channels)
    settings = validated(ChannelSettings, arguments["channel"], "connect")
    taken = {one.name or f"{one.kind}-{place}": one for place, one in enumerate(structure.loaded.experiment.channels)}
    name = settings.name or f"{settings.kind}-{number}"
    if name in taken:
        raise InputError("connect: name", "a name that no channel has or had", describe(name), "choose another")
    written = settings.model_dump(mode="json", by_alias=True, exclude_none=True, exclude_unset=True)
    written |= _among_living(settings, structure, epoch)
    data = structure.loaded.data()
    # What is wrong with the new channel is wrong with the command, not with a line of the experiment.
    data["channels"] = [*data["channels"], {**written, "name": name}]
    source = structure.loaded.source
    try:
        experiment = resolved(data, source)
    except InputError as error:
        raise _of_command(error, source, number) from None
    after = replace(structure.loaded, experiment=experiment)
    return replace(structure, loaded=after, channels={**structure.channels, number: (epoch, None)})


def disconnect(structure: Structure, arguments: Arguments, epoch: int) -> Structure:
    """Remove a channel: ``{"channel": name}``."""
    names = structure.channel_names(epoch)
    name = arguments["channel"]
    if name not in names:
        raise InputError("disconnect", "a channel of the run", describe(name), near(str(name), list(names)))
    number = names[name]
    since = structure.channels.get(number, (0, None))[0]
    return replace(structure, channels={**structure.channels, number: (since, epoch)})


CHANGES: Final[Mapping[str, Callable[[Structure, Arguments, int], Structure]]] = {
    "add-island": add_island,
    "remove-island": remove_island,
    "connect": connect,
    "disconnect": disconnect,
}


def living_names(given: Iterable[str], structure: Structure, epoch: int, where: str) -> list[str]:
    """Give the names of islands that are there, by their own names or by that of their group, each once.

    Raises
    ------
    InputError
        For a name that none of them has.
    """
    living = structure.living(epoch)
    by_name: dict[str, list[str]] = {}
    for spec in living:
        for key in dict.fromkeys((spec.group, spec.name)):
            by_name.setdefault(key, []).append(spec.name)
    found: dict[str, None] = {}
    for name in given:
        if name not in by_name:
            raise InputError(where, "an island of the run", describe(name), near(name, list(by_name)))
        found.update(dict.fromkeys(by_name[name]))
    return list(found)


def _among_living(settings: ChannelSettings, structure: Structure, epoch: int) -> dict[str, Any]:
    """Give the keys of a channel that name islands, as names of those that are there."""
    keys = {"among": settings.among, "from": settings.source, "to": settings.target}
    if settings.topology is not None and settings.among is None:
        keys["among"] = list(dict.fromkeys(spec.group for spec in structure.living(epoch)))
    found = {}
    for key, given in keys.items():
        if given:
            names = [given] if isinstance(given, str) else given
            found[key] = living_names(names, structure, epoch, f"connect: {key}")
    return found


def _refuse_bad(before: Structure, after: Structure, epoch: int) -> None:
    """Refuse what an experiment would be refused for at its start."""
    islands = after.islands()
    fits = Compatibility(islands)
    try:
        wired = after.wired_at(epoch, islands, fits)
        refuse_emptied(wired, islands)
    except InputError as error:
        raise _of_command(error, after.loaded.source, len(before.loaded.experiment.channels)) from None
    old = before.islands()
    fed_before = before.wired_at(epoch, old, Compatibility(old))
    lacked = {(spec.name, kind) for spec, kind in needy(fed_before, old, fits)}
    for spec, kind in needy(wired, after.living(epoch), fits):
        if (spec.name, kind) not in lacked and spec.since < epoch:
            expected = f"a channel of kind {kind} to {spec.name}, which it needs"
            raise InputError("steer", expected, "none after this command", "connect another one first")
    missed = {(spec.name, kind, name) for spec, kind, name in unfed(fed_before, old, old, fits)}
    for spec, kind, name in unfed(wired, islands, after.living(epoch), fits):
        if (spec.name, kind, name) not in missed and spec.since < epoch:
            expected = f"a channel of kind {kind} that brings {spec.name} what it needs, {name}"
            raise InputError("steer", expected, "none after this command", "connect another one first")


def _of_command(error: InputError, source: str, number: int) -> InputError:
    """Give an error about the channel of a number as one about the command that adds it."""
    where = error.where
    for prefix in (f"{source}: channels.{number}", f"channels.{number}"):
        if where == prefix or where.startswith(f"{prefix}."):
            where = f"connect: {where.removeprefix(prefix).lstrip('.')}".removesuffix(": ")
    return InputError(where, error.expected, error.got, error.remedy)
